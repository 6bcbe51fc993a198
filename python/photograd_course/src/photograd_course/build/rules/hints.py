"""`hints.json` of the folder is what the mutants give today."""

from __future__ import annotations

from collections.abc import Iterator

from ..dossier import Dossier
from ..hint_table import public_hints, read_hints


def look(dossier: Dossier) -> Iterator[str]:
    """See the module."""
    if read_hints(dossier.folder) != public_hints(dossier):
        yield "hints.json is not up to date: run 'photograd course build --update-hints'"
