"""Find the submissions in a folder, as Gradescope, Canvas and Moodle export them, or in a table."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import yaml

from ..assignment.manifest import Manifest
from ..errors import IoError, SceneError, message
from ..input_files import read_file
from .intake import take, take_parts
from .submission import Submission, refused, wanted_names

# Canvas: "doejane_LATE_12345_67890_toy.py"; Moodle: "Jane Doe_12345_assignsubmission_file_".
_CANVAS = re.compile(r"^([^_]+)_(?:LATE_)?(\d+)_\d+_(.+)$")
_MOODLE = re.compile(r"^(.+?)_(\d+)_assignsubmission_file_?(.*)$")
# Stricter than the safe loader: it takes every scalar for text and no tag for a type, so that an
# export's Ruby objects are read, and merges nothing, so that an alias costs nothing.
_PLAIN = getattr(yaml, "CBaseLoader", yaml.BaseLoader)
LARGEST_NAMES = 32 << 20  # bytes; some 20 KB a submission, results included
MOST_SUBMITTERS, LONGEST_NAME = 20, 120


@dataclass(frozen=True)
class Source:
    """Where one student's submission lies: at a path, or in several single files."""

    student: str
    path: Path
    parts: Mapping[str, Path] = field(default_factory=dict)

    def take(self, manifest: Manifest) -> Submission:
        """Take it into memory; never raises for what it holds."""
        if self.parts:
            return take_parts(manifest, self.parts)
        if not self.path.exists():
            return refused(f"there is nothing at {self.path.name}")
        return take(manifest, self.path)


def find_sources(manifest: Manifest, path: Path) -> list[Source]:
    """All submissions at ``path``, sorted by student.

    Args:
        manifest: of the assignment.
        path: one submission; a folder of submissions; or a CSV table with the columns student and
            path, where paths are relative to the table.

    Raises:
        IoError: nothing is there.
        SceneError: the table lacks a column, or a student occurs twice.
    """
    if not path.exists():
        raise IoError(
            message("grade", str(path), "a submission, a folder or a CSV table", "nothing")
        )
    if path.suffix.lower() == ".csv":
        return _from_table(path)
    if path.is_file() or _is_submission(manifest, path):
        return [Source(path.stem if path.is_file() else path.name, path)]
    sources = _from_folder(path)
    if not sources:
        raise IoError(message("grade", str(path), "submissions", "an empty folder"))
    return _distinct(sources)


def is_batch(manifest: Manifest, path: Path) -> bool:
    """Whether ``path`` is a table or a folder of submissions rather than one of them."""
    is_table = path.suffix.lower() == ".csv"
    return is_table or (path.is_dir() and not _is_submission(manifest, path))


def _is_submission(manifest: Manifest, folder: Path) -> bool:
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
    """Students of the same name told apart by what their submissions are called."""
    names = [source.student for source in sources]
    told = [
        source
        if names.count(source.student) == 1
        else Source(f"{source.student} ({source.path.name})", source.path, source.parts)
        for source in sources
    ]
    return sorted(told, key=lambda source: source.student)


def _gradescope_names(path: Path) -> dict[str, str]:
    """Folder to submitters, where Gradescope has written them down.

    Raises:
        IoError: the file is too large, or no YAML.
    """
    if not path.is_file():
        return {}
    data = read_file("grade", path, LARGEST_NAMES + 1)
    remedy = "remove it, and folders go by their own names"
    if len(data) > LARGEST_NAMES:
        expected = f"at most {LARGEST_NAMES >> 20} MB"
        raise IoError(message("grade", path.name, expected, "more", remedy))
    try:
        table = yaml.load(data, Loader=_PLAIN)
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        got = " ".join(str(error).split())
        raise IoError(message("grade", path.name, "YAML", got, remedy)) from error
    found = {}
    for folder, entry in table.items() if isinstance(table, dict) else ():
        listed = entry.get(":submitters") if isinstance(entry, dict) else None
        who = listed[:MOST_SUBMITTERS] if isinstance(listed, list) else []
        names = [each.get(":name") for each in who if isinstance(each, dict)]
        if known := [name[:LONGEST_NAME] for name in names if isinstance(name, str) and name]:
            found[str(folder)] = " & ".join(known)
    return found
