"""What every assignment must satisfy before it is given to anybody: one rule a file.

A rule is a function ``check_NAME(build) -> Iterator[str]`` that yields a sentence for each breach.
Those of the first group read; those of the second run the solution and its variants, which makes
sense only once the first group is content.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from ...errors import Error
from ..assignment_build import AssignmentBuild
from . import (
    alternatives,
    automatic,
    compiles,
    counts,
    faces,
    figures,
    hints,
    imports,
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

Rule = Callable[[AssignmentBuild], Iterator[str]]

READING: dict[str, Rule] = {
    "markers": markers.check_markers,
    "compiles": compiles.check_compiles,
    "imports": imports.check_imports,
    "faces": faces.check_faces,
    "points": points.check_points,
    "prerequisites": prerequisites.check_prerequisites,
    "counts": counts.check_counts,
    "figures": figures.check_figures,
    "leaked names": leaked_names.check_leaked_names,
    "leaked shingles": leaked_shingles.check_leaked_shingles,
    "likeness": likeness.check_likeness,
}
RUNNING: dict[str, Rule] = {
    "solution": solution.check_solution,
    "starter": starter.check_starter,
    "mutants": mutants.check_mutants,
    "alternatives": alternatives.check_alternatives,
    "margins": margins.check_margins,
    "automatic": automatic.check_automatic,
    "sole": sole.check_sole,
    "hints": hints.check_hints,
}


@dataclass(frozen=True)
class Finding:
    """One breach: of which rule, where, and what."""

    rule: str
    assignment: str
    text: str

    def __str__(self) -> str:
        return f"{self.assignment}: {self.rule}: {self.text}"


def findings(build: AssignmentBuild) -> list[Finding]:
    """All breaches of all rules; those that need runs only when nothing else is wrong."""
    found = reading_findings(build)
    if not found:
        found = _apply(build, {"solution": solution.check_solution})
    if not found:
        found = _apply(build, {name: rule for name, rule in RUNNING.items() if name != "solution"})
    return found


def reading_findings(build: AssignmentBuild) -> list[Finding]:
    """Breaches of the rules that run nothing."""
    found = _apply(build, {"markers": markers.check_markers})
    if not found:
        found = _apply(build, {name: rule for name, rule in READING.items() if name != "markers"})
    return found


def seed_findings(build: AssignmentBuild) -> list[Finding]:
    """Breaches of the rules that depend on hidden seeds, for a course's own secret."""
    if all(check.visibility == "public" for check in build.checks):
        return []
    found = _apply(build, {"solution": solution.check_solution})
    if not found:
        names = ("mutants", "alternatives", "margins")
        found = _apply(build, {name: RUNNING[name] for name in names})
    return found


def _apply(build: AssignmentBuild, rules: dict[str, Rule]) -> list[Finding]:
    found = []
    for name, rule in rules.items():
        try:
            sentences = list(rule(build))
        except Error as error:  # a file that cannot even be read breaks the rule, too
            sentences = [str(error)]
        found += [Finding(name, build.folder.name, text) for text in sentences]
    return found
