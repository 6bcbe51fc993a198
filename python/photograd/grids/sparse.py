"""Sparse grids: values on the integer lattice, of which only the active ones are stored.

OpenVDB holds the topology and the files (cpp/photograd/grid/sparse_grid.h). Voxel (i, j, k) has its
value at the index-space point (i, j, k), the middle of the voxel; `world_from_index` (4, 4) takes
such points to world meters. What is not active has the background's value. [Museth2013]
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._memory import require_room
from photograd._typed import typed_call
from photograd.errors import RangeError, message
from photograd.types import Array

MAX_STEPS = 200
"""Of one dilation: a single voxel becomes a cube of 401^3, 64 million in a few seconds. Time and
memory grow with the cube of the steps."""
OWN_KEYS = ("name", "file_")
"""Metadata that belong to a grid's name or that every writing makes anew."""


@dataclass(frozen=True)
class SparseStatistics:
    """What a grid holds; `box` (2, 3) is the lowest active voxel and one past the highest."""

    active_voxels: int  # those inside of active tiles included
    active_tiles: int  # nodes with one active value, stored once
    leaves: int
    memory: int  # bytes
    box: Array
    least: float  # over the active values and channels, 0 if there are none
    most: float


@typed_call
class SparseGrid:
    """A sparse grid of one channel (scalars) or three (vectors), in float32."""

    def __init__(self, core: _core.SparseGrid) -> None:
        """Takes a grid of the core; see `from_dense` and `photograd.grids.vdb.read_vdb`."""
        self.core = core

    @classmethod
    def from_dense(
        cls,
        values: Array,
        *,
        origin: Sequence[int] = (0, 0, 0),
        background: float | Sequence[float] = 0.0,
        tolerance: float = 0.0,
        world_from_index: Array | None = None,
        name: str = "density",
    ) -> SparseGrid:
        """Activate what differs from the background by more than `tolerance` in any channel.

        Args:
            values: (X, Y, Z) or (X, Y, Z, 3), kept as float32; entry [0, 0, 0] becomes voxel
                `origin`.
            origin: index of the first voxel.
            background: the value of everything else, one number or one for each channel.
            tolerance: largest difference that is dropped.
            world_from_index: (4, 4) affine; the identity by default.
            name: name of the grid.

        Raises:
            ShapeError, DtypeError: another shape, or no numbers.
            RangeError: values that are not finite, a tolerance below zero, an index beyond 32 bits,
                a singular transform.
        """
        where = "SparseGrid.from_dense"
        call = Arguments(where, np.float32)
        axes = ("X", "Y", "Z")
        values = call.array("values", values, axes, (*axes, 1), (*axes, 3))
        call.number("tolerance", tolerance, low=0)
        full = values.reshape((*values.shape[:3], -1))
        empty = call.array("background", background, (), (full.shape[3],))
        empty = np.broadcast_to(empty, full.shape[3:])
        ends = np.stack([np.asarray(origin), np.add(origin, values.shape[:3])])
        corner = _indices(where, "origin", ends)[0]
        core = _core.SparseGrid.from_dense(
            full, corner.tolist(), np.ascontiguousarray(empty), tolerance
        )
        grid = cls(core)
        grid.name = name
        if world_from_index is not None:
            grid.world_from_index = world_from_index
        return grid

    def to_dense(
        self, box: ArrayLike | None = None, *, memory_limit: int | None = None
    ) -> tuple[Array, Array]:
        """The values (X, Y, Z, C) of a box of voxels, and the index (3,) of the first.

        Args:
            box: (2, 3) lowest voxel and one past the highest; that of the active voxels by default.
            memory_limit: bytes; what is available by default.

        Raises:
            RangeError: an empty box, or an array beyond the limit. Nothing is allocated then.
        """
        corners = self.statistics.box if box is None else box
        lo, hi = _indices("SparseGrid.to_dense", "box", corners)
        shape = (hi - lo).tolist()
        if min(shape) < 1:
            raise RangeError(message("SparseGrid.to_dense", "box", "one voxel or more", shape))
        size = 4 * self.channels * shape[0] * shape[1] * shape[2]
        require_room("SparseGrid.to_dense", f"an array of {shape} voxels", size, memory_limit)
        out = np.empty((*shape, self.channels), np.float32)
        self.core.to_dense(lo.tolist(), out)
        return out, lo

    @property
    def channels(self) -> int:
        """1 or 3."""
        return self.core.channels

    @property
    def background(self) -> Array:
        """(C,) the value of what is not active."""
        return np.array(self.core.background, np.float32)

    @property
    def name(self) -> str:
        """Name of the grid in its file."""
        return self.core.name

    @name.setter
    def name(self, name: str) -> None:
        self.core.name = name

    @property
    def metadata(self) -> dict[str, bool | int | float | str]:
        """A copy of the grid's metadata; `set_metadata` changes them."""
        return {k: v for k, v in self.core.metadata().items() if not k.startswith(OWN_KEYS)}

    def set_metadata(self, key: str, value: bool | float | str) -> None:
        """Keep a value with the grid. Raises RangeError for keys that the file format uses."""
        if key.startswith(OWN_KEYS):
            raise RangeError(message("SparseGrid.set_metadata", "key", "a key of yours", repr(key)))
        self.core.set_metadata(key, value)

    @property
    def world_from_index(self) -> Array:
        """(4, 4) affine matrix for column vectors."""
        return np.array(self.core.world_from_index()).reshape(4, 4)

    @world_from_index.setter
    def world_from_index(self, matrix: ArrayLike) -> None:
        call = Arguments("SparseGrid", np.float64)
        m = call.array("world_from_index", matrix, (4, 4), finite=False)
        if not np.array_equal(m[3], [0, 0, 0, 1]):
            got = f"a last row of {m[3]}"
            raise RangeError(message("SparseGrid", "world_from_index", "an affine matrix", got))
        self.core.set_world_from_index(m.ravel().tolist())

    def to_world(self, points: Array) -> Array:
        """World points (N, 3) of index-space points (N, 3)."""
        m = self.world_from_index
        return np.asarray(points @ m[:3, :3].T + m[:3, 3])

    def to_index(self, points: Array) -> Array:
        """Index-space points (N, 3) of world points (N, 3)."""
        m = self.world_from_index
        return np.asarray(np.linalg.solve(m[:3, :3], (points - m[:3, 3]).T).T)

    @property
    def statistics(self) -> SparseStatistics:
        """Counts, bytes, bounds and extremes; one pass over the active values."""
        s = self.core.statistics()
        return SparseStatistics(
            s.active_voxels,
            s.active_tiles,
            s.leaves,
            s.memory,
            np.array(s.box, np.int64),
            s.min,
            s.max,
        )

    def sample(self, points: Array) -> Array:
        """Trilinear values (N, C) at world points (N, 3), by OpenVDB's own sampler.

        Raises:
            ShapeError: points are not (N, 3).
            RangeError: a point that is not finite or lies beyond 32-bit indices.
        """
        points = Arguments("SparseGrid.sample", np.float64).array("points", points, ("N", 3))
        at = np.ascontiguousarray(self.to_index(points))
        if not (np.abs(at) < 2**31 - 2).all():  # also catches NaN
            raise RangeError(message("SparseGrid.sample", "points", "finite, near", "others"))
        return self.core.sample(at)

    def values_at(self, voxels: ArrayLike) -> tuple[Array, Array]:
        """Values (N, C) of voxels (N, 3), and whether each is active (N,)."""
        values, active = self.core.values_at(_indices("SparseGrid.values_at", "voxels", voxels))
        return values, active.astype(bool)

    def activate(self, voxels: ArrayLike, values: Array) -> None:
        """Write values (N, C), kept as float32, to voxels (N, 3) and activate them.

        Raises:
            DtypeError, ShapeError, RangeError: wrong types or shapes, indices beyond 2^30, values
                that are not finite.
        """
        call = Arguments("SparseGrid.activate", np.float32)
        at = _indices("SparseGrid.activate", "voxels", voxels)
        self.core.activate(at, call.array("values", values, (len(at), self.channels)))

    def prune(self, tolerance: float = 0.0) -> None:
        """Deactivate what differs from the background by at most `tolerance`; drop empty nodes."""
        Arguments("SparseGrid.prune").number("tolerance", tolerance, low=0)
        self.core.prune(tolerance)

    def dilate(self, steps: int = 1) -> None:
        """Activate all voxels within `steps` of an active one along each axis (a cube around it).

        One step covers whatever a trilinear lookup reads around a point in an active voxel.

        Raises:
            RangeError: steps outside of 1 to `MAX_STEPS`, or more voxels than memory may hold.
        """
        Arguments("SparseGrid.dilate").integer("steps", steps, low=1, high=MAX_STEPS)
        found = self.statistics
        around = [
            found.active_voxels * (2 * steps + 1) ** 3,
            math.prod((np.diff(found.box, axis=0)[0] + 2 * steps).tolist()),
        ]
        if not found.active_tiles:
            around.append(found.leaves * (8 + 2 * steps) ** 3)
        room = 5 * self.channels * min(around)  # four bytes a value, masks and nodes
        require_room(
            "SparseGrid.dilate",
            f"up to {min(around):,} voxels",
            room - found.memory,
            argument="steps",
            remedy="take fewer steps, or a coarser grid",
        )
        self.core.dilate(steps)

    def copy(self) -> SparseGrid:
        """A grid that shares nothing with this one."""
        return SparseGrid(self.core.copy())


def _indices(function: str, argument: str, voxels: ArrayLike) -> Array:
    """(N, 3) int32, refused when they are no integers or too large."""
    call = Arguments(function, np.int64)
    wide = call.array(argument, voxels, ("N", 3), low=-(2**30), high=2**30)
    return wide.astype(np.int32)
