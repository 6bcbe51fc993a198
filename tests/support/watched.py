"""A trusted submission whose adjoints are watched, in this very process: no worker is started."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from photograd_course.assignment.bundle import Bundle, read_folder
from photograd_course.grading.check import Check
from photograd_course.grading.failures import StudentFailure
from photograd_course.grading.local import LocalStudent
from photograd_course.grading.outcome import Outcome
from photograd_course.grading.runner import run_checks
from photograd_course.worker.adjoint_trace import TooMuchToKeep
from photograd_course.worker.adjoint_watch import Watch
from photograd_course.worker.codec import round_trip

ROOT = Path(__file__).parents[2]
ASSIGNMENTS = {
    path.parent.name[:2]: path.parent
    for path in sorted((ROOT / "assignments").glob("*/assignment.toml"))
}


class WatchedStudent(LocalStudent):
    """What `LocalStudent` is, with runs under watch."""

    def __init__(
        self,
        sources: Mapping[str, str],
        substitutes: Mapping[str, Callable[..., Any]] | None = None,
    ) -> None:
        super().__init__(sources, substitutes)
        self._watch = Watch(sources, substitutes or {})

    def watch(
        self, function: str, args: Sequence[Any], puts: Any, *, seconds: float
    ) -> tuple[Any, Any]:
        """See Student."""
        del seconds
        given = [arg if callable(arg) else round_trip(arg) for arg in args]
        try:
            value, trace = self._watch.run(function, given, puts)
            return round_trip(value), round_trip(trace)
        except (Exception, TooMuchToKeep) as error:
            raise StudentFailure("raised", f"{function} raised {error!r}") from error


def judged(
    number: str, files: Mapping[str, str], only: Callable[[Check], bool] | None = None
) -> list[Outcome]:
    """Outcomes of the checks of an assignment that are about adjoints, hidden ones included.

    Args:
        number: of the assignment.
        files: module name to text, in place of the solution's.
        only: which of these checks; by default those that do not measure time.
    """
    bundle = read_bundle(number)
    sources = {**bundle.brought, bundle.manifest.module: bundle.solution, **files}
    if bundle.adapters is not None:
        sources["adapters"] = bundle.adapters
    checks = [
        check
        for check in bundle.checks
        if check.adjoints and (only(check) if only is not None else not is_cost(check))
    ]
    return run_checks(checks, bundle.setting, lambda given: WatchedStudent(sources, given))


def is_cost(check: Check) -> bool:
    """Whether it is about nothing but the cost."""
    return check.id.endswith(".cost")


def read_bundle(number: str) -> Bundle:
    """The bundle of an assignment, by its number."""
    return read_folder(ASSIGNMENTS[number], secret=b"secret of the tests")
