"""System calls that are allowed with some arguments, as a program for the kernel's packet filter.

libseccomp can allow a list of values, or refuse one, but not refuse everything else with an error
of its own. So these few calls are decided by instructions of our own, which stand in front of
libseccomp's program: `Documentation/userspace-api/seccomp_filter.rst` and `linux/bpf_common.h`.
"""

from __future__ import annotations

import errno
import os
import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass

CLONE_THREAD = 0x10000
CLONE_NEW = 0x7E020080  # every namespace
O_PATH = getattr(os, "O_PATH", 0)  # a descriptor that Landlock does not look at
WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | O_PATH
# F_DUPFD, F_GETFD, F_SETFD, F_GETFL, F_SETFL, F_DUPFD_CLOEXEC, F_GETPIPE_SZ. Not among them:
# F_SETOWN, F_SETSIG and F_SETOWN_EX choose whom a descriptor signals when it is ready, and how:
# another way to kill. Leases, notices and locks (F_SETLEASE, F_NOTIFY) reach others, too.
COMMANDS = (0, 1, 2, 3, 4, 1030, 1032)
# What Python asks of a descriptor. `ioctl` also sets flags, labels and seals of files.
REQUESTS = ("TCGETS", "TIOCGWINSZ", "FIONREAD", "FIONBIO", "FIOCLEX", "FIONCLEX")
# PR_GET_PDEATHSIG, PR_GET_DUMPABLE, PR_SET_NAME, PR_GET_NAME, PR_GET_SECCOMP, PR_SET_TIMERSLACK,
# PR_GET_TIMERSLACK, PR_GET_NO_NEW_PRIVS, PR_SET_VMA (names of memory). Not among them: what ends
# a worker with its grader (PR_SET_PDEATHSIG), closes it to others (PR_SET_DUMPABLE), or lets it
# adopt, be traced, share a core or handle its own system calls.
OPTIONS = (2, 3, 15, 16, 21, 29, 30, 39, 0x53564D41)

LITTLE_ENDIAN = 0x40000000  # in an AUDIT_ARCH_ constant
S390 = (0x16, 0x80000016)  # there, `clone` takes the flags second
NUMBER, ARCH, ARGUMENTS = 0, 4, 16  # offsets in struct seccomp_data
LOAD, AND, EQUAL, JUMP, RETURN = 0x20, 0x54, 0x15, 0x05, 0x06
ALLOW, REFUSE = 0x7FFF0000, 0x00050000 | errno.EPERM
Instruction = tuple[int, int, int, int]


@dataclass(frozen=True)
class Word:
    """One half of an argument: what of it counts, and which values are allowed.

    Attributes:
        place: of the argument, from 0.
        values: of the masked half.
        mask: bits that are looked at. The kernel reads no more of an int than its low half.
        high: the upper half instead of the lower.
    """

    place: int
    values: Sequence[int]
    mask: int = 0xFFFFFFFF
    high: bool = False


def rules(arch: int) -> dict[str, tuple[Word, ...]]:
    """What each call may be given where AUDIT_ARCH_ is `arch`: all of its words must fit."""
    import termios

    requests = [getattr(termios, name) for name in REQUESTS if hasattr(termios, name)]
    return {
        # A thread, yes; a process, or a thread that leaves a namespace, no.
        "clone": (Word(int(arch in S390), (CLONE_THREAD,), CLONE_THREAD | CLONE_NEW),),
        "open": (Word(1, (0,), WRITING),),
        "openat": (Word(2, (0,), WRITING),),
        "fcntl": (Word(1, COMMANDS),),
        "fcntl64": (Word(1, COMMANDS),),
        "ioctl": (Word(1, requests),),
        "prctl": (Word(0, OPTIONS),),
        # Of this process, and without new limits.
        "prlimit64": (Word(0, (0,)), Word(2, (0,)), Word(2, (0,), high=True)),
    }


def program(arch: int, number_of: Callable[[str], int]) -> bytes:
    """Instructions that decide these calls on one architecture, and leave all others undecided.

    Args:
        arch: an AUDIT_ARCH_ constant.
        number_of: a call's number there, negative where it has none.
    """
    blocks: list[Instruction] = [(LOAD, 0, 0, NUMBER)]
    for name, words in rules(arch).items():
        if (number := number_of(name)) >= 0:
            blocks += _block(number, words, arch)
    start = [(LOAD, 0, 0, ARCH), (EQUAL, 1, 0, arch), (JUMP, 0, 0, len(blocks))]
    return b"".join(struct.pack("=HBBI", *each) for each in (*start, *blocks))


def _block(number: int, words: Sequence[Word], arch: int) -> list[Instruction]:
    body: list[Instruction] = []
    for word in words:
        upper = word.high == bool(arch & LITTLE_ENDIAN)
        offset = ARGUMENTS + 8 * word.place + 4 * upper
        body += [(LOAD, 0, 0, offset), (AND, 0, 0, word.mask)]
        count = len(word.values)
        body += [(EQUAL, count - k, 0, value) for k, value in enumerate(word.values)]
        body.append((RETURN, 0, 0, REFUSE))
    body.append((RETURN, 0, 0, ALLOW))
    return [(EQUAL, 0, len(body), number), *body]
