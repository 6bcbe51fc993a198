"""Assignments that come before exist."""

from __future__ import annotations

from collections.abc import Iterator

from ..dossier import Dossier


def look(dossier: Dossier) -> Iterator[str]:
    """See the module."""
    if dossier.manifest.folder_name != dossier.folder.name:
        yield f"the folder should be called {dossier.manifest.folder_name}"
    for each in dossier.manifest.prerequisites:
        if each not in dossier.siblings:
            yield f"prerequisite {each} does not exist"
        elif each >= dossier.manifest.id:
            yield f"prerequisite {each} does not come before {dossier.manifest.id}"
