"""What is known about an assignment because it was run: counts for `photograd course doctor`."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from .assignment_build import AssignmentBuild, Bar, no_bar
from .course_files import build_of
from .judging import Verdict
from .rules import findings
from .rules.automatic import survivors
from .rules.margins import margins


def evidence(
    folder: Path, *, cache: Path | None = None, bar: Bar = no_bar, root: Path | None = None
) -> dict[str, Any]:
    """All counts of one assignment; `ok` is whether it keeps every rule.

    Args:
        folder: its source.
        cache: where verdicts are kept; by default in the checkout's build folder.
        bar: shows progress.
        root: the folder of assignments around it, by default its parent.

    Returns:
        Plain values. Margins: `right` is the largest share of a tolerance that a right answer uses
        (at most 0.1 is allowed), `wrong` the smallest multiple of it by which a named mutant fails
        (at least 10). None where the rules that read files already fail.
    """
    build = build_of(folder, root=root, cache=cache, bar=bar)
    found = [str(each) for each in findings(build)]
    reading_failed = found and "solution_verdict" not in vars(build)
    counts: dict[str, Any] = {"assignment": folder.name, "ok": not found, "findings": found}
    if reading_failed or build.solution_verdict.lost:
        return counts
    return {**counts, **_counts(build)}


def _counts(build: AssignmentBuild) -> dict[str, Any]:
    alive = survivors(build)
    listed = sum(any(each.fits(mutant) for each in build.equivalents) for mutant in alive)
    right = [build.solution_verdict, *build.alternative_verdicts.values()]
    wrong = list(build.mutant_verdicts.values())
    named = [set(build.mutant_verdicts[m.name].lost) == set(m.loses) for m in build.mutants]
    accepted = [not verdict.lost for verdict in build.alternative_verdicts.values()]
    return {
        "checks": len(build.checks),
        "questions": len(build.questions),
        "named_mutants": len(named),
        "named_mutants_as_listed": sum(named),
        "automatic_mutants": len(build.automatic),
        "automatic_mutants_killed": len(build.automatic) - len(alive),
        "equivalent": listed,
        "unexplained_survivors": len(alive) - listed,
        "alternatives": len(accepted),
        "alternatives_accepted": sum(accepted),
        "margin_right": max(_margins(right, passed=True), default=None),
        "margin_wrong": min(_margins(wrong, passed=False), default=None),
        "solution_seconds": sum(each["seconds"] for each in build.solution_verdict.outcomes),
    }


def _margins(verdicts: Iterable[Verdict], *, passed: bool) -> list[float]:
    return [value for each in verdicts for value in margins(each, passed=passed).values()]
