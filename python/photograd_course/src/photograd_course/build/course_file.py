"""`assignments/course.toml`: which assignments the course has, and in which week of which track.

    [[assignment]]
    id = "01"

    [[assignment]]
    id = "02"
    title = "A backpropagation engine"
    hours = 8
    prerequisites = ["01"]

    [track.quarter]
    title = "One quarter"
    weeks = [["01", "02"], ["03"]]

An assignment is *ready* when its folder exists; others are planned. Title, hours and prerequisites
of one that is ready stand in its manifest, and only there.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tomlkit

from ..assignment.manifest import read_manifest
from ..assignment.toml import read_toml
from ..errors import RangeError, SceneError, message
from ..suggest import choose_from
from .kits import PLAN, manifest_folders

NAME = PLAN
FACTS = ("title", "hours", "prerequisites")  # of an assignment, in its manifest


@dataclass(frozen=True)
class Entry:
    """One assignment of the plan."""

    id: str
    title: str
    hours: float
    prerequisites: tuple[str, ...]
    ready: bool
    twice: tuple[str, ...] = ()  # what the plan says of it although its manifest does


@dataclass(frozen=True)
class Track:
    """Assignments by week, in order."""

    name: str
    title: str
    weeks: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Course:
    """The parsed file."""

    entries: Mapping[str, Entry]
    tracks: Mapping[str, Track]

    def track(self, name: str) -> Track:
        """A track by its name.

        Raises:
            RangeError: there is none.
        """
        if name not in self.tracks:
            remedy = choose_from(name, list(self.tracks))
            raise RangeError(message("syllabus", "--track", "a track", repr(name), remedy))
        return self.tracks[name]


def read_course(root: Path) -> Course:
    """Read `root/course.toml` and look which assignments are there.

    Raises:
        IoError: it is missing, or no TOML.
        SceneError: a key is missing or of the wrong kind.
    """
    table = read_toml(root / NAME)
    folders = {name[:2]: path for name, path in manifest_folders(root).items()}
    try:
        entries = {e["id"]: _entry(e, folders.get(e["id"])) for e in table["assignment"]}
        tracks = {
            name: Track(name, str(t["title"]), tuple(tuple(week) for week in t["weeks"]))
            for name, t in table["track"].items()
        }
    except (KeyError, TypeError, AttributeError) as error:
        expected = (
            "[[assignment]] with id, and where it has no folder with title, hours and "
            "prerequisites; [track.NAME] with title and weeks"
        )
        raise SceneError(message("read_course", NAME, expected, repr(error))) from error
    return Course(entries, tracks)


def course_findings(course: Course) -> list[str]:
    """What is wrong with the plan, in plain sentences."""
    found = [
        f"assignment {entry.id} needs {each}, which the course does not have"
        for entry in course.entries.values()
        for each in entry.prerequisites
        if each not in course.entries
    ]
    found += [
        f"assignment {entry.id} has {', '.join(entry.twice)} in its manifest: remove them here"
        for entry in course.entries.values()
        if entry.twice
    ]
    for track in course.tracks.values():
        done: set[str] = set()
        for week in track.weeks:
            for each in week:
                if each not in course.entries:
                    found.append(f"track {track.name} names {each}, which the course does not have")
                    continue
                missing = [p for p in course.entries[each].prerequisites if p not in done]
                if missing:
                    needs = ", ".join(missing)
                    found.append(
                        f"track {track.name}: {each} needs {needs}, which comes not before"
                    )
                done.add(each)
    return found


def plan_without(root: Path, folders: Collection[str]) -> bytes:
    """The plan for a place that has these folders only: the others are planned there.

    Args:
        root: where all are.
        folders: names of those that will be there.
    """
    document = tomlkit.parse((root / NAME).read_text(encoding="utf-8"))
    there = {name[:2] for name in folders}
    entries = read_course(root).entries
    for table in document["assignment"]:
        entry = entries[table["id"]]
        if entry.id not in there and not set(FACTS) & set(table):
            facts = (entry.title, entry.hours, list(entry.prerequisites))
            table.update(dict(zip(FACTS, facts, strict=True)))
    return tomlkit.dumps(document).encode()


def _entry(table: Mapping[str, Any], folder: Path | None) -> Entry:
    if folder is None:
        hours, needed = float(table["hours"]), tuple(table["prerequisites"])
        return Entry(table["id"], table["title"], hours, needed, ready=False)
    manifest = read_manifest(folder)
    twice = tuple(name for name in FACTS if name in table)
    needed = manifest.prerequisites
    return Entry(manifest.id, manifest.title, manifest.hours, needed, ready=True, twice=twice)
