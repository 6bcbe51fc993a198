"""Turn this process into root as a grading service's container has it, and run a program.

Fourteen capabilities are left, those that Docker leaves; CAP_SYS_ADMIN is not among them. A filter
refuses namespaces and mounts, as Docker's default does.
"""

from __future__ import annotations

import ctypes
import errno
import os
import struct
import sys

import pyseccomp

PR_CAPBSET_DROP = 24
CAPSET_NUMBER = {"x86_64": 126, "aarch64": 91}
# chown dac_override fowner fsetid kill setgid setuid setpcap net_bind_service net_raw sys_chroot
# mknod audit_write setfcap, by their numbers in linux/capability.h
KEPT = {0, 1, 3, 4, 5, 6, 7, 8, 10, 13, 18, 27, 29, 31}
NEW_NAMESPACES = (
    0x00020000,
    0x02000000,
    0x04000000,
    0x08000000,
    0x10000000,
    0x20000000,
    0x40000000,
)


def main() -> None:
    refuse_namespaces()
    drop_capabilities()
    os.execv(sys.argv[1], sys.argv[1:])


def refuse_namespaces() -> None:
    table = pyseccomp.SyscallFilter(pyseccomp.ALLOW)
    refusal = pyseccomp.ERRNO(errno.EPERM)
    for name in ("unshare", "setns", "mount", "umount2", "pivot_root", "fsopen", "move_mount"):
        table.add_rule(refusal, name)
    for flag in NEW_NAMESPACES:
        table.add_rule(refusal, "clone", pyseccomp.Arg(0, pyseccomp.MASKED_EQ, flag, flag))
    table.add_rule(pyseccomp.ERRNO(errno.ENOSYS), "clone3")
    table.load()


def drop_capabilities() -> None:
    libc = ctypes.CDLL(None, use_errno=True)
    for number in range(64):
        if number not in KEPT:
            libc.prctl(PR_CAPBSET_DROP, number, 0, 0, 0)
    bits = sum(1 << number for number in KEPT)
    header = struct.pack("=Ii", 0x20080522, 0)
    # Twice effective, permitted, inheritable: the low and the high 32 capabilities.
    sets = struct.pack("=6I", bits, bits, 0, 0, 0, 0)
    if libc.syscall(CAPSET_NUMBER[os.uname().machine], header, sets) != 0:
        raise OSError(ctypes.get_errno(), "capset")


if __name__ == "__main__":
    main()
