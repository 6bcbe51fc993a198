"""Find the hand-ins in a folder, as Gradescope, Canvas and Moodle export them, or in a table."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ..assignment.manifest import Manifest
from ..errors import IoError, SceneError, message
from .hand_in import HandIn, refused, wanted_names
from .intake import take, take_parts

# Canvas: "doejane_LATE_12345_67890_toy.py"; Moodle: "Jane Doe_12345_assignsubmission_file_".
_CANVAS = re.compile(r"^([^_]+)_(?:LATE_)?(\d+)_\d+_(.+)$")
_MOODLE = re.compile(r"^(.+?)_(\d+)_assignsubmission_file_?(.*)$")
_YAML_KEY = re.compile(r"^(submission_\d+|[\w.-]+):\s*$")
_YAML_NAME = re.compile(r"^\s+-?\s*:(name|email|sid):\s*(.*)$")


@dataclass(frozen=True)
class Source:
    """Where one student's hand-in lies: at a path, or in several single files."""

    student: str
    path: Path
    parts: Mapping[str, Path] = field(default_factory=dict)

    def take(self, manifest: Manifest) -> HandIn:
        """Take it into memory; never raises for what it holds."""
        if self.parts:
            return take_parts(manifest, self.parts)
        if not self.path.exists():
            return refused(f"there is nothing at {self.path.name}")
        return take(manifest, self.path)


def find_sources(manifest: Manifest, path: Path) -> list[Source]:
    """All hand-ins at ``path``, sorted by student.

    Args:
        manifest: of the assignment.
        path: one hand-in; a folder of hand-ins; or a CSV table with the columns student and path,
            where paths are relative to the table.

    Raises:
        IoError: nothing is there.
        SceneError: the table lacks a column, or a student occurs twice.
    """
    if not path.exists():
        raise IoError(message("grade", str(path), "a hand-in, a folder or a CSV table", "nothing"))
    if path.suffix.lower() == ".csv":
        return _from_table(path)
    if path.is_file() or _is_hand_in(manifest, path):
        return [Source(path.stem if path.is_file() else path.name, path)]
    sources = _from_folder(path)
    if not sources:
        raise IoError(message("grade", str(path), "hand-ins", "an empty folder"))
    return _distinct(sources)


def is_batch(manifest: Manifest, path: Path) -> bool:
    """Whether ``path`` is a table or a folder of hand-ins rather than one of them."""
    is_table = path.suffix.lower() == ".csv"
    return is_table or (path.is_dir() and not _is_hand_in(manifest, path))


def _is_hand_in(manifest: Manifest, folder: Path) -> bool:
    return folder.is_dir() and any((folder / name).is_file() for name in wanted_names(manifest))


def _from_table(path: Path) -> list[Source]:
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = list(csv.DictReader(file))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise IoError(message("grade", str(path), "a CSV table", str(error))) from error
    if not rows or not {"student", "path"} <= set(rows[0]):
        raise SceneError(
            message("grade", path.name, "columns student and path, and rows", "others")
        )
    sources = [Source(str(row["student"]), path.parent / str(row["path"])) for row in rows]
    names = [source.student for source in sources]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise SceneError(message("grade", path.name, "each student once", f"{twice} more often"))
    return sorted(sources, key=lambda source: source.student)


def _from_folder(folder: Path) -> list[Source]:
    names = _gradescope_names(folder / "submission_metadata.yml")
    sources: list[Source] = []
    loose: dict[str, dict[str, Path]] = {}
    for entry in sorted(folder.iterdir()):
        if entry.name.startswith((".", "__")) or entry.name == "submission_metadata.yml":
            continue
        if moodle := _MOODLE.match(entry.name):
            student = f"{moodle[1]} ({moodle[2]})"
            if moodle[3] and not entry.is_dir():  # all files in one folder
                loose.setdefault(student, {})[moodle[3].removeprefix("_")] = entry
            else:
                sources.append(Source(student, entry))
        elif not entry.is_dir() and (canvas := _CANVAS.match(entry.name)):
            loose.setdefault(f"{canvas[1]} ({canvas[2]})", {})[canvas[3]] = entry
        elif entry.is_dir():
            sources.append(Source(names.get(entry.name, entry.name), entry))
        elif entry.suffix.lower() in {".zip", ".py"}:
            sources.append(Source(entry.stem, entry))
    return sources + [Source(who, folder, parts) for who, parts in loose.items()]


def _distinct(sources: list[Source]) -> list[Source]:
    """Students of the same name told apart by what their hand-ins are called."""
    names = [source.student for source in sources]
    told = [
        source
        if names.count(source.student) == 1
        else Source(f"{source.student} ({source.path.name})", source.path, source.parts)
        for source in sources
    ]
    return sorted(told, key=lambda source: source.student)


def _gradescope_names(path: Path) -> dict[str, str]:
    """Folder to submitters, out of the few lines of YAML that Gradescope writes."""
    if not path.is_file():
        return {}
    found: dict[str, list[str]] = {}
    current: list[str] = []
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        if key := _YAML_KEY.match(line):
            current = found.setdefault(key[1], [])
        elif (entry := _YAML_NAME.match(line)) and entry[1] == "name":
            current.append(entry[2].strip().strip("'\""))
    return {key: " & ".join(names) for key, names in found.items() if names}
