"""On which line of a TOML file each key stands; tomllib forgets it."""

from __future__ import annotations

import re
import tomllib
from typing import Any

KeyPath = tuple[str | int, ...]
_TEXT = re.compile(r'"(?:[^"\\]|\\.)*"|\'[^\']*\'')
_HEADER = re.compile(r"^\s*(\[\[?)(.+?)\]\]?\s*$")
_KEY = re.compile(r"^\s*([^=\[\]]+?)\s*=")


def key_lines(text: str) -> dict[KeyPath, int]:
    r"""{path of a key or table: line, from 1}; tables of an array are counted from 0.

    >>> key_lines("[a]\nb = 1\n[[c]]\nd = 2\n[[c]]\n")
    {('a',): 1, ('a', 'b'): 2, ('c', 0): 3, ('c', 0, 'd'): 4, ('c', 1): 5}
    """
    lines: dict[KeyPath, int] = {}
    counts: dict[KeyPath, int] = {}
    table: KeyPath = ()
    depth = 0  # of brackets that earlier lines have opened
    for number, line in enumerate(text.splitlines(), start=1):
        code = _without_comment(line)
        if depth == 0:
            header, key = _HEADER.match(code), _KEY.match(code)
            if header:
                table = _parts(header[2])
                if header[1] == "[[":
                    counts[table] = counts.get(table, -1) + 1
                    table = (*table, counts[table])
                lines.setdefault(table, number)
                continue
            if key:
                lines.setdefault((*table, *_parts(key[1])), number)
        bare = _TEXT.sub("", code)
        depth = max(0, depth + sum(bare.count(c) for c in "[{") - sum(bare.count(c) for c in "]}"))
    return lines


def _without_comment(line: str) -> str:
    """The line up to a # that stands in no string."""
    blind = _TEXT.sub(lambda found: "x" * len(found[0]), line)
    end = blind.find("#")
    return line if end < 0 else line[:end]


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
