"""The calls that a worker must not make, made by a worker: each is refused by the kernel."""

from __future__ import annotations

import errno
import platform

import pytest
from photograd_course.grading import StudentFailure
from photograd_course.grading.remote import RemoteStudent
from photograd_course.worker.home import WorkerHome
from photograd_course.worker.system_calls import REFUSED, REVIEWED

from course.isolation.support import PATIENT, submission
from course.isolation.test_system_calls import NEWEST, number_of

SAID = {errno.EPERM, errno.ENOSYS}
# `int 0x80` with a number in eax and zeros elsewhere, as a function of no arguments.
ATTACK = """
import ctypes, mmap, os
libc = ctypes.CDLL(None, use_errno=True)

def made(numbers):
    found = []
    for number in numbers:
        words = (ctypes.c_long(each) for each in (number, -1, -1, -1, -1, -1, -1))
        result = libc.syscall(*words)
        found.append(ctypes.get_errno() if result < 0 else 0)
    return found

def made_by_interrupt(number):
    code = (b"\\x53\\xb8" + number.to_bytes(4, "little") + b"\\x31\\xdb\\x31\\xc9\\x31\\xd2"
            b"\\xcd\\x80\\x5b\\xc3")
    page = mmap.mmap(-1, 4096, prot=mmap.PROT_READ | mmap.PROT_WRITE | mmap.PROT_EXEC)
    page.write(code)
    start = ctypes.addressof(ctypes.c_char.from_buffer(page))
    return ctypes.CFUNCTYPE(ctypes.c_int)(start)()

def told(option, value):
    ctypes.set_errno(0)
    words = (ctypes.c_ulong(each) for each in (value, 0, 0, 0))
    return ctypes.get_errno() if libc.prctl(option, *words) < 0 else 0
"""


@pytest.fixture
def numbers() -> dict[str, int]:
    """Of everything that is refused with EPERM on this machine."""
    names = " ".join(REFUSED.values()).split()
    found = {name: number_of(name) for name in names if number_of(name) >= 0}
    found.pop("vhangup", None)  # would end the terminal that runs this, if it worked
    return found


def test_no_refused_call_gets_through(
    strict: str, home: WorkerHome, numbers: dict[str, int]
) -> None:
    home.imports = ("ctypes", "mmap")
    student = submission(ATTACK, home, strict, PATIENT)
    try:
        beyond = [*range(REVIEWED + 1, REVIEWED + 50), 10_000, 1 << 20]
        x32 = [0x40000000 + number for number in (0, 41, 57, 59, 520, 545)]
        for asked in (list(numbers.values()), beyond, x32):
            found = student.call("toy.made", [asked], seconds=5.0)
            assert set(found) <= SAID, dict(zip(asked, found, strict=True))
        assert set(student.call("toy.made", [beyond], seconds=5.0)) == {errno.ENOSYS}
        assert {"setxattrat", "file_setattr", "mount_setattr", "listmount"} <= set(numbers)
        assert set(NEWEST.values()) & set(numbers.values())
    finally:
        student.close()


@pytest.mark.skipif(platform.machine() != "x86_64", reason="machine code of x86-64")
def test_the_old_interrupt_leads_nowhere(strict: str, home: WorkerHome) -> None:
    home.imports = ("ctypes", "mmap")
    student = submission(ATTACK, home, strict, PATIENT)
    try:
        for number in (20, 37, 2, 5):  # getpid, kill, fork, open
            assert interrupted(student, number) in (-errno.ENOSYS, "died")
    finally:
        student.close()


def interrupted(student: RemoteStudent, number: int) -> object:
    """What the call returns; "died" where the kernel has no such interface."""
    try:
        return student.call("toy.made_by_interrupt", [number], seconds=5.0)
    except StudentFailure as failure:
        return failure.reason


def test_what_ends_a_worker_cannot_be_taken_back(strict: str, home: WorkerHome) -> None:
    home.imports = ("ctypes", "mmap")
    student = submission(ATTACK, home, strict, PATIENT)
    try:
        for option, value in ((1, 0), (1, 10), (4, 1), (36, 1)):
            assert student.call("toy.told", [option, value], seconds=5.0) == errno.EPERM, option
        assert student.call("toy.told", [3, 0], seconds=5.0) == 0  # PR_GET_DUMPABLE
    finally:
        student.close()
