"""Named mutants and alternatives of an assignment: solutions that are wrong, or right otherwise.

`mutants/<name>.py` opens with the sentence that a student with this mistake is told, and holds
``TASKS`` (where the mistake is), ``LOSES`` (exactly the checks that fail) and ``REPLACE``, pairs of
old and new text of the solution. `alternatives/<name>.py` is a whole module that earns everything.
"""

from __future__ import annotations

import ast
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import SceneError, message


@dataclass(frozen=True)
class NamedMutant:
    """One mistake: its name, the hint, its tasks, the checks it fails, and how to make it."""

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
    """The named mutants of an assignment's folder, by name.

    Raises:
        SceneError: a file lacks its sentence or one of its three names, or they hold no literals.
    """
    return tuple(_read_mutant(path) for path in sorted((folder / "mutants").glob("*.py")))


def read_alternatives(folder: Path) -> dict[str, str]:
    """Name to text of the alternatives of an assignment's folder."""
    paths = sorted((folder / "alternatives").glob("*.py"))
    return {path.stem: path.read_text(encoding="utf-8") for path in paths}


def _read_mutant(path: Path) -> NamedMutant:
    tree = ast.parse(path.read_text(encoding="utf-8"), path.name)
    values: dict[str, object] = {}
    for node in tree.body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            try:
                values[node.targets[0].id] = ast.literal_eval(node.value)
            except ValueError as error:
                raise _bad(path, "literals only", f"line {node.lineno}") from error
    sentence = (ast.get_docstring(tree) or "").strip()
    if not sentence:
        raise _bad(path, "a first line that says what is wrong", "no docstring")
    tasks, loses = (_strings(path, key, values.get(key)) for key in ("TASKS", "LOSES"))
    replace = values.get("REPLACE")
    if not isinstance(replace, Sequence) or not replace:
        raise _bad(path, "REPLACE = [(old, new), ...]", repr(replace))
    pairs = []
    for pair in replace:
        old, new = _strings(path, "REPLACE", pair)
        pairs.append((old, new))
    return NamedMutant(path.stem, sentence.splitlines()[0], tasks, loses, tuple(pairs))


def _strings(path: Path, key: str, value: object) -> tuple[str, ...]:
    if not isinstance(value, (tuple, list)) or not all(isinstance(each, str) for each in value):
        raise _bad(path, f"{key}, a tuple of strings", repr(value))
    return tuple(value)


def _bad(path: Path, expected: str, got: str) -> SceneError:
    return SceneError(message("read_mutants", f"mutants/{path.name}", expected, got))
