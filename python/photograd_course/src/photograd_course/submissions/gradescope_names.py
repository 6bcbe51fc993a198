"""Who submitted what, as `submission_metadata.yml` of a Gradescope export says."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import yaml

from ..errors import IoError, message
from .listing import Entry
from .source import Person
from .submission import Refused

METADATA = "submission_metadata.yml"
# Stricter than the safe loader: it takes every scalar for text and no tag for a type, so that an
# export's Ruby objects are read, and merges nothing, so that an alias costs nothing.
_PLAIN = getattr(yaml, "CBaseLoader", yaml.BaseLoader)
LARGEST_NAMES = 32 << 20  # bytes; some 20 KB a submission, results included
MOST_SUBMITTERS, LONGEST_NAME = 20, 120


@dataclass(frozen=True)
class Submitted:
    """Whose a folder of the export is, and whether it came late."""

    people: tuple[Person, ...]
    is_late: bool


def read_metadata(entry: Entry | None) -> dict[str, Submitted]:
    """Folder to submitters; empty without the file.

    Args:
        entry: the file.

    Raises:
        IoError: the file is too large, or no YAML.
    """
    if entry is None:
        return {}
    remedy = "remove it, and folders go by their own names"
    try:
        data = entry.read(LARGEST_NAMES + 1)
    except (OSError, Refused) as error:
        raise IoError(message("grade", entry.name, "a readable file", error, remedy)) from error
    if len(data) > LARGEST_NAMES:
        expected = f"at most {LARGEST_NAMES >> 20} MB"
        raise IoError(message("grade", entry.name, expected, "more", remedy))
    try:
        table = yaml.load(data, Loader=_PLAIN)
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        got = " ".join(str(error).split())
        raise IoError(message("grade", entry.name, "YAML", got, remedy)) from error
    entries = table.items() if isinstance(table, dict) else ()
    return {str(folder): _submitted(each) for folder, each in entries if isinstance(each, dict)}


def _submitted(entry: Mapping[Any, Any]) -> Submitted:
    listed = entry.get(":submitters")
    who = listed[:MOST_SUBMITTERS] if isinstance(listed, list) else []
    people = [
        Person(_text(each, ":name"), _text(each, ":sid"), _text(each, ":email"))
        for each in who
        if isinstance(each, dict) and _text(each, ":name")
    ]
    return Submitted(tuple(people), _is_late(entry))


def _is_late(entry: Mapping[Any, Any]) -> bool:
    """A mark that is true, or a lateness such as "01:30:00" that is not zero."""
    told = " ".join(_text(entry, key).lower() for key in (":late", ":is_late", ":status"))
    if {"true", "yes", "late"} & set(told.split()):
        return True
    return any(digit in "123456789" for digit in _text(entry, ":lateness"))


def _text(entry: Mapping[Any, Any], key: str) -> str:
    value = entry.get(key)
    return value[:LONGEST_NAME] if isinstance(value, str) else ""
