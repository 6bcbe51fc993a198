"""Markers are balanced, of known names, and every task has a solution."""

from __future__ import annotations

from collections.abc import Iterator

from ..dossier import Dossier


def look(dossier: Dossier) -> Iterator[str]:
    """See the module."""
    known = {task.id for task in dossier.manifest.tasks}
    found = {part.task for part in dossier.parts}
    for task in sorted(found - known):
        yield f"{dossier.module_file} marks a solution of {task}, which is no task of the manifest"
    for task in sorted(known - found):
        yield f"{dossier.module_file} marks no solution of task {task}"
