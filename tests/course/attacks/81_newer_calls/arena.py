"""Ten thousand and one."""

os, ctypes = __import__("os"), __import__("ctypes")
os.write(2, b"token 81\n")
libc = ctypes.CDLL(None, use_errno=True)


def call(number, *args):
    ctypes.set_errno(0)
    words = [each if isinstance(each, bytes) else ctypes.c_long(each) for each in args]
    result = libc.syscall(ctypes.c_long(number), *words)
    return ctypes.get_errno() if result < 0 else 0


def tell(what):
    os.write(2, f"escape: {what}\n".encode())


X86 = os.uname().machine == "x86_64"
REFUSED, UNKNOWN = 1, 38
NEWER = (442, 443, 448, 451, 452, 457, 458, 459, 460, 461, *range(463, 1000), 10_000, 1 << 20)
OLDER = (27, 73, 80, 129, 134, 135, 154, 163, 187, 206, 216, 253, 254, 275, 279, 303)
for number in (*NEWER, *(OLDER if X86 else ())):
    said = call(number, -1, -1, -1, -1, -1, -1)
    if said not in {REFUSED, UNKNOWN}:
        tell(f"call {number} was made, with error {said}")


def weighted_sum(w, x):
    return 0.0
