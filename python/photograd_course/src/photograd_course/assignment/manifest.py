"""`assignment.toml`: what an assignment is called, needs, contains and may cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import SceneError, message
from .toml import read_toml

MODES = ("A", "B", "C", "D", "E")


@dataclass(frozen=True)
class Task:
    """One task: functions to write, and the handout's section about them."""

    id: str
    title: str
    functions: tuple[str, ...]


@dataclass(frozen=True)
class Limits:
    """What one check may use in a worker."""

    seconds: float = 30.0  # of a whole check, as worker.clocks.Stopwatch counts them
    cpu_seconds: float = 30.0
    memory_mb: int = 768
    output_kb: int = 64


@dataclass(frozen=True)
class Manifest:
    """The parsed file.

    Attributes:
        id, name, title: "01", "gradient_descent", "Gradient descent in one and many dimensions".
        folder: where the files lie.
        module: the graded module's name, without ".py".
        submission: names of the files that a submission consists of.
        prerequisites: ids of assignments that come before.
        hours: of work, an estimate.
        tasks: in order.
        imports: what the graded module may import besides the pure modules of `worker.screen`.
        vocabulary: names from the solution that students may see.
        minimum_mode: weakest isolation that a verdict may rest on.
        points: {"code": 75, "questions": 25}, checked against checks and questions.
        limits: of one check.
    """

    id: str
    name: str
    title: str
    folder: Path
    module: str
    submission: tuple[str, ...]
    prerequisites: tuple[str, ...]
    hours: float
    tasks: tuple[Task, ...]
    imports: tuple[str, ...]
    vocabulary: tuple[str, ...]
    minimum_mode: str
    points: Mapping[str, float]
    limits: Limits

    @property
    def folder_name(self) -> str:
        """Such as "01_gradient_descent"."""
        return f"{self.id}_{self.name}"

    @property
    def brought(self) -> tuple[str, ...]:
        """Modules of earlier assignments in a submission, without ".py"; see `brought`."""
        names = (name.removesuffix(".py") for name in self.submission if name.endswith(".py"))
        return tuple(name for name in names if name != self.module)


_KEYS: dict[str, Any] = {
    "id": str,
    "name": str,
    "title": str,
    "module": str,
    "submission": list,
    "prerequisites": list,
    "hours": (int, float),
    "tasks": list,
    "imports": list,
    "vocabulary": list,
    "minimum_mode": str,
    "points": dict,
    "limits": dict,
}
_OPTIONAL: dict[str, Any] = {
    "prerequisites": [],
    "vocabulary": [],
    "minimum_mode": "C",
    "limits": {},
    "tasks": [],
}


def read_manifest(folder: Path) -> Manifest:
    """Read `folder/assignment.toml`.

    Raises:
        IoError: it is missing, or no TOML.
        SceneError: a key is unknown, missing or of the wrong type, or a value impossible.
    """
    path = folder / "assignment.toml"
    table = {**_OPTIONAL, **read_toml(path)}
    for key in table:
        if key not in _KEYS:
            raise _bad(path, key, f"one of {sorted(_KEYS)}", "an unknown key")
    for key, kind in _KEYS.items():
        if not isinstance(table.get(key), kind):
            raise _bad(path, key, str(kind), repr(table.get(key)))
    if table["minimum_mode"] not in MODES:
        raise _bad(path, "minimum_mode", f"one of {MODES}", repr(table["minimum_mode"]))
    if unknown := set(table["limits"]) - set(Limits.__dataclass_fields__):
        raise _bad(path, "limits", f"{sorted(Limits.__dataclass_fields__)}", f"{sorted(unknown)}")
    return Manifest(
        id=table["id"],
        name=table["name"],
        title=table["title"],
        folder=folder,
        module=table["module"],
        submission=tuple(table["submission"]),
        prerequisites=tuple(table["prerequisites"]),
        hours=float(table["hours"]),
        tasks=tuple(_task(path, entry) for entry in table["tasks"]),
        imports=tuple(table["imports"]),
        vocabulary=tuple(table["vocabulary"]),
        minimum_mode=table["minimum_mode"],
        points={key: float(value) for key, value in table["points"].items()},
        limits=Limits(**table["limits"]),
    )


def _task(path: Path, entry: Any) -> Task:
    if not isinstance(entry, dict) or set(entry) != {"id", "title", "functions"}:
        raise _bad(path, "tasks", "tables with id, title and functions", repr(entry))
    return Task(entry["id"], entry["title"], tuple(entry["functions"]))


def _bad(path: Path, key: str, expected: str, got: str) -> SceneError:
    return SceneError(message("read_manifest", f"{path.name}: {key}", expected, got))
