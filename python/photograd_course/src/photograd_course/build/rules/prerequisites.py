"""Assignments that come before exist."""

from __future__ import annotations

from collections.abc import Iterator

from ..assignment_build import AssignmentBuild


def check_prerequisites(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    if build.manifest.folder_name != build.folder.name:
        yield f"the folder should be called {build.manifest.folder_name}"
    for each in build.manifest.prerequisites:
        if each not in build.siblings:
            yield f"prerequisite {each} does not exist"
        elif each >= build.manifest.id:
            yield f"prerequisite {each} does not come before {build.manifest.id}"
