"""What every assignment must satisfy before it is given to anybody: one rule a file.

A rule is a function ``look(dossier) -> Iterator[str]`` that yields a sentence for each breach.
Those of the first group read; those of the second run the solution and its variants, which makes
sense only once the first group is content.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from ...errors import Error
from ..dossier import Dossier
from . import (
    alternatives,
    automatic,
    compiles,
    counts,
    faces,
    figures,
    hints,
    leaked_names,
    leaked_shingles,
    likeness,
    margins,
    markers,
    mutants,
    points,
    prerequisites,
    sole,
    solution,
    starter,
)

Look = Callable[[Dossier], Iterator[str]]

READING: dict[str, Look] = {
    "markers": markers.look,
    "compiles": compiles.look,
    "faces": faces.look,
    "points": points.look,
    "prerequisites": prerequisites.look,
    "counts": counts.look,
    "figures": figures.look,
    "leaked names": leaked_names.look,
    "leaked shingles": leaked_shingles.look,
    "likeness": likeness.look,
}
RUNNING: dict[str, Look] = {
    "solution": solution.look,
    "starter": starter.look,
    "mutants": mutants.look,
    "alternatives": alternatives.look,
    "margins": margins.look,
    "automatic": automatic.look,
    "sole": sole.look,
    "hints": hints.look,
}


@dataclass(frozen=True)
class Finding:
    """One breach: of which rule, where, and what."""

    rule: str
    assignment: str
    text: str

    def __str__(self) -> str:
        return f"{self.assignment}: {self.rule}: {self.text}"


def findings(dossier: Dossier) -> list[Finding]:
    """All breaches of all rules; those that need runs only when nothing else is wrong."""
    found = reading_findings(dossier)
    if not found:
        found = _apply(dossier, {"solution": solution.look})
    if not found:
        found = _apply(dossier, {name: k for name, k in RUNNING.items() if name != "solution"})
    return found


def reading_findings(dossier: Dossier) -> list[Finding]:
    """Breaches of the rules that run nothing."""
    found = _apply(dossier, {"markers": markers.look})
    if not found:
        found = _apply(dossier, {name: look for name, look in READING.items() if name != "markers"})
    return found


def seed_findings(dossier: Dossier) -> list[Finding]:
    """Breaches of the rules that depend on hidden seeds, for a course's own secret."""
    if all(check.visibility == "public" for check in dossier.checks):
        return []
    found = _apply(dossier, {"solution": solution.look})
    if not found:
        names = ("mutants", "alternatives", "margins")
        found = _apply(dossier, {name: RUNNING[name] for name in names})
    return found


def _apply(dossier: Dossier, rules: dict[str, Look]) -> list[Finding]:
    found = []
    for name, look in rules.items():
        try:
            sentences = list(look(dossier))
        except Error as error:  # a file that cannot even be read breaks the rule, too
            sentences = [str(error)]
        found += [Finding(name, dossier.folder.name, text) for text in sentences]
    return found
