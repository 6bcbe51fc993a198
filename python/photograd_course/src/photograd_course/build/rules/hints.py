"""`hints.json` of the folder is what the mutants give today."""

from __future__ import annotations

from collections.abc import Iterator

from ..assignment_build import AssignmentBuild
from ..hint_table import public_hints, read_hints


def check_hints(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    if read_hints(build.folder) != public_hints(build):
        yield "hints.json is not up to date: run 'photograd course build --update-hints'"
