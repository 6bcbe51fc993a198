"""Each alternative, right though written otherwise, earns everything."""

from __future__ import annotations

from collections.abc import Iterator

from ..assignment_build import AssignmentBuild


def check_alternatives(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    for name, verdict in build.alternative_verdicts.items():
        for each in verdict.outcomes:
            if each["status"] != "passed":
                yield f"{name} is right and does not pass {each['id']}: {each['text']}"
        for check in verdict.hung:
            yield f"{name} does not come to an end in {check}"
