"""Markers are balanced, of known names, and every task has a solution."""

from __future__ import annotations

from collections.abc import Iterator

from ..assignment_build import AssignmentBuild


def check_markers(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    known = {task.id for task in build.manifest.tasks}
    found = {part.task for part in build.parts}
    for task in sorted(found - known):
        yield f"{build.module_file} marks a solution of {task}, which is no task of the manifest"
    for task in sorted(known - found):
        yield f"{build.module_file} marks no solution of task {task}"
