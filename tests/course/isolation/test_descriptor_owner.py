"""No descriptor of a worker signals the grader, also where Landlock does not keep signals in."""

from __future__ import annotations

import platform
import shutil
import signal
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from photograd_course.worker import call_arguments, launch, syscall_filter
from photograd_course.worker.home import WorkerHome

from course.isolation.conftest import need
from course.isolation.support import submission

FCNTL = {"x86_64": 72, "aarch64": 25}.get(platform.machine())
# Nobody minds SIGURG; with SIGKILL in its place the grader would be gone.
ATTACK = f"""
import ctypes, os
libc = ctypes.CDLL(None, use_errno=True)

def call(descriptor, command, argument):
    words = (ctypes.c_long(each) for each in ({FCNTL}, descriptor, command, argument))
    return -ctypes.get_errno() if libc.syscall(*words) < 0 else 0

def f(upper):
    source, sink = os.pipe()
    owner = (ctypes.c_int * 2)(1, os.getppid())
    found = [
        call(source, 8 | upper, os.getppid()),
        call(source, 15 | upper, ctypes.addressof(owner)),
        call(source, 10 | upper, {int(getattr(signal, "SIGURG", 0))}),
    ]
    call(source, 4, 0o20000)
    os.write(sink, b"x")
    return found
"""
OWNERS = (8, 10, 15)  # F_SETOWN, F_SETSIG, F_SETOWN_EX
WAIT = 0.2  # seconds for a signal that should not come

pytestmark = pytest.mark.skipif(
    sys.platform != "linux" or FCNTL is None, reason="needs Linux and the number of its fcntl"
)


@pytest.fixture
def signals() -> Iterator[list[int]]:
    """Those that reached this process."""
    found: list[int] = []
    before = signal.signal(signal.SIGURG, lambda number, _frame: found.append(number))
    yield found
    signal.signal(signal.SIGURG, before)


def answers(home: WorkerHome, mode: str) -> list[list[int]]:
    """What a worker without Landlock's scopes gets, for plain commands and with a bit too many."""
    program = Path(home.program) / "photograd_worker" / "landlock.py"
    text = program.read_text(encoding="utf-8")
    assert "SCOPES_SINCE = 4, 6" in text
    program.write_text(
        text.replace("SCOPES_SINCE = 4, 6", "SCOPES_SINCE = 4, 99"), encoding="utf-8"
    )
    shutil.rmtree(program.parent / "__pycache__")
    home.imports = ("ctypes",)
    student = submission(ATTACK, home, mode)
    try:
        found = [list(student.call("toy.f", [upper], seconds=5.0)) for upper in (0, 1 << 32)]
        time.sleep(WAIT)
        return found
    finally:
        student.close()


def test_no_descriptor_is_given_another_owner(
    strict: str, home: WorkerHome, signals: list[int]
) -> None:
    assert answers(home, strict) == [[-1, -1, -1]] * 2  # EPERM
    assert signals == []


def test_without_the_filter_the_grader_is_signalled(
    home: WorkerHome, signals: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    mode = need("D")
    everything = (*call_arguments.COMMANDS, *OWNERS)
    monkeypatch.setattr(call_arguments, "COMMANDS", everything)
    monkeypatch.setattr(launch, "_filter", lambda **_: syscall_filter.compiled_filter.__wrapped__())
    assert answers(home, mode) == [[0, 0, 0]] * 2
    assert signals
