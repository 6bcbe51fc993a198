"""What a folder knows of the modules that were taken along from earlier assignments.

Kept in `brought.json`, so that a later difference can be traced to the side that has changed, and
checks that a module has passed need not be run again. Nothing rests on it: where it is missing or
damaged, less can be told.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ..atomic_io import atomic_write

RECORD_NAME = "brought.json"


class Record:
    """The file of one folder."""

    def __init__(self, folder: Path) -> None:
        """Read it; where it is missing or damaged, nothing is known."""
        self._path = folder / RECORD_NAME
        table = read_table(self._path)
        self._taken = _texts(table.get("taken"))
        self._passed = _lists(table.get("passed"))

    def taken(self, module: str) -> str | None:
        """The text of a module when it was taken along."""
        return self._taken.get(module)

    def note_taken(self, texts: Mapping[str, str]) -> None:
        """Note what is about to be written; before it is, so that nothing else looks edited.

        Args:
            texts: by module.

        Raises:
            IoError: it cannot be written.
        """
        if any(self._taken.get(name) != text for name, text in texts.items()):
            self._taken.update(texts)
            self._write()

    def passed(self, digest: str) -> frozenset[str]:
        """Ids of the checks that have been passed by just this text of a module.

        Args:
            digest: of that text, and of what looks at it.
        """
        return frozenset(self._passed.get(digest, ()))

    def note_passed(self, digest: str, earlier: str, checks: Iterable[str]) -> None:
        """Note that these were passed; what is noted of another text is forgotten.

        Args:
            digest: of the module, and of what looks at it; it begins with ``earlier``.
            earlier: number of the assignment that owns the module.
            checks: ids.

        Raises:
            IoError: it cannot be written.
        """
        kept = {key: ids for key, ids in self._passed.items() if not key.startswith(earlier)}
        self._passed = {**kept, digest: sorted({*self.passed(digest), *checks})}
        self._write()

    def _write(self) -> None:
        table = {"taken": self._taken, "passed": self._passed}
        text = json.dumps(table, indent=1, sort_keys=True)
        atomic_write(self._path, f"{text}\n".encode())


def read_table(path: Path) -> dict[str, Any]:
    """A JSON object; empty where the file is missing, damaged or something else.

    Args:
        path: of the file.
    """
    try:
        table = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return {}
    return table if isinstance(table, dict) else {}


def _texts(table: object) -> dict[str, str]:
    entries = table.items() if isinstance(table, dict) else ()
    return {str(key): value for key, value in entries if isinstance(value, str)}


def _lists(table: object) -> dict[str, list[str]]:
    entries = table.items() if isinstance(table, dict) else ()
    return {
        str(key): [each for each in value if isinstance(each, str)]
        for key, value in entries
        if isinstance(value, list)
    }
