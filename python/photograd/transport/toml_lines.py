"""On which line of a TOML file each key stands; tomllib forgets it."""

from __future__ import annotations

import re
import tomllib
from typing import Any

from photograd_course.toml_limits import without_strings

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
