"""A table of a scene file: values of the wanted types, and errors that say where they stand."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from photograd_course.suggest import choose_from, nearest
from photograd_course.toml_limits import without_strings

from photograd.errors import Error, SceneError, message
from photograd.images.kind import MAX_SIDE

KeyPath = tuple[str | int, ...]


def key_lines(text: str) -> dict[KeyPath, int]:
    r"""{path of a key or table: line, from 1}; tables of an array are counted from 0.

    Args:
        text: TOML that `parse_toml` has accepted.

    >>> key_lines("[a]\nb = 1\n[[c]]\nd = 2\n[[c]]\n")
    {('a',): 1, ('a', 'b'): 2, ('c', 0): 3, ('c', 0, 'd'): 4, ('c', 1): 5}
    """
    lines: dict[KeyPath, int] = {}
    counts: dict[KeyPath, int] = {}
    table: KeyPath = ()
    depth = 0  # of brackets that earlier lines have opened
    split = text.split("\n")
    for number, bare in enumerate(without_strings(text).split("\n"), start=1):
        line = split[number - 1]
        if depth == 0 and (header := re.match(r"[ \t]*(\[\[?)([^\]]+)\]", bare)):
            table = _parts(line[header.start(2) : header.end(2)])
            if header[1] == "[[":
                counts[table] = counts.get(table, -1) + 1
                table = (*table, counts[table])
            lines.setdefault(table, number)
            continue
        if depth == 0 and "=" in bare:
            lines.setdefault((*table, *_parts(line[: bare.index("=")])), number)
        depth += sum(bare.count(c) for c in "[{") - sum(bare.count(c) for c in "]}")
    return lines


def _parts(key: str) -> KeyPath:
    """The names of a dotted key, as tomllib itself takes it apart."""
    try:
        node: Any = tomllib.loads(f"{key} = 0")
    except tomllib.TOMLDecodeError:
        return (key,)
    parts: list[str] = []
    while isinstance(node, dict):
        (name, node), *_ = node.items()
        parts.append(name)
    return tuple(parts)


# A table of a scene file: values of the wanted types, and errors that say where they stand.


Built = TypeVar("Built")
Name = TypeVar("Name", bound=str)
BEYOND = 1e15
"""Numbers are smaller. Squares of them and areas are then finite in float32, and coordinates within
what the ray tracer takes (core/world_limit.h).
"""
LARGEST = 2**53  # whole numbers up to here are exact in a float


class Node:
    """A table and the keys of it that have been asked for."""

    def __init__(
        self, path: Path, data: Mapping[str, Any], keys: KeyPath, lines: Mapping[KeyPath, int]
    ) -> None:
        """A table at `keys` in the file at `path`; `lines` are those of `key_lines`.

        Args:
            path: of the file.
            data: what the table holds.
            keys: of the table, from the root.
            lines: {keys: line}.
        """
        self.path, self.data, self.keys, self._lines = path, data, keys, lines
        self._asked: set[str] = set()

    def line(self, key: str | None = None) -> int:
        """Where a key stands, or the nearest table around it."""
        keys: KeyPath = self.keys if key is None else (*self.keys, key)
        while keys:
            for found in (keys, (*keys, 0)):  # an array of tables begins with its first
                if found in self._lines:
                    return self._lines[found]
            keys = keys[:-1]
        return 1

    def wrong(
        self, key: str, expected: object, got: object, remedy: str | None = None
    ) -> SceneError:
        """The error that a value is not what was expected.

        Args:
            key: of the value.
            expected: what would have been accepted.
            got: what stands there.
            remedy: what can be done about it.
        """
        name = ".".join(str(part) for part in (*self.keys, key))
        where = f"line {self.line(key)}: {name}"
        return SceneError(message(f"read_scene: {self.path}", where, expected, got, remedy))

    def built(self, make: Callable[[], Built], key: str | None = None) -> Built:
        """What `make` returns; its errors get the line of the table or key, if they have none."""
        try:
            return make()
        except Error as failure:
            text = str(failure)
            if text.startswith(f"read_scene: {self.path}"):
                raise
            keys = self.keys if key is None else (*self.keys, key)
            name = ".".join(str(part) for part in keys) or "scene"
            where = f"line {self.line(key)}: {name}"
            raise SceneError(f"read_scene: {self.path}: {where}: {text}") from failure

    def has(self, key: str) -> bool:
        """Whether the key is there; one that may be is a known one."""
        self._asked.add(key)
        return key in self.data

    def value(self, key: str, default: Any = None) -> Any:
        """Whatever stands there; SceneError if nothing does and there is no default.

        Args:
            key: of the value.
            default: if it is absent.
        """
        self._asked.add(key)
        if key in self.data:
            return self.data[key]
        if default is None:
            misspelled = nearest(key, set(self.data) - self._asked)
            if misspelled:
                expected, remedy = "a key that is known here", f"did you mean {key!r}?"
                raise self.wrong(misspelled, expected, "an unknown one", remedy)
            raise self.wrong(key, "a value", "none")
        return default

    def table(self, key: str) -> Node:
        """The table of this name.

        Args:
            key: of the table.
        """
        found = self.value(key)
        if not isinstance(found, dict):
            raise self.wrong(key, "a table", type(found).__name__)
        return Node(self.path, found, (*self.keys, key), self._lines)

    def tables(self, key: str) -> list[Node]:
        """The tables of an array [[key]]."""
        found = self.value(key)
        if not isinstance(found, list) or not all(isinstance(entry, dict) for entry in found):
            raise self.wrong(key, f"tables [[{key}]]", type(found).__name__)
        return [
            Node(self.path, entry, (*self.keys, key, i), self._lines)
            for i, entry in enumerate(found)
        ]

    def text(self, key: str, default: str | None = None) -> str:
        """A string.

        Args:
            key: of the value.
            default: if it is absent; None makes that an error.
        """
        found = self.value(key, default)
        if not isinstance(found, str):
            raise self.wrong(key, "a string", found)
        return found

    def choice(self, key: str, known: Iterable[Name]) -> Name:
        """One of the known names.

        Args:
            key: of the value.
            known: the names.
        """
        names = list(known)
        found = self.text(key)
        for name in names:
            if name == found:
                return name
        raise self.wrong(key, f"one of {', '.join(names)}", found, choose_from(found, names))

    def flag(self, key: str) -> bool:
        """A truth value; false if absent.

        Args:
            key: of the value.
        """
        found = self.value(key, False)
        if not isinstance(found, bool):
            raise self.wrong(key, "true or false", found)
        return found

    def number(self, key: str, default: float | None = None) -> float:
        """A finite number.

        Args:
            key: of the value.
            default: if it is absent; None makes that an error.
        """
        found = self.value(key, default)
        if not _is_number(found):
            raise self.wrong(key, "a finite number", found, _too_large(found))
        return float(found)

    def numbers(self, key: str, count: int, default: list[float] | None = None) -> list[float]:
        """A list of finite numbers.

        Args:
            key: of the value.
            count: of the numbers.
            default: if it is absent; None makes that an error.
        """
        found = self.value(key, default)
        if not isinstance(found, list) or len(found) != count or not all(map(_is_number, found)):
            raise self.wrong(key, f"{count} finite numbers", found, _too_large(found))
        return [float(entry) for entry in found]

    def picture_size(self) -> tuple[int, int]:
        """Width and height of `size`."""
        width, height = self.numbers("size", 2)
        whole = width == int(width) and height == int(height)
        if not whole or not 1 <= min(width, height) <= max(width, height) <= MAX_SIDE:
            expected = f"width and height in pixels, 1 to {MAX_SIDE}"
            raise self.wrong("size", expected, [width, height])
        return int(width), int(height)

    def color(self, key: str, default: list[float] | None = None) -> list[float]:
        """Three numbers, or one for all three, none negative.

        Args:
            key: of the value.
            default: if it is absent; None makes that an error.
        """
        found = self.value(key, default)
        entries = [found] * 3 if _is_number(found) else found
        if (
            not isinstance(entries, list)
            or len(entries) != 3
            or not all(_is_number(entry) and entry >= 0 for entry in entries)
        ):
            expected = "a radiance: one or three numbers of at least 0"
            raise self.wrong(key, expected, found, _too_large(found))
        return [float(entry) for entry in entries]

    def rows(self, key: str, kind: type[int] | type[float]) -> Any:
        """An array of rows of three numbers, (N, 3).

        Args:
            key: of the value.
            kind: int or float.
        """
        found = self.value(key)
        whole = kind is int
        good = isinstance(found, list) and all(
            isinstance(row, list)
            and len(row) == 3
            and all(
                _is_number(entry) and (not whole or isinstance(entry, int)) and abs(entry) < LARGEST
                for entry in row
            )
            for row in found
        )
        if not good or not found:
            what = "whole numbers" if whole else "finite numbers"
            raise self.wrong(key, f"rows of three {what}", "something else")
        return np.array(found, np.int64 if whole else np.float64)

    def refuse_other_keys(self) -> None:
        """SceneError for the first key that nobody has asked for."""
        for key in self.data:
            if key not in self._asked:
                near = choose_from(key, self._asked)
                raise self.wrong(key, "a key that is known here", "an unknown one", near)


def _is_number(value: object) -> bool:
    """Finite and within reason: TOML's integers have no end, and NaN is in no interval."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < BEYOND


def _too_large(found: object) -> str | None:
    """A remedy where a number is one, but too large for the arithmetic of float32."""
    for entry in found if isinstance(found, list) else [found]:
        if isinstance(entry, int | float) and BEYOND <= abs(entry) < float("inf"):
            return f"numbers below {BEYOND:g}"
    return None
