"""The starter earns exactly nothing, every check saying "not implemented".

Where a student block gives other code than an exception, the checks of its task may fail otherwise.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from ..assignment_build import AssignmentBuild
from ..regions import find_regions


def check_starter(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    verdict = build.starter_verdict
    own = _tasks_with_own_stub(build)
    for each in verdict.outcomes:
        if each["status"] == "passed" or each["points"]:
            yield f"the starter passes {each['id']}"
        elif each["reason"] != "not implemented" and each["task"] not in own:
            yield (
                f"{each['id']} should say of the starter that it is not implemented, "
                f"it says: {each['reason']}, {each['text']}"
            )
        elif each["status"] == "error-ours":
            yield f"{each['id']} falters on the starter: {each['text']}"
    for check in verdict.hung:
        yield f"the starter does not come to an end in {check}"


def _tasks_with_own_stub(build: AssignmentBuild) -> set[str]:
    regions = find_regions(build.source, build.module_file)
    pairs = pairwise(regions)
    return {above.task for above, below in pairs if below.kind == "student"}
