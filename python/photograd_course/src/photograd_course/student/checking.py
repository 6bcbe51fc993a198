"""Run the public checks on this machine: each in a process of its own, on any system."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..assignment.bundle import Bundle
from ..errors import RangeError, message
from ..grading.check import Check
from ..grading.outcome import Outcome
from ..grading.remote import RemoteStudent
from ..grading.runner import adjoint_functions, run_checks
from ..grading.trial import Student
from ..one_thread import ONE_THREAD
from ..suggest import choose_from
from ..worker.process import WorkerProcess, install_program, plain_command, scratch_folder

START_SECONDS = 60.0  # a cold start of Python with NumPy on a slow laptop


def select(checks: Sequence[Check], task: str | None) -> list[Check]:
    """The checks of one task (id, or name of a function), or all.

    Raises:
        RangeError: there is no such task.
    """
    if task is None:
        return list(checks)
    chosen = [c for c in checks if task in (c.task, c.id) or task in c.calls]
    if not chosen:
        names = list(dict.fromkeys([c.task for c in checks] + [f for c in checks for f in c.calls]))
        remedy = choose_from(task, names)
        raise RangeError(message("check", "--task", "a task", repr(task), remedy))
    return chosen


def check_here(
    bundle: Bundle,
    files: Mapping[str, bytes],
    checks: Sequence[Check],
    on_outcome: Callable[[Outcome, str], None] | None = None,
    wrong: Mapping[str, str] | None = None,
    on_refused: Callable[[str], None] | None = None,
) -> list[Outcome]:
    """Run `checks` on a submission of this machine's user. The verdict is indicative only.

    Args:
        bundle: the public one.
        files: of the submission.
        checks: those to run.
        on_outcome: called after each with what the submission has printed meanwhile. Nothing is
            read from it: verdicts rest on the frames of another pipe.
        wrong: functions that are known to be wrong, to what says so; a check that needs one of
            them and fails is blocked.
        on_refused: called, before the first outcome, for each import that is not allowed.
    """
    hand = replace(bundle.hand(files), adjoints=adjoint_functions(checks))
    with scratch_folder() as scratch:
        home = install_program(Path(scratch))
        workers: list[WorkerProcess] = []
        told: set[str] = set()

        def tell(outcome: Outcome) -> None:
            if on_outcome is not None:
                on_outcome(outcome, "".join(worker.last_words() for worker in workers))
            workers.clear()

        def open_student(substitutes: Mapping[str, Callable[..., Any]]) -> Student:
            worker = WorkerProcess(plain_command(home), environment=_environment(), cwd=home)
            workers.append(worker)
            worker.request("start", {}, seconds=START_SECONDS)
            student = RemoteStudent(worker, replace(hand, substitutes=dict(substitutes)))
            for said in student.refused:
                if on_refused is not None and said not in told:
                    on_refused(said)
                told.add(said)
            return student

        return run_checks(checks, bundle.setting, open_student, on_outcome=tell, wrong=wrong)


def _environment() -> dict[str, str]:
    """What Python needs to start, and nothing that steers it; one thread for linear algebra."""
    needed = ("PATH", "SYSTEMROOT", "TEMP", "TMP", "HOME", "LANG", "LD_LIBRARY_PATH")
    kept = {name: os.environ[name] for name in needed if name in os.environ}
    # Unbuffered, since a worker is ended and does not end: nothing printed is lost.
    return {**kept, **ONE_THREAD, "PYTHONHASHSEED": "0", "PYTHONUNBUFFERED": "1"}
