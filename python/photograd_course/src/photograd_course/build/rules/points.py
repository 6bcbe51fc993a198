"""Points of checks and questions add up to those of the manifest."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ..assignment_build import AssignmentBuild


def check_points(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    sums = {
        "code": sum(check.points for check in build.checks),
        "questions": sum(question.points for question in build.questions),
    }
    promised = build.manifest.points
    for name, total in sums.items():
        if not math.isclose(total, promised.get(name, 0.0), abs_tol=1e-9):
            wanted = promised.get(name, 0.0)
            yield f"{name}: the manifest promises {wanted:g} points, the parts add up to {total:g}"
    for name in sorted(set(promised) - set(sums)):
        yield f"points.{name} is neither code nor questions"
    checked = {check.task for check in build.checks}
    for task in build.manifest.tasks:
        if task.id not in checked:
            yield f"task {task.id} has no check"
