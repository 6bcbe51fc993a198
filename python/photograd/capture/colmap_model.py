"""COLMAP sparse models: what they hold, and the text and binary forms of their files.

COLMAP stores camera_from_world with OpenCV axes, quaternions as (w, x, y, z), and pixel centers at
+0.5, all of which is ours too [Schoenberger2016].

    cameras.bin   u64 count; each: i32 id, i32 model, u64 width, u64 height, f64 parameters...
    images.bin    u64 count; each: i32 id, f64 quaternion[4], f64 translation[3], i32 camera,
                  name ending in a zero byte, u64 count, each: f64 x, f64 y, i64 point
    points3D.bin  u64 count; each: u64 id, f64 position[3], u8 color[3], f64 error,
                  u64 count, each: i32 image, i32 index

Counts are believed only as far as the file is long, so that a damaged count cannot ask for memory.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt
from photograd_course.input_files import read_file, read_text

from photograd.errors import IoError, RangeError, message
from photograd.types import FloatArray

MODELS = (
    ("SIMPLE_PINHOLE", 3),
    ("PINHOLE", 4),
    ("SIMPLE_RADIAL", 4),
    ("RADIAL", 5),
    ("OPENCV", 8),
    ("OPENCV_FISHEYE", 8),
    ("FULL_OPENCV", 12),
    ("FOV", 5),
    ("SIMPLE_RADIAL_FISHEYE", 4),
    ("RADIAL_FISHEYE", 5),
    ("THIN_PRISM_FISHEYE", 12),
    ("RAD_TAN_THIN_PRISM_FISHEYE", 16),
    ("SIMPLE_DIVISION", 4),
    ("DIVISION", 5),
    ("SIMPLE_FISHEYE", 3),
    ("FISHEYE", 4),
    ("EUCM", 6),
    ("EQUIRECTANGULAR", 2),
)
"""Name and number of parameters; the index is the model's number in the binary form."""

Number = TypeVar("Number", int, float)


@dataclass(frozen=True)
class ColmapCamera:
    """Intrinsics: `parameters` mean what `model` says."""

    model: str
    width: int
    height: int
    parameters: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class ColmapImage:
    """Pose of one image and what it observes.

    Attributes:
        quaternion, translation: camera_from_world, (4,) as (w, x, y, z) and (3,).
        pixels: (M, 2) observed positions in the distorted image.
        point_ids: (M,) which point each observes, -1 for none.
    """

    name: str
    camera_id: int
    quaternion: FloatArray
    translation: FloatArray
    pixels: FloatArray
    point_ids: npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class ColmapPoints:
    """Sparse points: ids (N,), positions (N, 3), 8-bit colors (N, 3)."""

    ids: npt.NDArray[np.int64]
    positions: FloatArray
    colors: npt.NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class ColmapModel:
    """A whole sparse model; images in the order of the file."""

    cameras: dict[int, ColmapCamera]
    images: list[ColmapImage]
    points: ColmapPoints | None


def read_text_model(folder: Path) -> ColmapModel:
    """Read cameras.txt, images.txt and, if it is there, points3D.txt.

    Args:
        folder: that holds them.

    Raises:
        IoError, RangeError: names file and line.
    """
    points_file = folder / "points3D.txt"
    return ColmapModel(
        cameras=_read_cameras(folder / "cameras.txt"),
        images=_read_images(folder / "images.txt"),
        points=_read_points(points_file) if points_file.exists() else None,
    )


@dataclass(frozen=True)
class _Line:
    """Words of one line, read one after another."""

    where: str
    words: list[str]

    def take(self, index: int, kind: type[Number]) -> Number:
        if index >= len(self.words):
            got = f"{len(self.words)}"
            raise IoError(message("read_text_model", self.where, f"more than {index} words", got))
        return self.convert(self.words[index], kind)

    def convert(self, word: str, kind: type[Number]) -> Number:
        try:
            value: Number = kind(word)
        except ValueError as error:
            got = repr(word[:40])
            expected = f"a word that reads as {kind.__name__}"
            raise IoError(message("read_text_model", self.where, expected, got)) from error
        if not abs(value) <= 1e18:  # refuses NaN too
            raise RangeError(message("read_text_model", self.where, "a finite number", word[:40]))
        return value

    def floats(self, start: int, stop: int | None = None) -> list[float]:
        return [self.convert(word, float) for word in self.words[start:stop]]


