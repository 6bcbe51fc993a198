"""Tolerances are calibrated: ten times above right answers, ten times below wrong ones."""

from __future__ import annotations

from collections.abc import Iterator

from ..assignment_build import AssignmentBuild
from ..judging import Verdict

FACTOR = 10.0


def check_margins(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    right = {"the solution": build.solution_verdict, **build.alternative_verdicts}
    for name, verdict in right.items():
        for check, margin in margins(verdict, passed=True).items():
            if not margin <= 1.0 / FACTOR:
                yield (
                    f"{check}: {name} is right and uses {margin:.2g} of the tolerance; "
                    f"at most {1.0 / FACTOR:g} is meant to be used"
                )
    for mutant in build.mutants:
        for check, margin in margins(build.mutant_verdicts[mutant.name], passed=False).items():
            if not margin >= FACTOR:
                yield (
                    f"{check}: {mutant.name} is wrong by only {margin:.3g} times the tolerance; "
                    f"at least {FACTOR:g} is meant"
                )


def margins(verdict: Verdict, *, passed: bool) -> dict[str, float]:
    """Error over tolerance by check: the largest one of a passed check, the fatal one of a failed.

    A check that failed by other than a tolerance has none.
    """
    found = {}
    for each in verdict.outcomes:
        details = each["details"]
        if passed and each["status"] == "passed" and "margin" in details:
            found[each["id"]] = float(details["margin"])
        if not passed and each["status"] == "failed" and "tolerance" in details:
            found[each["id"]] = float(details["error"]) / float(details["tolerance"])
    return found
