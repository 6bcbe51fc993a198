"""The filter of system calls: no network, processes, signals, files to write or strangers' memory.

A list of what is refused, not of what is allowed: Python, NumPy and the C library of next year may
make harmless calls that nobody has thought of. libseccomp compiles it once in the grader, for
whatever processor this is; the worker needs only the finished program.
"""

from __future__ import annotations

import errno
import importlib
import os
import tempfile
from functools import lru_cache
from typing import Any

REFUSED = {
    "network": "socket socketpair connect bind listen accept accept4",
    "processes": "fork vfork execve execveat unshare setns",
    "signals": "kill tkill tgkill rt_sigqueueinfo rt_tgsigqueueinfo pidfd_send_signal",
    "other processes": "ptrace process_vm_readv process_vm_writev process_madvise kcmp pidfd_open "
    "pidfd_getfd sched_setaffinity sched_setattr sched_setparam sched_setscheduler setpriority "
    "ioprio_set perf_event_open bpf userfaultfd",
    "memory outside the limit": "shmget shmat msgget semget mq_open memfd_create memfd_secret",
    "files": "creat truncate mkdir mkdirat mknod mknodat rmdir unlink unlinkat rename renameat "
    "renameat2 link linkat symlink symlinkat chmod fchmod fchmodat fchmodat2 chown fchown lchown "
    "fchownat setxattr lsetxattr fsetxattr removexattr lremovexattr fremovexattr utime utimes "
    "utimensat futimesat open_by_handle_at",
    "machine": "mount umount2 pivot_root chroot fsopen fsmount move_mount open_tree swapon swapoff "
    "reboot sethostname setdomainname init_module finit_module delete_module kexec_load "
    "kexec_file_load add_key request_key keyctl quotactl acct syslog personality fanotify_init "
    "settimeofday clock_settime adjtimex",
    "ways round this filter": "io_uring_setup io_uring_enter io_uring_register",
}
# The C library falls back on older calls, whose arguments a filter can see.
SAID_TO_BE_UNKNOWN = "clone3 openat2"
CLONE_THREAD = 0x10000
# F_SETOWN, F_SETSIG and F_SETOWN_EX of `fcntl` choose whom a descriptor signals when it is ready,
# and how: another way to kill. The kernel asks for the same user, which mode D shares, and only
# since 6.12 for Landlock's scope.
OWNERS = (8, 10, 15)
INT = 0xFFFFFFFF  # the kernel reads no more of an int, while a filter sees the whole register


@lru_cache(maxsize=1)
def compiled_filter() -> bytes:
    """The program for `worker.kernel.install_filter`.

    Raises:
        ImportError, RuntimeError, OSError: pyseccomp or libseccomp is missing, or too old.
    """
    # Not required by the course: the extra "grader" brings it.
    pyseccomp = importlib.import_module("pyseccomp")
    table = pyseccomp.SyscallFilter(pyseccomp.ALLOW)
    refusal = pyseccomp.ERRNO(errno.EPERM)
    for names in REFUSED.values():
        for name in names.split():
            _refuse(pyseccomp, table, refusal, name)
    for name in SAID_TO_BE_UNKNOWN.split():
        _refuse(pyseccomp, table, pyseccomp.ERRNO(errno.ENOSYS), name)
    masked = pyseccomp.MASKED_EQ
    # A thread, yes; a process, no.
    _refuse(pyseccomp, table, refusal, "clone", pyseccomp.Arg(0, masked, CLONE_THREAD, 0))
    for call, place in (("open", 1), ("openat", 2)):
        for flag in (os.O_WRONLY, os.O_RDWR, os.O_CREAT, os.O_TRUNC):
            _refuse(pyseccomp, table, refusal, call, pyseccomp.Arg(place, masked, flag, flag))
    for call in ("fcntl", "fcntl64"):
        for command in OWNERS:
            _refuse(pyseccomp, table, refusal, call, pyseccomp.Arg(1, masked, INT, command))
    _refuse(pyseccomp, table, refusal, "prlimit64", pyseccomp.Arg(0, pyseccomp.NE, 0))
    with tempfile.TemporaryFile() as file:
        table.export_bpf(file)
        file.seek(0)
        return file.read()


def _refuse(library: Any, table: Any, action: int, name: str, *args: Any) -> None:
    try:
        number = library.resolve_syscall(library.Arch.NATIVE, name)
    except (OSError, ValueError):  # newer than this libseccomp
        return
    if number >= 0:  # negative: this processor never had it
        table.add_rule(action, name, *args)
