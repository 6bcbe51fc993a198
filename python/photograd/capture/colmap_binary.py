"""The binary form of COLMAP's sparse models: little-endian records, one after another.

    cameras.bin   u64 count; each: i32 id, i32 model, u64 width, u64 height, f64 parameters...
    images.bin    u64 count; each: i32 id, f64 quaternion[4], f64 translation[3], i32 camera,
                  name ending in a zero byte, u64 count, each: f64 x, f64 y, i64 point
    points3D.bin  u64 count; each: u64 id, f64 position[3], u8 colour[3], f64 error,
                  u64 count, each: i32 image, i32 index

Counts are believed only as far as the file is long, so that a damaged count cannot ask for memory.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from photograd_course.input_files import read_file

from photograd.capture.colmap_model import (
    MODELS,
    ColmapCamera,
    ColmapImage,
    ColmapModel,
    ColmapPoints,
)
from photograd.errors import IoError, message

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
            place = f"{self.name} byte {self.offset}"
            raise IoError(message("read_binary_model", place, "a name that ends", "end of file"))
        raw, self.offset = self.data[self.offset : end], end + 1
        try:
            return raw.decode("utf-8")
        except UnicodeDecodeError as error:
            place = f"{self.name} byte {self.offset}"
            raise IoError(message("read_binary_model", place, "UTF-8", error)) from error

    def finish(self) -> None:
        if self.offset != len(self.data):
            got = f"{len(self.data) - self.offset} more bytes"
            raise IoError(message("read_binary_model", self.name, "the end of the file", got))


def read_binary_model(folder: Path) -> ColmapModel:
    """Read cameras.bin, images.bin and, if it is there, points3D.bin.

    Raises:
        IoError: names file and byte: too short, too long, unknown model, or not UTF-8.
    """
    points_file = folder / "points3D.bin"
    return ColmapModel(
        cameras=_read_cameras(_open(folder / "cameras.bin")),
        images=_read_images(_open(folder / "images.bin")),
        points=_read_points(_open(points_file)) if points_file.exists() else None,
    )


def _open(path: Path) -> _Reader:
    return _Reader(path.name, read_file("read_binary_model", path))


def _read_cameras(reader: _Reader) -> dict[int, ColmapCamera]:
    cameras: dict[int, ColmapCamera] = {}
    for _ in range(reader.count(24)):
        camera_id, model, width, height = reader.take("<iiQQ")
        place = f"{reader.name} byte {reader.offset}"
        if not 0 <= model < len(MODELS):
            expected = f"a camera model of 0 to {len(MODELS) - 1}"
            raise IoError(message("read_binary_model", place, expected, model))
        if camera_id in cameras:
            raise IoError(message("read_binary_model", place, "a new camera id", camera_id))
        name, parameters = MODELS[model]
        values = reader.take(f"<{parameters}d")
        cameras[camera_id] = ColmapCamera(name, width, height, values)
    reader.finish()
    return cameras


def _read_images(reader: _Reader) -> list[ColmapImage]:
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


def _read_points(reader: _Reader) -> ColmapPoints:
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
