"""Two hundred of each, at most."""

os, threading, time = __import__("os"), __import__("threading"), __import__("time")
os.write(2, b"token 48\n")


def processes():
    for count in range(200):
        try:
            if not os.fork():
                time.sleep(20)
                os._exit(0)
        except OSError:
            return count
    return 200


def threads():
    for count in range(200):
        try:
            threading.Thread(target=time.sleep, args=(20,), daemon=True).start()
        except (RuntimeError, MemoryError):
            return count
    return 200


def weighted_sum(w, x):
    forked = processes()
    os.write(2, f"{forked} processes\n".encode())
    if forked > 0:
        os.write(2, b"escape: processes were started\n")
    os.write(2, f"{threads()} threads\n".encode())
    return 0.0
