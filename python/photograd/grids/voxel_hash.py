"""A hash table from integer voxels to rows of payload arrays, for scenes of unknown extent.

The table answers one question: which row of an array (N, C) belongs to voxel (x, y, z)? The arrays
stay the caller's: `row_limit` says how many rows they must have. [Niessner2013]
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call

Rows = npt.NDArray[np.int32]
MIN_COORDINATE, MAX_COORDINATE = -(1 << 20), (1 << 20) - 1
"""Coordinates of a voxel: three times 21 bits make a key."""


@dataclass(frozen=True)
class VoxelHashStatistics:
    """How full the table is.

    Attributes:
        count: voxels.
        row_limit: one more than the largest row in use.
        slots: of the table; at most half of them are in use.
        bytes: of the slots.
        longest_probe: slots that the longest search for a voxel looks at.
        mean_probe: the same on average over all voxels.
    """

    count: int
    row_limit: int
    slots: int
    bytes: int
    longest_probe: int
    mean_probe: float

    @property
    def load(self) -> float:
        """Part of the slots in use."""
        return self.count / self.slots if self.slots else 0.0


@typed_call
class VoxelHash:
    """Voxels and the row that each of them has.

    Threads may share a table. From one thread, rows depend on nothing but the calls: new voxels
    get rows in the order of the list, the rows freed last first and then new ones, on any number of
    cores. Distinct voxels in an empty table get 0, 1, 2 and so on. Threads that insert at the same
    time race for rows, but none is given twice and no voxel is lost.
    """

    def __init__(self, voxels: npt.NDArray[np.integer[Any]] | None = None) -> None:
        """Raises what `insert` raises for the voxels (N, 3) to start with."""
        self._core = _core.VoxelHash()
        if voxels is not None:
            self.insert(voxels)

    def insert(self, voxels: npt.NDArray[np.integer[Any]]) -> Rows:
        """Rows (N,) of voxels (N, 3), which are given one where they have none.

        Raises:
            DtypeError, ShapeError: not integers, not (N, 3).
            RangeError: coordinates outside of -2^20 .. 2^20 - 1, counted. Nothing is inserted then.
        """
        checked, rows = _checked("VoxelHash.insert", voxels)
        self._core.insert(checked, rows)
        return rows

    def find(self, voxels: npt.NDArray[np.integer[Any]]) -> Rows:
        """Rows (N,) of voxels (N, 3), -1 for those without; raises as `insert` does."""
        checked, rows = _checked("VoxelHash.find", voxels)
        self._core.find(checked, rows)
        return rows

    def erase(self, voxels: npt.NDArray[np.integer[Any]]) -> Rows:
        """Forget voxels (N, 3).

        Returns:
            The rows (N,) that are free now, -1 for voxels that had none or were erased further up
            in the list. New voxels will get them.

        Raises:
            DtypeError, ShapeError, RangeError: as for `insert`.
        """
        checked, rows = _checked("VoxelHash.erase", voxels)
        self._core.erase(checked, rows)
        return rows

    def items(self) -> tuple[npt.NDArray[np.int32], Rows]:
        """All voxels (M, 3) and their rows (M,), by ascending row."""
        voxels, rows = self._core.items()
        return voxels, rows

    def statistics(self) -> VoxelHashStatistics:
        """How full the table is, and how far searches go."""
        return VoxelHashStatistics(*self._core.statistics())

    def __len__(self) -> int:
        """Number of voxels."""
        return self.statistics().count


def _checked(name: str, voxels: npt.NDArray[np.integer[Any]]) -> tuple[Rows, Rows]:
    """Voxels as contiguous int32, none of them wrapped around, and rows to fill."""
    call = Arguments(name, np.int64)
    wide = call.array("voxels", voxels, ("N", 3), low=MIN_COORDINATE, high=MAX_COORDINATE)
    return wide.astype(np.int32), np.empty(len(wide), np.int32)
