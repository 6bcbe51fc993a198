"""What the readers of volumes return, and what they share: bytes that are checked before use."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from photograd._memory import available_memory
from photograd.errors import IoError, message
from photograd.types import Array

MOST_CELLS = 1 << 40
"""Voxels beyond which a header is taken for damaged, whatever memory there is."""


@dataclass(frozen=True, eq=False)
class Volume:
    """A regular grid of numbers.

    Attributes:
        values: (X, Y, Z, C) float32, finite.
        world_from_index: (4, 4); the index (i, j, k) is the middle of a voxel. Lengths are metres
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
    if cells > MOST_CELLS or needed > room:
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


def placed(spacing: Array, origin: Array) -> Array:
    """world_from_index (4, 4) of voxels `spacing` (3,) apart, the first at `origin` (3,)."""
    matrix = np.diag([*np.asarray(spacing, np.float64), 1.0])
    matrix[:3, 3] = origin
    return matrix
