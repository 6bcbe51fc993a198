"""What counts against a limit: the worker's own time, whatever machine and grader do besides."""

from __future__ import annotations

import os
import time
from typing import Any

import numpy as np
import pytest
from photograd_course.grading import Number, Status, Trial, check
from photograd_course.grading.failures import MachineTooBusy, StudentFailure
from photograd_course.grading.runner import Setting, run_checks
from photograd_course.worker import clocks, processes
from photograd_course.worker.clocks import FamilyClock, ProcessorClock, Stopwatch
from photograd_course.worker.home import WorkerHome

from course.isolation.support import CALL_SECONDS, PATIENT, submission

SUM = "def f(x):\n    return x + 1.0\n"
ASK = "def f(g):\n    return g(1.0)\n"
SLEEP = "import time\ndef f(x):\n    time.sleep(60)\n"
CROWD = """
import threading, zlib
def spin():
    data = bytes(1 << 22)
    while True:
        zlib.compress(data)
def f(x):
    for _ in range(8):
        threading.Thread(target=spin, daemon=True).start()
    spin()
"""


class Starving:
    """The clock of a worker that has been ready since, and has never had a processor."""

    def __init__(self) -> None:
        self._began = time.monotonic()

    def used(self) -> float:
        return 0.0

    def counted(self) -> tuple[float, float]:
        return 0.0, time.monotonic() - self._began


def test_reading_the_clock_of_a_filtered_worker_looks_at_no_other_process(
    strict: str, home: WorkerHome, monkeypatch: pytest.MonkeyPatch
) -> None:
    student = submission(SUM, home, strict)

    def scan(_pid: int) -> list[int]:
        raise AssertionError("looks for processes")

    monkeypatch.setattr(processes, "family", scan)
    before = student.cpu_seconds()
    student.call("toy.f", [1.0], seconds=10.0)
    after = student.cpu_seconds()
    assert before is not None
    assert after is not None
    assert after > before
    monkeypatch.undo()
    student.close()


def test_the_clock_counts_threads(strict: str, home: WorkerHome) -> None:
    text = """
    import threading, time
    def spin(seconds):
        end = time.thread_time() + seconds
        while time.thread_time() < end: pass
    def f(seconds):
        many = [threading.Thread(target=spin, args=(seconds,)) for _ in range(3)]
        for each in many: each.start()
        for each in many: each.join()
        return 0.0
    """
    student = submission(text, home, strict, PATIENT)
    before = student.cpu_seconds() or 0.0
    student.call("toy.f", [0.2], seconds=30.0)
    assert (student.cpu_seconds() or 0.0) - before >= 0.6
    student.close()


def test_what_the_grader_spends_is_left_out(strict: str, home: WorkerHome) -> None:
    student = submission(ASK, home, strict, PATIENT)

    def slow(x: float) -> float:
        time.sleep(2 * CALL_SECONDS)
        return x

    assert student.call("toy.f", [slow], seconds=CALL_SECONDS) == 1.0
    student.close()


def test_a_worker_that_sleeps_runs_into_its_limit(strict: str, home: WorkerHome) -> None:
    student = submission(SLEEP, home, strict, PATIENT)
    began = time.monotonic()
    with pytest.raises(StudentFailure, match="no answer"):
        student.call("toy.f", [0.0], seconds=CALL_SECONDS)
    assert time.monotonic() - began < clocks.MOST_WAITING * CALL_SECONDS
    student.close()


def test_threads_that_starve_one_another_gain_no_time(strict: str, home: WorkerHome) -> None:
    student = submission(CROWD, home, strict, PATIENT)
    with pytest.raises(StudentFailure) as caught:
        student.call("toy.f", [0.0], seconds=CALL_SECONDS)
    assert caught.value.reason == "timeout"
    student.close()


def test_a_starved_worker_is_no_fault_of_the_student(
    strict: str, home: WorkerHome, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(clocks, "MOST_WAITING", 2.0)
    monkeypatch.setattr(ProcessorClock, "counted", lambda _: (0.0, time.monotonic()))

    def body(t: Trial) -> None:
        """It is answered."""
        t.call("f", 0.0, returns=Number())

    made = check("1.x", points=1, calls=("f",), seconds=0.3)(body)
    (found,) = run_checks(
        [made],
        lambda _: Setting("toy", (1,)),
        lambda _given: submission(SLEEP, home, strict, PATIENT),
        open_control=lambda: submission(SUM, home, strict, PATIENT),
    )
    assert found.status is Status.ERROR_OURS
    assert MachineTooBusy.__name__ in found.text


def test_a_stopwatch_leaves_out_waiting_and_never_less_than_the_processor() -> None:
    starving = Stopwatch(1.0, Starving())
    time.sleep(0.05)
    assert starving.spent() == pytest.approx(0.0, abs=0.01)

    class Busy(Starving):
        """Two processors at once."""

        def counted(self) -> tuple[float, float]:
            passed = time.monotonic() - self._began
            return 2 * passed, passed

    busy = Stopwatch(1.0, Busy())
    time.sleep(0.05)
    assert busy.spent() >= 0.1
    began = time.monotonic()
    plain = Stopwatch(1.0, None)
    time.sleep(0.05)
    plain.excuse(0.05)
    spent = plain.spent()
    assert 0.0 <= spent <= time.monotonic() - began - 0.05


def test_where_a_worker_may_start_processes_waiting_excuses_nothing() -> None:
    values: list[Any] = [FamilyClock(os.getpid()).counted()]
    assert values == [(0.0, 0.0)]
    assert np.isfinite(FamilyClock(os.getpid()).used() or 0.0)
