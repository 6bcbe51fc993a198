"""Small volume files, made byte by byte."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np

SHAPE = (5, 4, 3)


def values(seed: int = 1) -> Any:
    """(5, 4, 3) uint8, no two planes alike."""
    return np.random.default_rng(seed).integers(0, 255, SHAPE, np.uint8)


def in_file_order(array: Any) -> Any:
    """x fastest, then y, then z; channels innermost."""
    return np.moveaxis(array, (0, 1, 2), (2, 1, 0))


def vtk(
    array: Any, kind: str = "unsigned_char", dtype: str = "u1", text: bool = False, **lines: str
) -> bytes:
    """A legacy file; `lines` replaces header lines by keyword, "" leaves one out."""
    channels = array.shape[3] if array.ndim == 4 else 1
    header = {
        "MAGIC": "# vtk DataFile Version 3.0",
        "TITLE": "a title",
        "FORMAT": "ASCII" if text else "BINARY",
        "DATASET": "DATASET STRUCTURED_POINTS",
        "DIMENSIONS": "DIMENSIONS " + " ".join(map(str, array.shape[:3])),
        "SPACING": "SPACING 0.5 1 2",
        "ORIGIN": "ORIGIN 10 20 30",
        "POINT_DATA": f"POINT_DATA {array[..., 0].size * array.shape[2]}",
        "SCALARS": f"SCALARS density {kind} {channels}",
        "LOOKUP_TABLE": "LOOKUP_TABLE default",
    }
    kept = [line for line in (header | lines).values() if line]
    data = in_file_order(array).astype(dtype)
    body = " ".join(map(str, data.ravel())).encode() if text else data.tobytes()
    return "\n".join(kept).encode() + b"\n" + body


def nifti(
    array: Any,
    dtype: str = "<u1",
    code: int = 2,
    *,
    slope: float = 0.0,
    shift: float = 0.0,
    sform: Any = None,
    qform: Any = None,
    pixdim: Any = (1, 2, 3, 4),
    units: int = 2,
    sizes: Any = None,
    magic: bytes = b"n+1\0",
) -> bytes:
    """A NIfTI-1 file. sform is (3, 4); qform is (b, c, d, x, y, z)."""
    order = dtype[0]
    header = bytearray(352)
    dims = sizes if sizes is not None else (3, *array.shape, 1, 1, 1, 1)
    struct.pack_into(f"{order}i", header, 0, 348)
    struct.pack_into(f"{order}8h", header, 40, *dims)
    struct.pack_into(f"{order}h", header, 70, code)
    struct.pack_into(f"{order}8f", header, 76, *pixdim, 0, 0, 0, 0)
    struct.pack_into(f"{order}3f", header, 108, 352, slope, shift)
    header[123] = units
    struct.pack_into(f"{order}2h", header, 252, qform is not None, sform is not None)
    if qform is not None:
        struct.pack_into(f"{order}6f", header, 256, *qform)
    if sform is not None:
        struct.pack_into(f"{order}12f", header, 280, *np.ravel(sform))
    header[344:348] = magic
    return bytes(header) + in_file_order(array).astype(dtype).tobytes()


def mitsuba(
    array: Any,
    dtype: str = "<f4",
    encoding: int = 1,
    *,
    sizes: Any = None,
    box: Any = (-1, -1, -1, 1, 1, 1),
    magic: bytes = b"VOL\3",
) -> bytes:
    """A .vol file of (X, Y, Z, C)."""
    head = struct.pack("<5i6f", encoding, *(sizes or array.shape), *box)
    return magic + head + in_file_order(array).astype(dtype).tobytes()
