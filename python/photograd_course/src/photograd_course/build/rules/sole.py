"""Every check is the only one to notice some mutant, named or automatic, or says why it stays.

An automatic mutant was run up to the first check that notices it. For a check still in question,
those that it noticed first run through the checks after it, until one is noticed by nothing else.
"""

from __future__ import annotations

from collections.abc import Iterator

from ...grading.check import Check
from ..assignment_build import AssignmentBuild
from ..judging import WORKERS, Job


def check_sole(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    named = {v.lost[0] for v in build.mutant_verdicts.values() if len(v.lost) == 1}
    for check in build.checks:
        if not check.sole and check.id not in named and not _alone(build, check):
            yield (
                f"{check.id} is never the only check to notice a mutant: "
                "give a mutant for it, say why it stays with sole=, or drop it"
            )


def _alone(build: AssignmentBuild, check: Check) -> bool:
    pairs = zip(build.automatic, build.automatic_verdicts, strict=True)
    jobs = [
        Job(
            mutant.text,
            first=True,
            task=mutant.task,
            passed=(*verdict.passed, *build.unreached_by(mutant)),
            failed=verdict.lost,
        )
        for mutant, verdict in pairs
        if verdict.lost == (check.id,)
    ]
    for start in range(0, len(jobs), WORKERS):
        verdicts = build.judge.judge_all(jobs[start : start + WORKERS])
        if any(not verdict.lost for verdict in verdicts):
            return True
    return False
