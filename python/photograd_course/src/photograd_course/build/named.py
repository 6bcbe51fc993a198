"""Named mutants and alternatives of an assignment: solutions that are wrong, or right otherwise.

`mutants.toml` has a table for each task and in it a row for each mutant: the checks that fail, the
sentence that a student with this mistake is told, then old and new text, in pairs. Checks are named
without their task, those of other tasks in full. Which mutants a check kills follows from the
rows, and the rules prove them. `alternatives/<name>.py` holds the functions of a
solution that earns everything; the starter has the rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ..assignment.manifest import read_manifest
from ..assignment.toml import read_toml
from ..errors import SceneError, message
from .filling import fill
from .regions import strip_solution

ROW = '["checks", "what is wrong", "old", "new", ...]'


@dataclass(frozen=True)
class NamedMutant:
    """One mistake.

    Attributes:
        name: unique in the assignment.
        diagnosis: the sentence that a student with this mistake is told.
        tasks: those of the checks that fail, sorted; the mistake is in the first of them.
        loses: ids of exactly the checks that fail.
        replace: pairs of an old text, once in the solution, and a new one.
    """

    name: str
    diagnosis: str
    tasks: tuple[str, ...]
    loses: tuple[str, ...]
    replace: tuple[tuple[str, str], ...]

    def apply(self, source: str) -> str:
        """The solution with this mistake.

        Raises:
            SceneError: an old text does not occur exactly once.
        """
        for old, new in self.replace:
            if (count := source.count(old)) != 1:
                wanted = f"{old!r} once in the solution"
                raise SceneError(message("mutant", self.name, wanted, f"{count} times"))
            source = source.replace(old, new)
        return source


def read_mutants(folder: Path) -> tuple[NamedMutant, ...]:
    """The named mutants of an assignment's folder, in the order of its file; none without one.

    Raises:
        SceneError: a row has another form, or a name occurs twice.
    """
    path = folder / "mutants.toml"
    tables = read_toml(path) if path.exists() else {}
    found: dict[str, NamedMutant] = {}
    for task, rows in tables.items():
        if not isinstance(rows, dict):
            raise _bad(task, f"a table of rows name = {ROW}", repr(rows))
        for name, row in rows.items():
            if name in found:
                raise _bad(name, "a name of its own", "it occurs twice")
            found[name] = _mutant(task, name, row)
    return tuple(found.values())


def read_alternatives(folder: Path) -> dict[str, str]:
    """Name to text of the alternatives of an assignment's folder, filled into the starter."""
    name = read_manifest(folder).module
    source = (folder / f"{name}.py").read_text(encoding="utf-8")
    starter = strip_solution(source, f"{name}.py")
    paths = sorted((folder / "alternatives").glob("*.py"))
    return {path.stem: fill(starter, path.read_text(encoding="utf-8"), name) for path in paths}


def _mutant(task: str, name: str, row: object) -> NamedMutant:
    if not isinstance(row, Sequence) or not all(isinstance(each, str) for each in row):
        raise _bad(name, ROW, repr(row))
    if len(row) < 4 or len(row) % 2 or not row[1].strip():
        raise _bad(name, ROW, f"{len(row)} texts, the second {row[1:2]}")
    loses = tuple(each if "." in each else f"{task}.{each}" for each in row[0].split())
    tasks = tuple(sorted({each.rpartition(".")[0] for each in loses} | {task}))
    pairs = tuple(zip(row[2::2], row[3::2], strict=True))
    return NamedMutant(name, row[1], tasks, loses, pairs)


def _bad(name: str, expected: str, got: str) -> SceneError:
    return SceneError(message("read_mutants", f"mutants.toml: {name}", expected, got))
