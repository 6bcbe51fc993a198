"""Submissions listed in a CSV table: columns student and path, also id, email and late."""

from __future__ import annotations

import csv
from pathlib import Path

from ..errors import IoError, SceneError, message
from .source import Person, Source

_LATE = {"1", "late", "true", "x", "yes"}


def read_table(path: Path) -> list[Source]:
    """The submissions, by student.

    Args:
        path: of the table; paths in it are relative to it.

    Raises:
        IoError: it cannot be read.
        SceneError: it lacks a column, or names a student twice.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = list(csv.DictReader(file))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise IoError(message("grade", str(path), "a CSV table", str(error))) from error
    if not rows or not {"student", "path"} <= set(rows[0]):
        raise SceneError(
            message("grade", path.name, "columns student and path, and rows", "others")
        )
    sources = [_source(path, row) for row in rows]
    names = [source.student for source in sources]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise SceneError(message("grade", path.name, "each student once", f"{twice} more often"))
    return sorted(sources, key=lambda source: source.student)


def _source(path: Path, row: dict[str, str | None]) -> Source:
    student, where = str(row["student"]), row["path"] or ""
    person = Person(student, row.get("id") or "", row.get("email") or "")
    is_late = (row.get("late") or "").strip().lower() in _LATE
    problem = "" if where else f"{path.name} has no path for this student"
    return Source(student, path.parent / where, (), (person,), is_late, problem=problem)
