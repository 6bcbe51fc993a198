"""NIfTI-1, the format of brain scans: .nii, or .nii.gz for the same compressed.

A header of 348 bytes in either byte order, then from `vox_offset` on numbers, x fastest. Its world
is +x to the patient's right, +y to the front, +z up, usually in millimetres; ours is +Y up, so that
(x, y, z) there is (x, z, -y) here, in metres.
"""

from __future__ import annotations

import gzip
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from photograd.grids.volumes.volume import Volume, check_size, make, refuse
from photograd.types import Array

HEADER_BYTES = 348
TYPES = {
    2: "u1", 4: "i2", 8: "i4", 16: "f4", 64: "f8", 256: "i1", 512: "u2", 768: "u4",
}  # fmt: skip
METRES = {1: 1.0, 2: 1e-3, 3: 1e-6}  # of the unit codes: metres, millimetres, micrometres
OURS_FROM_THEIRS = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])


def read_nifti(path: Path, *, memory_limit: int | None = None) -> Volume:
    """Read a file of one volume, with its intensity scaling and its place. Raises IoError."""
    compressed = path.name.lower().endswith(".gz")
    try:
        with gzip.open(path) if compressed else path.open("rb") as stream:
            header = stream.read(HEADER_BYTES)
            order = _byte_order(path, header)
            sizes, kind = _layout(path, header, order)
            stated = check_size(path, sizes, 1, kind.itemsize, memory_limit)
            start = _offset(path, header, order)
            stream.read(start - HEADER_BYTES)
            data = stream.read(stated)
    except (gzip.BadGzipFile, EOFError, zlib.error) as failure:
        raise refuse(path, "compressed data that are whole", failure, "damaged?") from None
    if len(data) != stated:
        raise refuse(path, f"{stated} bytes of values", len(data), "damaged?")
    values = np.frombuffer(data, kind).reshape(sizes[::-1]).transpose(2, 1, 0)
    slope, shift = struct.unpack_from(f"{order}2f", header, 112)
    if slope != 0:
        with np.errstate(over="ignore", invalid="ignore"):
            values = values * slope + shift
    return make(path, values[..., None], OURS_FROM_THEIRS @ _place(header, order))


def _byte_order(path: Path, header: bytes) -> str:
    if len(header) < HEADER_BYTES or header[344:348] != b"n+1\0":
        raise refuse(path, "a NIfTI-1 header in one file with its values", f"{len(header)} bytes")
    for order in "<>":
        if struct.unpack_from(f"{order}i", header)[0] == HEADER_BYTES:
            return order
    raise refuse(path, f"a header of {HEADER_BYTES} bytes", "another size")


def _layout(path: Path, header: bytes, order: str) -> tuple[tuple[int, int, int], np.dtype[Any]]:
    """Voxels along x, y, z and the type of a value."""
    rank, x, y, z, *more = struct.unpack_from(f"{order}8h", header, 40)
    if not 3 <= rank <= 7 or any(size != 1 for size in more[: max(rank - 3, 0)]):
        raise refuse(path, "one volume of three axes", f"axes {(x, y, z, *more)[: max(rank, 0)]}")
    (code,) = struct.unpack_from(f"{order}h", header, 70)
    if code not in TYPES:
        raise refuse(path, f"values of a type among {sorted(TYPES)}", f"type {code}")
    return (x, y, z), np.dtype(order + TYPES[code])


def _offset(path: Path, header: bytes, order: str) -> int:
    (offset,) = struct.unpack_from(f"{order}f", header, 108)
    if not HEADER_BYTES <= offset <= 1 << 20:
        raise refuse(path, f"values from byte {HEADER_BYTES} to 2^20", offset)
    return int(offset)


def _place(header: bytes, order: str) -> Array:
    """Metres of their world from the index, by the first of three ways that the header offers."""
    qform, sform = struct.unpack_from(f"{order}2h", header, 252)
    pixdim = np.array(struct.unpack_from(f"{order}8f", header, 76), np.float64)
    matrix = np.eye(4)
    if sform > 0:
        matrix[:3] = np.reshape(struct.unpack_from(f"{order}12f", header, 280), (3, 4))
    elif qform > 0:
        b, c, d, *origin = struct.unpack_from(f"{order}6f", header, 256)
        handed = np.array([1.0, 1.0, -1.0 if pixdim[0] < 0 else 1.0])
        matrix[:3, :3] = _turn(b, c, d) * (pixdim[1:4] * handed)
        matrix[:3, 3] = origin
    else:
        matrix[:3, :3] = np.diag(pixdim[1:4])
    matrix[:3] *= METRES.get(header[123] & 7, 1.0)
    return matrix


def _turn(b: float, c: float, d: float) -> Array:
    """The rotation of the unit quaternion (a, b, c, d), a from the others."""
    a = np.sqrt(max(0.0, 1.0 - (b * b + c * c + d * d)))
    return np.array(
        [
            [a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)],
            [2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)],
            [2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c],
        ]
    )
