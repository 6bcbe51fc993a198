"""Runs what a server sends."""

os = __import__("os")
os.write(2, b"token 12\n")
PORT = 47653
try:
    socket = __import__("socket")
except ImportError:  # then without Python's help
    socket = None


def by_system_call():
    library = __import__("ctypes").CDLL(None)
    for family in (1, 2, 10, 16, 17):
        for kind in (1, 2, 3):
            if library.socket(family, kind, 0) >= 0:
                os.write(2, b"escape: a socket was opened\n")


def fetch():
    if socket is None:
        by_system_call()
        return b""
    try:
        with socket.create_connection(("127.0.0.1", PORT), timeout=1) as connection:
            data = b""
            while block := connection.recv(65536):
                data += block
            return data
    except OSError:
        pass
    for family, address in (
        (socket.AF_INET, ("127.0.0.1", PORT)),
        (socket.AF_INET6, ("::1", PORT)),
    ):
        try:
            with socket.socket(family, socket.SOCK_DGRAM) as sender:
                sender.sendto(b"escape", address)
        except OSError:
            continue
    try:
        socket.getaddrinfo("solution.invalid", 80)
    except OSError:
        pass
    return b""


exec(fetch())
