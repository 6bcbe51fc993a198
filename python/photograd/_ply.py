"""The one door to .ply files: elements by name, as arrays with named columns.

The format is that of [Turk1994]: a header of lines that names elements, their rows and properties,
then the rows as text or in binary. A property is a number, or a list that begins with its length.
Before anything is allocated, what the header states is compared with the bytes that the file has
left: a number takes its size in binary, and two bytes (a digit, a space) in text.
"""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd_course.input_files import read_file

from photograd.errors import IoError, message

Table = NDArray[Any]
MAX_HEADER_BYTES = 1 << 16
_TYPES = {
    "char": "i1",
    "uchar": "u1",
    "short": "i2",
    "ushort": "u2",
    "int": "i4",
    "uint": "u4",
    "int8": "i1",
    "uint8": "u1",
    "int16": "i2",
    "uint16": "u2",
    "int32": "i4",
    "uint32": "u4",
    "float": "f4",
    "double": "f8",
    "float32": "f4",
    "float64": "f8",
}
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_EMPTY = {kind: np.empty(0, kind) for kind in _TYPES.values()}
_ROWS_AT_ONCE = 4096


class _DamagedError(Exception):
    """What is wrong with a file."""


@dataclass
class _Property:
    name: str
    kind: str  # of NumPy, without the order of bytes
    length_kind: str = ""  # of a list's length; "" for a number

    @property
    def shortest(self) -> int:
        """Bytes in binary: of a list, of one without entries."""
        return np.dtype(self.length_kind or self.kind).itemsize


@dataclass
class _Element:
    name: str
    rows: int
    properties: list[_Property]

    def table(self) -> Table:
        """(rows,) of unwritten memory; lists are objects."""
        kinds = [(p.name, object if p.length_kind else p.kind) for p in self.properties]
        return np.empty(self.rows, kinds)


def read_ply(function: str, path: Path) -> dict[str, Table]:
    """{element: structured array (rows,)} of a .ply file, text or binary, read whole.

    A list is an array in a column of objects.

    Args:
        function: reader on whose behalf errors speak.
        path: the file.

    Raises:
        IoError: no file, a damaged one, or a header that promises more than the file holds.
    """
    try:
        return _tables(read_file(function, path))
    except (_DamagedError, ValueError, OverflowError) as failure:
        text = " ".join(str(failure).split())[:120]
        raise IoError(message(function, f"{path}", "a readable .ply file", text)) from failure


def ply_bytes(name: str, table: Table, comments: Sequence[str] = ()) -> bytes:
    """A binary .ply file of one element, whose columns are float32, little endian."""
    lines = ["ply", "format binary_little_endian 1.0", *(f"comment {line}" for line in comments)]
    lines += [f"element {name} {len(table)}"]
    lines += [f"property float {column}" for column in table.dtype.names or ()]
    return "\n".join([*lines, "end_header\n"]).encode("ascii") + table.tobytes()


def _tables(data: bytes) -> dict[str, Table]:
    order, elements, start = _header(data)
    found: dict[str, Table] = {}
    text = io.BytesIO(data)
    text.seek(start)
    for element in elements:
        shortest = sum(p.shortest if order else 2 for p in element.properties)
        left = len(data) - (start if order else text.tell())
        # The last number of a text has no space behind it.
        if element.rows * max(shortest, 1) > left + (not order):
            got = f"{element.rows} rows of {element.name.encode()!r} promised in {left} bytes"
            raise _DamagedError(got)
        if element.name in found:
            raise _DamagedError(f"element {element.name!r} twice")
        if order:
            found[element.name], start = _binary_rows(element, order, data, start)
        else:
            found[element.name] = _text_rows(element, text)
    return found


def _header(data: bytes) -> tuple[str, list[_Element], int]:
    """Order of bytes ("" for text), elements, and where the rows begin."""
    end = next((e for e in (b"\r\n", b"\n", b"\r") if data.startswith(b"ply" + e)), None)
    if end is None:
        raise _DamagedError(f"data that begins with {data[:8]!r}")
    head, mark, _ = data[:MAX_HEADER_BYTES].partition(end + b"end_header" + end)
    if not mark:
        raise _DamagedError("a header without end_header")
    order, elements = None, list[_Element]()
    for line in head.decode("ascii", "replace").split(end.decode())[1:]:
        words = line.split()
        if not words or words[0] in ("comment", "obj_info"):
            continue
        if words[0] == "format" and len(words) == 3 and words[2] == "1.0" and order is None:
            order = _ORDERS.get(words[1])
        elif words[0] == "element" and len(words) == 3 and words[2].isdecimal():
            elements.append(_Element(words[1], int(words[2]), []))
        elif words[0] == "property" and elements:
            elements[-1].properties.append(_property(words, line))
        else:
            raise _DamagedError(f"the line {line[:40]!r}")
    if order is None:
        raise _DamagedError(f"no format among {', '.join(_ORDERS)}")
    return order, elements, len(head) + len(mark)


