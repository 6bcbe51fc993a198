"""Legacy VTK files of structured points: a header of words, then numbers, x fastest.

# vtk DataFile Version 3.0
a title
BINARY                               or ASCII; binary numbers are big-endian
DATASET STRUCTURED_POINTS
DIMENSIONS 68 68 68
SPACING 1 1 1                        ASPECT_RATIO in version 1.0
ORIGIN 0 0 0
POINT_DATA 314432
SCALARS name unsigned_char 1
LOOKUP_TABLE default
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from photograd.grids.volumes.volume import Volume, check_size, make, placed, refuse
from photograd.types import Array

TYPES = {
    "unsigned_char": "u1", "char": "i1", "unsigned_short": ">u2", "short": ">i2",
    "unsigned_int": ">u4", "int": ">i4", "float": ">f4", "double": ">f8",
}  # fmt: skip
LONGEST_HEADER = 4096


def read_vtk(path: Path, *, memory_limit: int | None = None) -> Volume:
    """Read the first scalars of a file; lengths are the file's own. Raises IoError."""
    data = path.read_bytes()
    fields, start = _header(path, data)
    x, y, z = (_integer(path, "DIMENSIONS", word) for word in _three(path, fields, "DIMENSIONS"))
    spacing = _numbers(path, fields, "SPACING" if "SPACING" in fields else "ASPECT_RATIO")
    origin = _numbers(path, fields, "ORIGIN") if "ORIGIN" in fields else [0.0] * 3
    words = fields["SCALARS"]
    kind = TYPES.get(words[1].lower()) if len(words) in (2, 3) else None
    if kind is None:
        raise refuse(path, f"SCALARS of a type among {sorted(TYPES)}", " ".join(words))
    channels = _integer(path, "channels", words[2]) if len(words) == 3 else 1
    stated = check_size(path, (x, y, z), channels, np.dtype(kind).itemsize, memory_limit)
    if fields["FORMAT"] == ["ASCII"]:
        values = _text_values(path, data[start:], stated // np.dtype(kind).itemsize)
    else:
        if len(data) - start < stated:
            raise refuse(path, f"{stated} bytes of values", f"{len(data) - start}", "damaged?")
        values = np.frombuffer(data, kind, count=stated // np.dtype(kind).itemsize, offset=start)
    volume = values.reshape(z, y, x, channels).transpose(2, 1, 0, 3)
    return make(path, volume, placed(np.array(spacing), np.array(origin)))


def _header(path: Path, data: bytes) -> tuple[dict[str, list[str]], int]:
    """Words behind each keyword, and where the values start."""
    fields: dict[str, list[str]] = {}
    at = 0
    for number in range(64):
        end = data.find(b"\n", at, at + LONGEST_HEADER)
        if end < 0:
            break
        line = data[at:end].decode("latin-1").strip()
        at = end + 1
        if number == 0 and not line.startswith("# vtk DataFile"):
            raise refuse(path, "a first line '# vtk DataFile ...'", repr(line[:40]))
        words = line.split()
        if number < 2 or not words:  # the second line is a title; blank ones may follow
            continue
        if "FORMAT" not in fields:
            fields["FORMAT"] = [line.upper()]
            continue
        fields[words[0].upper()] = words[1:]
        if words[0].upper() == "LOOKUP_TABLE":
            break
    needed = ("FORMAT", "DATASET", "DIMENSIONS", "SCALARS", "LOOKUP_TABLE")
    missing = [name for name in needed if name not in fields]
    if missing:
        raise refuse(
            path, f"a header with {', '.join(needed[1:])}", f"none of {', '.join(missing)}"
        )
    if [word.upper() for word in fields["DATASET"]] != ["STRUCTURED_POINTS"]:
        raise refuse(path, "DATASET STRUCTURED_POINTS", " ".join(fields["DATASET"]))
    if fields["FORMAT"][0] not in ("ASCII", "BINARY"):
        raise refuse(path, "ASCII or BINARY", fields["FORMAT"][0])
    return fields, at


def _three(path: Path, fields: dict[str, list[str]], name: str) -> list[str]:
    words = fields.get(name, [])
    if len(words) != 3:
        raise refuse(path, f"{name} and three numbers", " ".join(words) or "none")
    return words


def _numbers(path: Path, fields: dict[str, list[str]], name: str) -> list[float]:
    words = _three(path, fields, name)
    try:
        return [float(word) for word in words]
    except ValueError:
        raise refuse(path, f"{name} and three numbers", " ".join(words)) from None


def _integer(path: Path, name: str, word: str) -> int:
    if not word.isascii() or not word.isdigit() or len(word) > 9:
        raise refuse(path, f"{name}, a whole number", repr(word[:20]))
    return int(word)


def _text_values(path: Path, text: bytes, count: int) -> Array:
    words = text.split(None, count)[:count]
    try:
        values = np.array([float(word) for word in words])
    except ValueError:
        raise refuse(path, "numbers", "other words") from None
    if len(values) != count:
        raise refuse(path, f"{count} values", len(values))
    return values
