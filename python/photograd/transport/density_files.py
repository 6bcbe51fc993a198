"""Densities of media from files: .npy, .vdb, and the volumes of scanners and simulations.

A `DensityGrid` may lie in the world in any affine way: turned, sheared, mirrored. So a file's
lattice is taken as it stands, value by value, and nothing is ever resampled.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from photograd._files import read_npy
from photograd._memory import require_room
from photograd._typed import typed_call
from photograd.errors import IoError, RangeError, message
from photograd.grids.sparse import SparseGrid
from photograd.grids.vdb import VdbFile, read_vdb
from photograd.grids.volumes import SUFFIXES, read_volume
from photograd.transport.medium import DensityGrid
from photograd.types import Array

NAME = "read_density"
BYTES = 20
"""A voxel takes in a scene: float32 as read, float64 in the medium, and the tracer's own copy."""
PLACED = (".vdb", *SUFFIXES)
"""Ends of names of files that say themselves where their voxels lie."""


def is_placed(path: Path) -> bool:
    """Whether a file of this name says where its voxels lie.

    Args:
        path: of the file.
    """
    return path.name.lower().endswith(PLACED)


@typed_call
def read_density(
    path: Path,
    *,
    grid: str | None = None,
    corner: Sequence[float] | None = None,
    size: Sequence[float] | None = None,
    majorant: float | None = None,
    memory_limit: int | None = None,
) -> DensityGrid:
    """A density from a file, on the file's own lattice.

    Of a .vdb the box of active voxels is taken, and one layer more of the background around it:
    interpolated values then are those of OpenVDB's own sampler, everywhere.

    Args:
        path: .npy of numbers (X, Y, Z), .vdb, or what `photograd.grids.volumes.read_volume` reads.
        grid: of a .vdb: the name; None takes the first grid of scalars.
        corner, size: (3,) meters, both or neither: what the box around the voxels is moved and
            stretched to. A .npy needs them; other files lie where they say, in meters.
        majorant: of the `DensityGrid`.
        memory_limit: bytes; what is available by default.

    Raises:
        IoError: no such file or grid, a damaged file, or one that needs more memory to read.
        RangeError: no voxels, values below 0, a background other than 0, or more memory than there
            is; nothing is allocated then.
    """
    if not is_placed(path):
        if corner is None or size is None:
            expected = "both, of the box that a .npy fills"
            raise RangeError(message(NAME, "corner, size", expected, f"{corner}, {size}"))
        return DensityGrid(read_npy(NAME, path), _box(corner, size), majorant)
    if path.name.lower().endswith(".vdb"):
        sparse = _grid_of(path, read_vdb(path, memory_limit=memory_limit), grid)
        values, world_from_index, first = _layers(path, sparse, memory_limit)
        ends = sparse.statistics.box
    else:
        volume = read_volume(path, memory_limit=memory_limit)
        values, world_from_index, first = volume.density, volume.world_from_index, np.zeros(3)
        ends = np.array([(0, 0, 0), values.shape])
    if corner is not None and size is not None:
        world_from_index = _moved(world_from_index, ends - 0.5, corner, size)
    # A value sits in the middle of its voxel.
    return DensityGrid(values, world_from_index @ _box(first - 0.5, values.shape), majorant)


def _box(corner: Any, size: Any) -> Array:
    """(4, 4) from [0, 1]^3 to a box along the axes."""
    matrix = np.diag([*np.asarray(size, np.float64), 1.0])
    matrix[:3, 3] = corner
    return matrix


def _grid_of(path: Path, file: VdbFile, name: str | None) -> SparseGrid:
    found = [grid for grid in file.grids if name is None or grid.name == name]
    scalars = [grid for grid in found if grid.channels == 1]
    if scalars:
        return scalars[0]
    expected = "a grid of scalars" if name is None else f"a grid of scalars called '{name}'"
    names = ", ".join(f"'{grid.name}' ({grid.channels} channels)" for grid in file.grids)
    raise IoError(message(NAME, f"{path}", expected, names or "no grid"))


def _layers(path: Path, grid: SparseGrid, memory_limit: int | None) -> tuple[Array, Array, Array]:
    """Values of the active box and a layer around it, world_from_index, index of the first."""
    argument = f"{path}: grid '{grid.name}'"
    found = grid.statistics
    if not found.active_voxels:
        raise RangeError(message(NAME, argument, "active voxels", "none"))
    if grid.background.any():
        expected, got = "a background of 0, as around a cloud", float(grid.background[0])
        remedy = "a level set is a distance, no density"
        raise RangeError(message(NAME, argument, expected, got, remedy))
    if found.least < 0:
        raise RangeError(message(NAME, argument, "densities of at least 0", found.least))
    box = found.box + np.array([[-1], [1]])
    shape = (box[1] - box[0]).tolist()
    what = f"{argument}, {' x '.join(map(str, shape))} voxels in a medium"
    require_room(NAME, what, BYTES * int(np.prod(shape, dtype=object)), memory_limit)
    values, first = grid.to_dense(box, memory_limit=memory_limit)
    return values[..., 0], grid.world_from_index, first.astype(np.float64)


def _moved(world_from_index: Array, ends: Array, corner: Any, size: Any) -> Array:
    """`world_from_index`, and then what takes the bounds of a box of indices (2, 3) elsewhere."""
    corners = np.array([[ends[i, 0], ends[j, 1], ends[k, 2]] for i, j, k in np.ndindex(2, 2, 2)])
    world = corners @ world_from_index[:3, :3].T + world_from_index[:3, 3]
    bounds = _box(world.min(axis=0), np.ptp(world, axis=0))
    moved: Array = _box(corner, size) @ np.linalg.inv(bounds) @ world_from_index
    return moved
