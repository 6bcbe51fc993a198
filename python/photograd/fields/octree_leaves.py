"""The leaves of an octree of harmonics, and the grids that they come from.

Where a voxel is too transparent to be seen, the tree stays empty; everywhere else the field's
values at the voxel's center are those of a leaf. A step function then stands for a trilinear one,
and what that loses is what fine-tuning the leaves brings back.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd_course.portable_math import expm1, log, log1p, sigmoid, softplus

from photograd import sh
from photograd._checks import require_bounds
from photograd.errors import RangeError, message
from photograd.fields.dense_grid import DenseGrid
from photograd.fields.sparse_sh import SparseSh
from photograd.grids.octree import Octree
from photograd.types import Array

Corner = tuple[float, float, float]


@dataclass(frozen=True)
class TreePolicy:
    """Where a tree stands, and what its densities mean."""

    box: tuple[Corner, Corner]  # world, meters
    cells: tuple[int, int, int]  # along each edge of the box
    density_scale: float = 1.0  # 1/m

    def __post_init__(self) -> None:
        """Raises RangeError for a density scale that is not finite."""
        require_bounds(self, "density_scale")


@dataclass(frozen=True)
class Leaves:
    """A tree, the row (L,) of each of its leaves or -1, density (N,) raw and sh (N, K, 3)."""

    tree: Octree
    row: NDArray[np.int32]
    density: Array
    sh: Array


def leaves_of_grid(field: DenseGrid, *, degree: int, opacity: float, tolerance: float) -> Leaves:
    """See `OctreeSh.from_dense_grid`: voxels that are nearly equal share a larger leaf.

    Args:
        field: a dense grid.
        degree: of the harmonics.
        opacity: below which a voxel has no leaf.
        tolerance: difference up to which voxels are nearly equal.
    """
    cell = (field.box[1, 0] - field.box[0, 0]) / field.density.shape[0]
    scale = field.policy.density_scale
    sigma_t = scale * softplus(field.density.astype(np.float64))
    shown = -expm1(-sigma_t * cell)
    full = shown > opacity
    rgb = sigmoid(field.color.astype(np.float64))
    known = np.concatenate([shown[..., None], rgb], axis=-1) * full[..., None]
    tree = Octree.from_dense(known.astype(np.float32), field.box, tolerance=tolerance)
    held = tree.values.astype(np.float64)
    occupied = held[:, 0] > 0.5 * opacity
    row = np.where(occupied, np.cumsum(occupied) - 1, -1).astype(np.int32)
    mean = -log1p(-np.minimum(held[occupied, 0], 1.0 - 1e-6)) / cell
    color = np.clip(held[occupied, 1:], 1e-4, 1.0 - 1e-4)
    coefficients = np.zeros((int(occupied.sum()), sh.count(degree), 3))
    coefficients[:, 0] = log(color / (1.0 - color)) / sh.Y_0
    density = log(expm1(np.minimum(mean / scale, 500.0)))
    return Leaves(tree, row, density, coefficients)


def leaves_of_voxels(field: SparseSh, *, degree: int | None, opacity: float) -> Leaves:
    """See `OctreeSh.from_sparse_sh`: harmonics differ from voxel to voxel, so none share a leaf.

    Args:
        field: a sparse grid.
        degree: of the harmonics; None keeps them.
        opacity: below which a voxel has no leaf.
    """
    policy = field.policy
    if (policy.density_activation, policy.color_activation) != ("softplus", "sigmoid"):
        expected = "a field with density_activation 'softplus' and color_activation 'sigmoid'"
        got = f"{policy.density_activation!r} and {policy.color_activation!r}"
        raise RangeError(message("OctreeSh.from_sparse_sh", "field", expected, got))
    cell = (field.box[1, 0] - field.box[0, 0]) / field.active.shape[0]
    density = field.params["density"].astype(np.float64)
    shown = -expm1(-policy.density_scale * softplus(density) * cell)
    kept = np.flatnonzero(shown > opacity)
    tree, row, order = tree_of_cells(field.active.voxels[kept], field.active.shape, field.box)
    source = kept[order]
    own = field.params["sh"].shape[1]
    count = own if degree is None else sh.count(degree)
    coefficients = np.zeros((len(source), count, 3))
    shared = min(own, count)
    coefficients[:, :shared] = field.params["sh"][source, :shared]
    return Leaves(tree, row, density[source], coefficients)


def tree_of_cells(
    cells: NDArray[np.integer[Any]], shape: tuple[int, int, int], box: Array
) -> tuple[Octree, NDArray[np.int32], NDArray[np.int64]]:
    """A tree with a smallest leaf for each of some cells, and large empty ones between them.

    Args:
        cells: (N, 3) which ones, in any order.
        shape: cells along each edge of the box.
        box: (2, 3) in meters.

    Returns:
        The tree; the row (L,) of each leaf, -1 for empty ones; and (N,) the cell of each row.
    """
    label = np.full(shape, -1.0)
    i, j, k = cells.T
    label[i, j, k] = np.arange(len(cells))
    tree = Octree.from_dense(label[..., None], box, background=-1.0)
    source = tree.values[:, 0].astype(np.int64)
    occupied = source >= 0
    row = np.where(occupied, np.cumsum(occupied) - 1, -1).astype(np.int32)
    return tree, row, source[occupied]
