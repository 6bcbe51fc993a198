"""What a command says: its result on stdout, everything else on stderr."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from threading import Event

import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from ..errors import DtypeError, message

json_printed = Event()
"""Set when a result went to stdout as JSON: no error follows it there."""


def emit(result: Mapping[str, object], *, as_json: bool, title: str | None = None) -> None:
    """Show the result of a command; call it once, as the last thing a command does.

    Without ``--json`` a table goes to stdout. With it the table goes to stderr and stdout gets
    exactly one more line: the JSON object. Infinite and undefined numbers, which JSON lacks, are
    written as the strings "inf", "-inf" and "nan", which ``float()`` reads in most languages.

    Args:
        result: names to numbers, strings, booleans, None, paths, NumPy scalars or arrays, and
            mappings or sequences of these. A sequence of mappings becomes a table of rows.
        as_json: whether ``--json`` was given.
        title: a heading for the table.

    Raises:
        DtypeError: a value of another type, named by its place; nothing has been printed then.
    """
    plain = {str(name): _plain(str(name), value) for name, value in result.items()}
    console = Console(stderr=as_json, highlight=False)
    for table in _tables(plain, title):
        roomy = console.options.update(max_width=100_000)
        if table.show_header or console.measure(table, options=roomy).minimum <= console.width:
            console.print(table)
        else:
            console.print(_unbroken(table), soft_wrap=True)
    if as_json:
        print_json(json.dumps(plain, allow_nan=False))


def print_json(text: str) -> None:
    """Write a result that is JSON already, one line, to stdout. No error follows it there."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()
    json_printed.set()


def note(text: str, *, style: str = "") -> None:
    """Write one line for people to stderr; line breaks inside ``text`` become spaces."""
    line = Text(" ".join(part.strip() for part in text.splitlines()), style=style)
    Console(stderr=True, highlight=False).print(line, soft_wrap=True)


def _plain(place: str, value: object) -> object:
    """``value`` in types that JSON has."""
    if isinstance(value, np.generic):
        value = value.item()
    elif isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, Path):
        return str(value)
    if isinstance(value, Mapping):
        return {str(name): _plain(f"{place}.{name}", inner) for name, inner in value.items()}
    if isinstance(value, Sequence):
        return [_plain(f"{place}[{i}]", inner) for i, inner in enumerate(value)]
    expected = "a number, string, path, array, mapping or sequence"
    raise DtypeError(message("emit", place, expected, type(value).__name__))


def _tables(result: Mapping[str, object], title: str | None) -> list[Table]:
    """One table of names and values, then one for every sequence of mappings."""
    pairs = Table(title=title, title_justify="left", show_header=False, box=None, padding=(0, 2))
    pairs.add_column(style="bold")
    pairs.add_column(overflow="fold")
    more = []
    for name, value in result.items():
        if isinstance(value, list) and value and all(isinstance(row, Mapping) for row in value):
            more.append(_rows(name, value))
        elif isinstance(value, Mapping):
            for inner, content in value.items():
                pairs.add_row(f"{name}.{inner}", Text(_shown(content)))
        else:
            pairs.add_row(name, Text(_shown(value)))
    return [table for table in (pairs, *more) if table.row_count]


def _unbroken(pairs: Table) -> Text:
    """Names and values on lines that may be too long: a path that is broken cannot be copied."""
    names, values = (list(column.cells) for column in pairs.columns)
    wide = max(len(str(name)) for name in names)
    lines = [Text(str(pairs.title), "italic")] if pairs.title else []
    for name, value in zip(names, values, strict=True):
        lines.append(Text.assemble("  ", (str(name).ljust(wide), "bold"), "    ", str(value)))
    return Text("\n").join(lines)


def _rows(name: str, rows: list[Mapping[str, object]]) -> Table:
    columns = list(dict.fromkeys(column for row in rows for column in row))
    table = Table(*columns, title=name, title_justify="left", header_style="bold")
    for row in rows:
        table.add_row(*(Text(_shown(row.get(column, ""))) for column in columns))
    return table


def _shown(value: object) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if value is None:
        return "none"
    return ", ".join(map(_shown, value)) if isinstance(value, list) else str(value)
