"""The program that `run_autograder` starts: grade one submission and keep results.json up to date.

It does what `photograd course grade` does for one submission, and writes after every check, so that
what was proven counts even if the container is stopped. With `--modes` it grades nothing and says
which isolation the container has: its build ends with that.
"""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Sequence
from pathlib import Path

from ..grading.failures import GraderFault
from ..submissions.intake import take
from ..submissions.load import load
from ..submissions.one import Case, grade_guarded, grade_one
from ..submissions.report import Report
from ..submissions.report_gradescope import ResultsFile, best_earlier
from ..submissions.submission import Submission
from ..submissions.workers import Workers, isolated_workers
from ..worker.debuggers import close_to_debuggers
from ..worker.modes import probe
from ..worker.policy import TITLES

STUDENT = "submission"  # whose it is, Gradescope knows
STRICT = ("A", "B", "C")  # as root in a container; D shares its user with the grader


def main(words: Sequence[str] | None = None) -> int:
    """Grade and say how it went: 0, or 3 when the grader itself failed (then there is no score).

    Args:
        words: of the command line; by default this process's.
    """
    given = _options(words)
    if given.modes:
        return _say_modes()
    loaded = load(given.number, given.bundle, given.secret_file)
    bundle = loaded.read()
    results = ResultsFile(given.results, bundle, best_earlier(given.metadata))
    secrets = tuple(
        path.resolve()
        for path in (given.bundle, given.secret_file, given.submission, given.results)
    )
    with contextlib.ExitStack() as stack:
        workers: Workers | None = None
        unavailable = ""
        try:
            workers = stack.enter_context(isolated_workers(bundle.manifest, given.mode, secrets))
        except GraderFault as fault:
            unavailable = fault.text

        def grade() -> Report:
            taken = Case(STUDENT, take(bundle.manifest, given.submission), bundle, loaded.digest)
            outcomes = results.on_outcome
            return grade_one(taken, workers, unavailable=unavailable, on_outcome=outcomes)

        report = grade_guarded(Case(STUDENT, Submission({}), bundle, loaded.digest), workers, grade)
    results.finish(report)
    sys.stdout.write(f"isolation mode {report.mode}: {report.proven:g} of {report.max_score:g}\n")
    for line in report.staff:
        sys.stdout.write(f"staff: {line}\n")
    return 0 if report.is_sound else 3


def _say_modes() -> int:
    """Each mode and why it does not work here; 3 where none is left that isolates."""
    reasons = {mode: reason for mode, reason in probe().items() if mode in STRICT}
    for mode, reason in reasons.items():
        sys.stdout.write(f"isolation {TITLES[mode]}: {reason or 'works'}\n")
    return 0 if "" in reasons.values() else 3


def _options(words: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Grade one Gradescope submission.")
    parser.add_argument("number")
    parser.add_argument("--modes", action="store_true")
    parser.add_argument("--mode", default=None)
    needed = ("bundle", "secret-file", "submission", "metadata", "results")
    for name in needed:
        parser.add_argument(f"--{name}", type=Path)
    given = parser.parse_args(words)
    lacking = [name for name in needed if getattr(given, name.replace("-", "_")) is None]
    if lacking and not given.modes:
        parser.error(f"these are required: {', '.join(f'--{name}' for name in lacking)}")
    return given


if __name__ == "__main__":
    close_to_debuggers()
    sys.exit(main())
