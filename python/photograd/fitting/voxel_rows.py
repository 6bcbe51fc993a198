"""The density of every voxel or leaf as rows, whatever stores it, and rows as a dense array."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from photograd.fields.dense_grid import DenseGrid
from photograd.fields.octree_sh import OctreeSh
from photograd.fitting.start import VoxelField
from photograd.types import Array


def density_rows(field: VoxelField, groups: Mapping[str, Array]) -> Array:
    """(N,) what `groups` says of raw density, one row a voxel or leaf.

    `groups` are the field's parameters or their gradients. Voxels of a dense grid are in C order.
    """
    return groups["values"][..., 3].ravel() if isinstance(field, DenseGrid) else groups["density"]


def voxel_shape(field: VoxelField) -> tuple[int, int, int]:
    """Voxels (X, Y, Z) of the field's box; those of an octree are its smallest cells."""
    if isinstance(field, DenseGrid):
        return field.shape[:3]
    x, y, z = field.tree.shape if isinstance(field, OctreeSh) else field.active.shape
    return x, y, z


def to_voxels(field: VoxelField, rows: Array) -> Array:
    """Rows (N,) as an array (X, Y, Z), with 0 where nothing has a row.

    The number of a leaf, which stands for all of its cells, is that of each of them.
    """
    if isinstance(field, DenseGrid):
        return rows.reshape(voxel_shape(field))
    if isinstance(field, OctreeSh):
        of_leaf = np.append(rows, np.zeros(1, rows.dtype))[field.row]  # row -1 is the last
        return field.tree.expand(of_leaf[:, None])[..., 0]
    voxels = np.zeros(voxel_shape(field), rows.dtype)
    i, j, k = field.active.voxels.T
    voxels[i, j, k] = rows
    return voxels


def active_voxels(field: VoxelField) -> NDArray[np.bool_]:
    """(X, Y, Z) which voxels have a row: all of a dense grid, the leaves with matter of a tree."""
    rows = len(density_rows(field, field.params))
    return to_voxels(field, np.ones(rows, np.bool_))
