"""Brick fields: values on a frozen sparse topology, looked up and differentiated fast.

The topology comes from a `SparseGrid` and stays fixed; the values are a plain array, one row for
each active voxel, in the order of the grid's leaves (cpp/photograd/grid/brick_field.h).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._memory import available_memory, require_room
from photograd._typed import typed_call
from photograd.grids.sparse import SparseGrid
from photograd.types import Array


class BrickGradients(NamedTuple):
    """dL/d of what `BrickField.sample` was computed from.

    `background` is what reaches voxels that are not active: what would be lost if nobody asked.
    """

    values: Array  # (N, C)
    background: Array  # (C,)
    points: Array  # (P, 3) in index space


@typed_call
class BrickField:
    """Values (N, C) on the active voxels of a sparse grid; everything else has the background."""

    def __init__(self, grid: SparseGrid, *, memory_limit: int | None = None) -> None:
        """Take topology and values from `grid`, which is not changed.

        Active tiles become single voxels. Raises RangeError if the tables need more than
        `memory_limit` bytes (what is available by default), before they are made.
        """
        limit = available_memory() if memory_limit is None else memory_limit
        s = grid.statistics
        size = s.memory + 4 * grid.channels * s.active_voxels
        require_room("BrickField", f"{s.active_voxels} voxels", size, limit)
        self.grid = grid.copy()
        self.grid.core.voxelize()
        origins, active = self.grid.core.leaves()
        self.origins: Array = origins
        self.active: Array = active.astype(bool)
        self.topology = _core.BrickTopology(origins, active, limit)
        self.values: Array = self.grid.core.leaf_values()
        self.background: Array = grid.background

    @property
    def voxels(self) -> Array:
        """(N, 3) index of the voxel of each row of `values`."""
        brick, *inside = np.nonzero(self.active)
        return np.asarray(self.origins[brick] + np.stack(inside, axis=-1), np.int32)

    def to_sparse(self) -> SparseGrid:
        """A sparse grid with these values, bit for bit. The values must be float32."""
        self.grid.core.set_leaf_values(np.ascontiguousarray(self.values))
        return self.grid.copy()

    def sample(self, points: Array) -> Array:
        """Trilinear values (P, C) at index-space points (P, 3), of the dtype of `values`.

        Raises:
            ShapeError: points are not (P, 3).
            RangeError: a point that is not finite or beyond 2^30 voxels.
        """
        at = self._points(points)
        out = np.empty((len(at), self.values.shape[1]), self.values.dtype)
        _core.sample_bricks(self.topology, self.values, self._background(), at, out)
        return out

    def sample_backward(self, points: Array, d_out: Array) -> BrickGradients:
        """The derivatives of a loss with respect to values, background and points.

        Args:
            points: (P, 3), as for `sample`.
            d_out: (P, C) dL/d sample, of the dtype of `values`.
        """
        at = self._points(points)
        gradients = BrickGradients(
            np.zeros_like(self.values), np.zeros_like(self._background()), np.zeros_like(at)
        )
        _core.sample_bricks_backward(
            self.topology,
            self.values,
            self._background(),
            at,
            np.ascontiguousarray(d_out),
            gradients.values,
            gradients.background,
            gradients.points,
        )
        return gradients

    def _background(self) -> Array:
        return np.ascontiguousarray(self.background, self.values.dtype)

    def _points(self, points: Array) -> Array:
        call = Arguments("BrickField", self.values.dtype)
        return call.array("points", points, ("P", 3), above=-(2.0**30), below=2.0**30)
