"""Files of regular volumes, as scanners and simulations write them: Mitsuba, NIfTI-1, legacy VTK.

Mitsuba's are "VOL", a byte 3, int32 encoding (1: float32, 2: float16, 3: uint8 for 0 to 1), int32
X, Y, Z, C, six float32, the lowest and the highest corner of the box that the voxels fill.

NIfTI-1, the format of brain scans: .nii, or .nii.gz for the same compressed. A header of 348 bytes
in either byte order, then from `vox_offset` on numbers, x fastest. Its world is +x to the patient's
right, +y to the front, +z up, usually in millimeters; ours is +Y up, so that (x, y, z) there is (x,
z, -y) here, in meters.

Legacy VTK files of structured points are a header of words, then numbers, x fastest:

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

import gzip
import struct
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from photograd_course.input_files import require_file

from photograd._memory import available_memory
from photograd._typed import typed_call
from photograd.errors import IoError, message
from photograd.types import Array

MAX_CELLS = 1 << 40
"""Voxels beyond which a header is taken for damaged, whatever memory there is."""


@typed_call
@dataclass(frozen=True, eq=False)
class Volume:
    """A regular grid of numbers.

    Attributes:
        values: (X, Y, Z, C) float32, finite.
        world_from_index: (4, 4); the index (i, j, k) is the middle of a voxel. Lengths are meters
            where the file says what they are, else its own.
    """

    values: Array
    world_from_index: Array

    @property
    def density(self) -> Array:
        """(X, Y, Z): the value, or the mean of several channels."""
        return np.asarray(self.values.mean(axis=3, dtype=np.float32))


def refuse(path: Path, expected: str, got: object, remedy: str | None = None) -> IoError:
    """The error of a file that is not what it should be, ready to be raised."""
    return IoError(message("read_volume", f"{path}", expected, f"{got}", remedy))


def check_size(
    path: Path, sizes: tuple[int, ...], channels: int, bytes_of_value: int, limit: int | None
) -> int:
    """Bytes of the values that a header states. Raises IoError for sizes that make no sense."""
    if min(sizes) < 2 or channels < 1:
        got = f"{' x '.join(map(str, sizes))}, {channels} channels"
        raise refuse(path, "at least 2 voxels along each axis", got)
    cells = channels
    for size in sizes:
        cells *= size
    # As float32 in our order, beside what was read.
    needed = cells * (bytes_of_value + 8)
    room = available_memory() if limit is None else limit
    if cells > MAX_CELLS or needed > room:
        got = f"{needed / 2**20:.0f} MiB"
        raise refuse(path, f"a volume that fits into {room / 2**20:.0f} MiB", got)
    return cells * bytes_of_value


def make(path: Path, raw: Array, world_from_index: Array) -> Volume:
    """A volume from values (X, Y, Z, C) of any type. Raises IoError unless all are finite."""
    with np.errstate(over="ignore", invalid="ignore"):
        values = np.ascontiguousarray(raw, np.float32)
    if not np.isfinite(values).all():
        count = int((~np.isfinite(values)).sum())
        raise refuse(path, "finite values", f"{count} that are not")
    if not np.isfinite(world_from_index).all() or abs(np.linalg.det(world_from_index)) < 1e-30:
        raise refuse(path, "a position in space that can be inverted", world_from_index.tolist())
    return Volume(values, world_from_index)


def affine_matrix(spacing: Array, origin: Array) -> Array:
    """world_from_index (4, 4) of voxels `spacing` (3,) apart, the first at `origin` (3,)."""
    matrix = np.diag([*np.asarray(spacing, np.float64), 1.0])
    matrix[:3, 3] = origin
    return matrix


# Mitsuba's volumes: 48 bytes of header, then numbers, channel by channel, then x, y, z.


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
    return make(path, volume, affine_matrix(spacing, lo + spacing / 2))


# NIfTI-1, the format of brain scans: .nii, or .nii.gz for the same compressed.


HEADER_BYTES = 348
_NIFTI_TYPES = {2: "u1", 4: "i2", 8: "i4", 16: "f4", 64: "f8", 256: "i1", 512: "u2", 768: "u4"}
METERS = {1: 1.0, 2: 1e-3, 3: 1e-6}  # of the unit codes: meters, millimeters, micrometers
OURS_FROM_THEIRS = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])


def read_nifti(path: Path, *, memory_limit: int | None = None) -> Volume:
    """Read a file of one volume, with its intensity scaling and its position. Raises IoError."""
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
    return make(path, values[..., None], OURS_FROM_THEIRS @ _world_from_index(header, order))


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
    if code not in _NIFTI_TYPES:
        raise refuse(path, f"values of a type among {sorted(_NIFTI_TYPES)}", f"type {code}")
    return (x, y, z), np.dtype(order + _NIFTI_TYPES[code])


def _offset(path: Path, header: bytes, order: str) -> int:
    (offset,) = struct.unpack_from(f"{order}f", header, 108)
    if not HEADER_BYTES <= offset <= 1 << 20:
        raise refuse(path, f"values from byte {HEADER_BYTES} to 2^20", offset)
    return int(offset)


def _world_from_index(header: bytes, order: str) -> Array:
    """Meters of their world from the index, by the first of three ways that the header offers."""
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
    matrix[:3] *= METERS.get(header[123] & 7, 1.0)
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


# Legacy VTK files of structured points: a header of words, then numbers, x fastest.


_VTK_TYPES = {
    "unsigned_char": "u1",
    "char": "i1",
    "unsigned_short": ">u2",
    "short": ">i2",
    "unsigned_int": ">u4",
    "int": ">i4",
    "float": ">f4",
    "double": ">f8",
}
MAX_HEADER_BYTES = 4096


def read_vtk(path: Path, *, memory_limit: int | None = None) -> Volume:
    """Read the first scalars of a file; lengths are the file's own. Raises IoError."""
    data = path.read_bytes()
    fields, start = _header(path, data)
    x, y, z = (_integer(path, "DIMENSIONS", word) for word in _three(path, fields, "DIMENSIONS"))
    spacing = _numbers(path, fields, "SPACING" if "SPACING" in fields else "ASPECT_RATIO")
    origin = _numbers(path, fields, "ORIGIN") if "ORIGIN" in fields else [0.0] * 3
    words = fields["SCALARS"]
    kind = _VTK_TYPES.get(words[1].lower()) if len(words) in (2, 3) else None
    if kind is None:
        raise refuse(path, f"SCALARS of a type among {sorted(_VTK_TYPES)}", " ".join(words))
    channels = _integer(path, "channels", words[2]) if len(words) == 3 else 1
    stated = check_size(path, (x, y, z), channels, np.dtype(kind).itemsize, memory_limit)
    if fields["FORMAT"] == ["ASCII"]:
        values = _text_values(path, data[start:], stated // np.dtype(kind).itemsize)
    else:
        if len(data) - start < stated:
            raise refuse(path, f"{stated} bytes of values", f"{len(data) - start}", "damaged?")
        values = np.frombuffer(data, kind, count=stated // np.dtype(kind).itemsize, offset=start)
    volume = values.reshape(z, y, x, channels).transpose(2, 1, 0, 3)
    return make(path, volume, affine_matrix(np.array(spacing), np.array(origin)))


def _header(path: Path, data: bytes) -> tuple[dict[str, list[str]], int]:
    """Words behind each keyword, and where the values start."""
    fields: dict[str, list[str]] = {}
    at = 0
    for number in range(64):
        end = data.find(b"\n", at, at + MAX_HEADER_BYTES)
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


# One door to the readers, by the end of a file's name.


READERS = {".vtk": read_vtk, ".nii": read_nifti, ".nii.gz": read_nifti, ".vol": read_mitsuba}
SUFFIXES = tuple(READERS)


@typed_call
def read_volume(path: Path, *, memory_limit: int | None = None) -> Volume:
    """Read a regular volume.

    Args:
        path: .vtk (legacy, structured points), .nii or .nii.gz (NIfTI-1), .vol (Mitsuba).
        memory_limit: bytes that reading may take; what is available by default. It is compared
            with what the header states before values are read.

    Raises:
        IoError: no file, an unknown kind of file, a damaged one, one that needs more memory, values
            that are not finite.
    """
    path = Path(path)
    name = path.name.lower()
    readers = [reader for suffix, reader in READERS.items() if name.endswith(suffix)]
    if not readers:
        raise refuse(path, f"a name that ends in one of {', '.join(SUFFIXES)}", path.suffix)
    require_file("read_volume", path)
    return readers[0](path, memory_limit=memory_limit)