def _lines(path: Path) -> Iterator[_Line]:
    """Lines of a text file without comments; empty lines are kept, since they mean no points."""
    text = read_text("read_text_model", path)
    for number, line in enumerate(text.split("\n"), start=1):
        if not line.startswith("#"):
            yield _Line(f"{path.name} line {number}", line.split())


def _read_cameras(path: Path) -> dict[int, ColmapCamera]:
    cameras: dict[int, ColmapCamera] = {}
    for line in _lines(path):
        if not line.words:
            continue
        camera_id = line.take(0, int)
        if camera_id in cameras:
            raise IoError(message("read_text_model", line.where, "a new camera id", camera_id))
        model = line.words[1] if len(line.words) > 1 else ""
        parameters = tuple(line.floats(4))
        known = dict(MODELS)
        if model not in known:
            raise IoError(message("read_text_model", line.where, "a camera model", repr(model)))
        if len(parameters) != known[model]:
            expected = f"{known[model]} parameters of {model}"
            raise IoError(message("read_text_model", line.where, expected, len(parameters)))
        cameras[camera_id] = ColmapCamera(model, line.take(2, int), line.take(3, int), parameters)
    return cameras


def _read_images(path: Path) -> list[ColmapImage]:
    """Each image takes two lines: its pose, then its observations, possibly none."""
    images: list[ColmapImage] = []
    lines = _lines(path)
    for line in lines:
        if not line.words:
            continue
        if len(line.words) < 10:
            expected = "ten words: id, quaternion, translation, camera, name"
            raise IoError(message("read_text_model", line.where, expected, len(line.words)))
        values = line.floats(1, 8)
        observed = next(lines, _Line(f"{line.where} (missing second line)", []))
        if len(observed.words) % 3:
            got = f"{len(observed.words)} words"
            raise IoError(message("read_text_model", observed.where, "triples X Y POINT3D_ID", got))
        triples = np.array(observed.floats(0), dtype=np.float64).reshape(-1, 3)
        images.append(
            ColmapImage(
                name=" ".join(line.words[9:]),
                camera_id=line.take(8, int),
                quaternion=np.array(values[:4]),
                translation=np.array(values[4:]),
                pixels=triples[:, :2].copy(),
                point_ids=triples[:, 2].astype(np.int64),
            )
        )
    return images


def _read_points(path: Path) -> ColmapPoints:
    ids: list[int] = []
    rows: list[list[float]] = []
    for line in _lines(path):
        if not line.words:
            continue
        line.take(6, int)
        ids.append(line.take(0, int))
        rows.append(line.floats(1, 7))
        if not all(0.0 <= level <= 255.0 for level in rows[-1][3:]):
            raise RangeError(message("read_text_model", line.where, "0 to 255", rows[-1][3:]))
    table = np.array(rows, dtype=np.float64).reshape(-1, 6)
    return ColmapPoints(
        np.array(ids, dtype=np.int64), table[:, :3].copy(), table[:, 3:].astype(np.uint8)
    )


# The binary form of COLMAP's sparse models: little-endian records, one after another.


_OBSERVATION = np.dtype([("x", "<f8"), ("y", "<f8"), ("point", "<i8")])
_POINT = struct.Struct("<Q3d3BdQ")


