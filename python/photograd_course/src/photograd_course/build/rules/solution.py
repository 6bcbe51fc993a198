"""The solution earns everything."""

from __future__ import annotations

from collections.abc import Iterator

from ..assignment_build import AssignmentBuild


def check_solution(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    verdict = build.solution_verdict
    for each in verdict.outcomes:
        if each["status"] != "passed":
            yield f"the solution does not pass {each['id']}: {each['text']}"
    for check in verdict.hung:
        yield f"the solution does not come to an end in {check}"
