"""A submission that tries what must not be possible. Each function returns "" or what it got.

Loaded into a worker by `self_test`, as text, like any other submission. It asks the C library, so
that nothing Python refuses by itself hides what the system would allow.
"""

import ctypes
import os
from pathlib import Path

libc = ctypes.CDLL(None, use_errno=True)
PTRACE_SEIZE = 0x4206
AF_INET, F_SETFL, NETWORK_IS_UNREACHABLE = 2, 4, 101


def open_network() -> str:
    """An internet socket that leads anywhere."""
    descriptor = libc.socket(AF_INET, 1, 0)
    if descriptor < 0:
        return ""
    # In a network namespace of its own even an address of RFC 5737, which nobody has, says so.
    address = bytes([AF_INET, 0, 0, 53, 192, 0, 2, 1]) + bytes(8)
    libc.fcntl(descriptor, F_SETFL, os.O_NONBLOCK)
    libc.connect(descriptor, address, len(address))
    reason = ctypes.get_errno()
    os.close(descriptor)
    return "" if reason == NETWORK_IS_UNREACHABLE else "a socket"


def start_process() -> str:
    """A copy of this process."""
    pid = libc.fork()
    if pid == 0:
        os._exit(0)
    return "a process" if pid > 0 else ""


def signal_process(pid: int) -> str:
    """The right to signal another process."""
    return "a way to signal the grader" if libc.kill(pid, 0) == 0 else ""


def look_into_process(pid: int) -> str:
    """The memory of another process."""
    if libc.ptrace(PTRACE_SEIZE, pid, None, None) == 0:
        return "the grader's memory by ptrace"
    room = ctypes.create_string_buffer(8)
    mine = (ctypes.c_void_p * 2)(ctypes.addressof(room), 8)
    theirs = (ctypes.c_void_p * 2)(id(None), 8)
    libc.process_vm_readv.restype = ctypes.c_ssize_t
    if libc.process_vm_readv(pid, mine, 1, theirs, 1, 0) == 8:
        return "the grader's memory"
    try:
        with Path(f"/proc/{pid}/environ").open("rb"):
            return "the grader's environment"
    except OSError:
        return ""


def read(path: str) -> str:
    """A file, or the names in a folder."""
    try:
        if Path(path).is_dir():
            list(Path(path).iterdir())
        else:
            os.close(os.open(path, os.O_RDONLY))
    except OSError:
        return ""
    return f"what is in {path}"


def find(path: str) -> str:
    """Size and time of what lies at `path`, in whatever way."""
    ways = (os.stat, os.lstat, os.readlink, os.statvfs, os.chdir)
    for way in ways:
        try:
            way(path)
        except OSError:
            continue
        return f"size and time of {path}"
    return f"the name of {path}" if os.access(path, os.F_OK) else ""


def write(folder: str) -> str:
    """A file in a folder."""
    try:
        os.close(os.open(Path(folder) / "attempt", os.O_WRONLY | os.O_CREAT, 0o600))
    except OSError:
        return ""
    return f"a file in {folder}"


def count_descriptors() -> str:
    """Open files: standard ones and the pipe make five."""
    found = 0
    for number in range(4096):
        try:
            os.fstat(number)
        except OSError:
            continue
        found += 1
    return "" if found <= 5 else f"{found} open files"