def _property(words: list[str], line: str) -> _Property:
    kinds = [_TYPES.get(word, "") for word in words[1:-1] if word != "list"]
    if len(words) == 3 and kinds and kinds[0]:
        return _Property(words[2], kinds[0])
    if len(words) == 5 and words[1] == "list" and all(kinds) and kinds[0][0] in "iu":
        return _Property(words[4], kinds[1], kinds[0])
    raise _DamagedError(f"the line {line[:40]!r}")


def _binary_rows(element: _Element, order: str, data: bytes, start: int) -> tuple[Table, int]:
    """The rows, and where they end."""
    if not (element.rows and element.properties):
        return element.table(), start
    lengths = _first_lengths(element, order, data, start)
    whole, size = _packed_rows(element, lengths, order, data, start)
    if whole is None:
        return _rows_with_lists(element, order, data, start)
    table = element.table()
    for p in element.properties:
        if p.length_kind:
            column = whole[p.name].astype(p.kind)
            for row, values in enumerate(column):
                table[p.name][row] = values
        else:
            table[p.name] = whole[p.name]
    return table, start + size


def _first_lengths(element: _Element, order: str, data: bytes, start: int) -> list[int]:
    """Lengths of the lists in the first row."""
    lengths: list[int] = []
    for p in element.properties:
        if p.length_kind:
            lengths.append(_number(p.length_kind, order, data, start))
            start += lengths[-1] * np.dtype(p.kind).itemsize
        start += p.shortest
    return lengths


def _packed_rows(
    element: _Element, lengths: list[int], order: str, data: bytes, start: int
) -> tuple[Table | None, int]:
    """All rows at once where every list is as long as in the first row, else None; their bytes."""
    fields: list[Any] = []
    left = iter(lengths)
    for p in element.properties:
        if p.length_kind:
            length = next(left, 0)
            fields += [(f"length of {p.name}", order + p.length_kind)]
            fields += [(p.name, order + p.kind, (length,))]
        else:
            fields += [(p.name, order + p.kind)]
    packed = np.dtype(fields)
    if element.rows * packed.itemsize > len(data) - start:
        return None, 0
    whole = np.frombuffer(data, packed, element.rows, start)
    names = [p.name for p in element.properties if p.length_kind]
    if any((whole[f"length of {n}"] != k).any() for n, k in zip(names, lengths, strict=False)):
        return None, 0
    return whole, whole.nbytes


def _rows_with_lists(element: _Element, order: str, data: bytes, start: int) -> tuple[Table, int]:
    table = element.table()
    for row in range(element.rows):
        for p in element.properties:
            if p.length_kind:
                length = _number(p.length_kind, order, data, start)
                start += p.shortest
                values = np.frombuffer(_cut(data, start, length, p.kind), order + p.kind)
                table[p.name][row] = values.astype(p.kind) if length else _EMPTY[p.kind]
                start += values.nbytes
            else:
                table[p.name][row] = _number(p.kind, order, data, start)
                start += p.shortest
    return table, start


def _number(kind: str, order: str, data: bytes, start: int) -> Any:
    return np.frombuffer(_cut(data, start, 1, kind), order + kind)[0].item()


def _cut(data: bytes, start: int, count: int, kind: str) -> bytes:
    end = start + int(count) * np.dtype(kind).itemsize
    if count < 0 or end > len(data):
        raise _DamagedError(f"{count} numbers promised in {len(data) - start} bytes")
    return data[start:end]


def _text_rows(element: _Element, text: io.BytesIO) -> Table:
    table = element.table()
    for start in range(0, element.rows, _ROWS_AT_ONCE):
        count = min(_ROWS_AT_ONCE, element.rows - start)
        table[start : start + count] = [_text_row(element, text, start + k) for k in range(count)]
    return table


def _text_row(element: _Element, text: io.BytesIO, row: int) -> tuple[Any, ...]:
    words = iter(text.readline().split())
    values: list[Any] = []
    for p in element.properties:
        if p.length_kind:
            (length,) = _parsed(words, 1, p.length_kind, row)
            found = np.array(_parsed(words, length, p.kind, row), p.kind)
            values.append(found if length else _EMPTY[p.kind])
        else:
            values += _parsed(words, 1, p.kind, row)
    if next(words, None) is not None:
        raise _DamagedError(f"more numbers than properties in row {row} of {element.name!r}")
    return tuple(values)


def _parsed(words: Iterator[bytes], count: int, kind: str, row: int) -> list[Any]:
    found: list[Any] = []
    for _ in range(count):
        word = next(words, None)
        if word is None or b"_" in word:
            raise _DamagedError(f"{'no number' if word is None else repr(word[:20])} in row {row}")
        found.append(float(word) if kind[0] == "f" else int(word))
        if kind[0] != "f" and not np.iinfo(kind).min <= found[-1] <= np.iinfo(kind).max:
            raise _DamagedError(f"{word[:20]!r} for {np.dtype(kind).name} in row {row}")
    return found
