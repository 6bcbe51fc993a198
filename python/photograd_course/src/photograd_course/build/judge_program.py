"""Judge one text of an assignment's module in a process of its own: trusted code, run apart.

Reads a job as JSON from stdin and writes an outcome a line to stdout, each as soon as it is known,
so that a reader of the bar knows in which check an endless mutant hangs.
"""

from __future__ import annotations

import contextlib
import json
import math
import os
import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any, TextIO

from ..assignment.bundle import read_folder
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
    """Do the job on stdin."""
    job = json.loads(sys.stdin.read())
    results = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # what a mutant prints is no result
    _limit(job["seconds"])
    with contextlib.suppress(_Enough):
        judge(job, results)
    results.write('{"end": true}\n')
    results.flush()


def judge(job: Mapping[str, Any], results: TextIO) -> None:
    """Run the checks of a job.

    Args:
        job: "folder", "secret" (hex), "text" of the module, "first" (stop at the first failure),
            "seconds" of processor time, "passed" and "failed": ids of checks whose outcome is known
            and that do not run again.
        results: gets a JSON object a line.
    """
    bundle = read_folder(Path(job["folder"]), secret=bytes.fromhex(job["secret"]))
    sources = {**bundle.brought, bundle.manifest.module: job["text"]}
    if bundle.adapters is not None:
        sources["adapters"] = bundle.adapters
    known = set(job["passed"]) | set(job["failed"])
    checks = [
        replace(check, body=_fail) if check.id in job["failed"] else check
        for check in bundle.checks
        if check.id not in job["passed"]
    ]

    def report(outcome: Outcome) -> None:
        if outcome.id in known:
            return
        results.write(json.dumps(outcome.to_json(), default=_plain) + "\n")
        results.flush()
        if job["first"] and outcome.status is not Status.PASSED:
            raise _Enough

    def announce(check: Check) -> Check:
        """The check, telling that it begins: what runs when time is up, is lost."""

        def body(trial: Trial) -> None:
            results.write(json.dumps({"begins": check.id}) + "\n")
            results.flush()
            check.body(trial)

        body.__doc__ = check.body.__doc__
        return replace(check, body=body)

    def open_student(substitutes: Mapping[str, Callable[..., Any]]) -> Student:
        return LocalStudent(sources, substitutes)

    run_checks([announce(each) for each in checks], bundle.setting, open_student, on_outcome=report)


def _fail(trial: Trial) -> None:
    """Stands in for a check that is known to fail, so that what needs it gets the reference."""
    raise CheckFailed(f"{trial.check.id} is known to fail")


def _plain(value: Any) -> Any:
    return value.tolist() if hasattr(value, "tolist") else str(value)


def _limit(seconds: float) -> None:
    """Bound memory and processor time, where the system can; a busy machine changes neither."""
    if find_spec("resource") is not None:
        resource = import_module("resource")
        cpu = math.ceil(seconds)
        with contextlib.suppress(ValueError, OSError):
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            resource.setrlimit(resource.RLIMIT_CPU, (cpu, cpu + 1))


if __name__ == "__main__":
    main()
