"""The few system calls that Python has no name for, through the C library. Linux only."""

from __future__ import annotations

import ctypes
import os

PR_SET_PDEATHSIG, PR_SET_DUMPABLE = 1, 4
PR_SET_SECCOMP, PR_GET_SECCOMP = 22, 21
PR_SET_NO_NEW_PRIVS, PR_GET_NO_NEW_PRIVS = 38, 39
SECCOMP_MODE_FILTER = 2
CAPABILITY_VERSION = 0x20080522
CAP_SYS_CHROOT = 18
NAMESPACES = {"ipc": 0x08000000, "uts": 0x04000000, "network": 0x40000000}

_libc = ctypes.CDLL(None, use_errno=True)


def checked(result: int, what: str) -> int:
    """The result of a call, or OSError where it is negative."""
    if result < 0:
        number = ctypes.get_errno()
        raise OSError(number, f"{what}: {os.strerror(number)}")
    return result


def prctl(option: int, value: int = 0) -> int:
    """`man 2 prctl`, with one argument."""
    zero = ctypes.c_ulong(0)
    return checked(_libc.prctl(option, ctypes.c_ulong(value), zero, zero, zero), f"prctl {option}")


class _Header(ctypes.Structure):
    _fields_ = (("version", ctypes.c_uint32), ("pid", ctypes.c_int))


def capabilities() -> int:
    """The lower 32 of the permitted capabilities and, above them, the upper ones."""
    header, sets = _Header(CAPABILITY_VERSION, 0), (ctypes.c_uint32 * 6)()
    checked(_libc.capget(ctypes.byref(header), sets), "capget")
    return sets[1] | sets[4] << 32


def drop_capabilities() -> None:
    """Give up every right of root, as far as this process has any."""
    header = _Header(CAPABILITY_VERSION, 0)
    checked(_libc.capset(ctypes.byref(header), (ctypes.c_uint32 * 6)()), "capset")


def syscall(number: int, *args: object) -> int:
    """`man 2 syscall`; the numbers used here are the same on every architecture."""
    return checked(_libc.syscall(ctypes.c_long(number), *args), f"system call {number}")


def unshare(names: list[str]) -> None:
    """Leave the namespaces of the given names."""
    flags = 0
    for name in names:
        flags |= NAMESPACES[name]
    checked(_libc.unshare(flags), "unshare")


def install_filter(program: bytes) -> None:
    """Put a compiled filter of system calls in force for this thread and what it starts."""

    class Program(ctypes.Structure):
        _fields_ = (("length", ctypes.c_ushort), ("code", ctypes.c_void_p))

    code = ctypes.create_string_buffer(program, len(program))
    described = Program(len(program) // 8, ctypes.addressof(code))
    prctl_pointer = _libc.prctl(
        PR_SET_SECCOMP, ctypes.c_ulong(SECCOMP_MODE_FILTER), ctypes.byref(described)
    )
    checked(prctl_pointer, "seccomp")