@dataclass
class _Reader:
    """Bytes of a file and how far they have been read."""

    name: str
    data: bytes
    offset: int = 0

    def take(self, layout: str) -> tuple[Any, ...]:
        size = struct.calcsize(layout)
        self.require(size)
        values = struct.unpack_from(layout, self.data, self.offset)
        self.offset += size
        return values

    def require(self, size: int) -> None:
        left = len(self.data) - self.offset
        if size > left:
            got = f"{left} left at byte {self.offset}"
            raise IoError(message("read_binary_model", self.name, f"{size} more bytes", got))

    def count(self, smallest_record: int) -> int:
        """A count of records that each need at least `smallest_record` bytes."""
        count = int(self.take("<Q")[0])
        self.require(count * smallest_record)
        return count

    def text(self) -> str:
        end = self.data.find(b"\0", self.offset)
        if end < 0:
            where = f"{self.name} byte {self.offset}"
            raise IoError(message("read_binary_model", where, "a name that ends", "end of file"))
        raw, self.offset = self.data[self.offset : end], end + 1
        try:
            return raw.decode("utf-8")
        except UnicodeDecodeError as error:
            where = f"{self.name} byte {self.offset}"
            raise IoError(message("read_binary_model", where, "UTF-8", error)) from error

    def finish(self) -> None:
        if self.offset != len(self.data):
            got = f"{len(self.data) - self.offset} more bytes"
            raise IoError(message("read_binary_model", self.name, "the end of the file", got))


def read_binary_model(folder: Path) -> ColmapModel:
    """Read cameras.bin, images.bin and, if it is there, points3D.bin.

    Args:
        folder: that holds them.

    Raises:
        IoError: names file and byte: too short, too long, unknown model, or not UTF-8.
    """
    points_file = folder / "points3D.bin"
    return ColmapModel(
        cameras=_binary_cameras(_open(folder / "cameras.bin")),
        images=_binary_images(_open(folder / "images.bin")),
        points=_binary_points(_open(points_file)) if points_file.exists() else None,
    )


def _open(path: Path) -> _Reader:
    return _Reader(path.name, read_file("read_binary_model", path))


def _binary_cameras(reader: _Reader) -> dict[int, ColmapCamera]:
    cameras: dict[int, ColmapCamera] = {}
    for _ in range(reader.count(24)):
        camera_id, model, width, height = reader.take("<iiQQ")
        where = f"{reader.name} byte {reader.offset}"
        if not 0 <= model < len(MODELS):
            expected = f"a camera model of 0 to {len(MODELS) - 1}"
            raise IoError(message("read_binary_model", where, expected, model))
        if camera_id in cameras:
            raise IoError(message("read_binary_model", where, "a new camera id", camera_id))
        name, parameters = MODELS[model]
        values = reader.take(f"<{parameters}d")
        cameras[camera_id] = ColmapCamera(name, width, height, values)
    reader.finish()
    return cameras


def _binary_images(reader: _Reader) -> list[ColmapImage]:
    images: list[ColmapImage] = []
    for _ in range(reader.count(73)):
        values = reader.take("<i7di")
        name = reader.text()
        count = reader.count(_OBSERVATION.itemsize)
        table = np.frombuffer(reader.data, _OBSERVATION, count, reader.offset)
        reader.offset += count * _OBSERVATION.itemsize
        images.append(
            ColmapImage(
                name=name,
                camera_id=values[8],
                quaternion=np.array(values[1:5]),
                translation=np.array(values[5:8]),
                pixels=np.stack([table["x"], table["y"]], axis=-1).astype(np.float64),
                point_ids=table["point"].astype(np.int64),
            )
        )
    reader.finish()
    return images


def _binary_points(reader: _Reader) -> ColmapPoints:
    count = reader.count(_POINT.size)
    ids = np.zeros(count, dtype=np.uint64)
    positions = np.zeros((count, 3))
    colors = np.zeros((count, 3), dtype=np.uint8)
    for index in range(count):
        reader.require(_POINT.size)
        values = _POINT.unpack_from(reader.data, reader.offset)
        reader.offset += _POINT.size
        ids[index], positions[index], colors[index] = values[0], values[1:4], values[4:7]
        reader.require(values[8] * 8)
        reader.offset += values[8] * 8
    reader.finish()
    return ColmapPoints(ids.astype(np.int64), positions, colors)
