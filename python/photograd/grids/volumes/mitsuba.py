"""Mitsuba's volumes: 48 bytes of header, then numbers, channel by channel, then x, y, z.

"VOL", a byte 3, int32 encoding (1: float32, 2: float16, 3: uint8 for 0 to 1), int32 X, Y, Z, C,
six float32, the lowest and the highest corner of the box that the voxels fill
"""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np

from photograd.grids.volumes.volume import Volume, check_size, make, placed, refuse

HEADER = struct.Struct("<3sB5i6f")
ENCODINGS = {1: "<f4", 2: "<f2", 3: "u1"}


def read_mitsuba(path: Path, *, memory_limit: int | None = None) -> Volume:
    """Read a .vol file; a value is taken for the middle of its voxel. Raises IoError."""
    data = path.read_bytes()
    if len(data) < HEADER.size:
        raise refuse(path, f"a header of {HEADER.size} bytes", f"{len(data)} bytes")
    magic, version, encoding, x, y, z, channels, *corners = HEADER.unpack_from(data)
    if magic != b"VOL" or version != 3:
        raise refuse(path, "'VOL' of version 3", f"{magic!r}, version {version}")
    if encoding not in ENCODINGS:
        raise refuse(path, f"an encoding among {sorted(ENCODINGS)}", encoding)
    kind = np.dtype(ENCODINGS[encoding])
    stated = check_size(path, (x, y, z), channels, kind.itemsize, memory_limit)
    if len(data) - HEADER.size < stated:
        raise refuse(path, f"{stated} bytes of values", len(data) - HEADER.size, "damaged?")
    lo, hi = np.array(corners[:3], np.float64), np.array(corners[3:], np.float64)
    if not (np.isfinite(lo).all() and np.isfinite(hi).all() and (hi > lo).all()):
        raise refuse(path, "a box, the lowest corner first", corners)
    values = np.frombuffer(data, kind, count=stated // kind.itemsize, offset=HEADER.size)
    if encoding == 3:
        values = values / np.float32(255)
    spacing = (hi - lo) / (x, y, z)
    volume = values.reshape(z, y, x, channels).transpose(2, 1, 0, 3)
    return make(path, volume, placed(spacing, lo + spacing / 2))
