"""Judge texts of an assignment's module, each in a process of its own: trusted code, run apart.

Reads an order and then jobs, JSON in a line each, from stdin, and writes an outcome a line to
stdout, each as soon as it is known: the reader learns in which check an endless mutant hangs. What
all jobs need is imported and read once. Where the system can, each job is a fork of that, so that
nothing of one text reaches the next.
"""

from __future__ import annotations

import contextlib
import gc
import json
import math
import os
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from types import FrameType
from typing import Any, TextIO

from ..assignment.bundle import Bundle, read_folder
from ..grading.check import Check
from ..grading.failures import CheckFailed
from ..grading.local import LocalStudent
from ..grading.outcome import Outcome, Status
from ..grading.runner import run_checks
from ..grading.trial import Student, Trial

MEMORY = 3 << 30  # bytes of address space; a mutant that asks for more has failed


class _Enough(Exception):
    """The first failure is all that was asked for."""


def main() -> None:
    """Do the jobs on stdin, one after another; without fork only the first."""
    order = json.loads(sys.stdin.readline())
    bundle = read_folder(Path(order["folder"]), secret=bytes.fromhex(order["secret"]))
    results = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # what a mutant prints is no result
    gc.freeze()  # a collection in a fork would copy every page
    for line in sys.stdin:
        if not hasattr(os, "fork"):
            _do(json.loads(line), bundle, results)
            return
        child = os.fork()
        if child == 0:
            try:
                _do(json.loads(line), bundle, results)
            except BaseException:  # this process must not go on as its parent would
                sys.excepthook(*sys.exc_info())
            finally:
                os._exit(0)
        os.waitpid(child, 0)
        results.write('\n{"over": "the job"}\n')  # on a line of its own, wherever the job ended
        results.flush()


def _do(job: Mapping[str, Any], bundle: Bundle, results: TextIO) -> None:
    _limit_memory()
    _limit_time(job["seconds"])
    with contextlib.suppress(_Enough):
        judge(job, bundle, results)
    results.write('{"end": true}\n')
    results.flush()


def judge(job: Mapping[str, Any], bundle: Bundle, results: TextIO) -> None:
    """Run the checks of a job.

    Args:
        job: "text" of the module, "first" (stop at the first failure), "task" (whose checks run
            first, or ""), "passed" and "failed": ids of checks whose outcome is known and that do
            not run again, "seconds" of processor time for one check, "seconds_of" those that have
            a time of their own, by id, "trace" (with each outcome the names of the module's
            functions that its check has entered).
        bundle: of the assignment.
        results: gets a JSON object a line.
    """
    sources = {**bundle.brought, bundle.manifest.module: job["text"]}
    if bundle.adapters is not None:
        sources["adapters"] = bundle.adapters
    began = time.process_time()
    entered: set[str] = set()
    if job["trace"]:
        sys.setprofile(_trace(bundle.manifest.module, entered))
    known = set(job["passed"]) | set(job["failed"])
    checks = [
        replace(check, body=_fail) if check.id in job["failed"] else check
        for check in sorted(bundle.checks, key=lambda check: check.task != job["task"])
        if check.id not in job["passed"]
    ]

    def report(outcome: Outcome) -> None:
        if outcome.id in known:
            return
        found = {**outcome.to_json(), "cpu": time.process_time() - began}
        if job["trace"]:
            found["entered"] = sorted(entered)
            entered.clear()
        results.write(json.dumps(found, default=_plain) + "\n")
        results.flush()
        if job["first"] and outcome.status is not Status.PASSED:
            raise _Enough

    def announce(check: Check) -> Check:
        """The check, telling that it begins: what runs when time is up, is lost."""

        def body(trial: Trial) -> None:
            nonlocal began
            began = time.process_time()
            _limit_time(job["seconds_of"].get(check.id, job["seconds"]))
            results.write(json.dumps({"begins": check.id}) + "\n")
            results.flush()
            check.body(trial)

        body.__doc__ = check.body.__doc__
        return replace(check, body=body)

    def open_student(substitutes: Mapping[str, Callable[..., Any]]) -> Student:
        return LocalStudent(sources, substitutes)

    run_checks([announce(each) for each in checks], bundle.setting, open_student, on_outcome=report)


def _trace(module: str, entered: set[str]) -> Callable[[FrameType, str, Any], None]:
    """Notes which functions of the module are entered."""

    def note(frame: FrameType, event: str, _: Any) -> None:
        if event == "call" and frame.f_globals.get("__name__") == module:
            entered.add(frame.f_code.co_qualname.partition(".<locals>")[0])

    return note


def _fail(trial: Trial) -> None:
    """Stands in for a check that is known to fail, so that what needs it gets the reference."""
    raise CheckFailed(f"{trial.check.id} is known to fail")


def _plain(value: Any) -> Any:
    return value.tolist() if hasattr(value, "tolist") else str(value)


def _limit_memory() -> None:
    """Bound memory, where the system can."""
    if find_spec("resource") is not None:
        resource = import_module("resource")
        with contextlib.suppress(ValueError, OSError):
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def _limit_time(seconds: float) -> None:
    """Bound processor time from now on, where the system can; a busy machine does not change it."""
    if find_spec("resource") is not None:
        resource = import_module("resource")
        until = math.ceil(time.process_time() + seconds)
        with contextlib.suppress(ValueError, OSError):
            resource.setrlimit(resource.RLIMIT_CPU, (until, resource.RLIM_INFINITY))


if __name__ == "__main__":
    main()
