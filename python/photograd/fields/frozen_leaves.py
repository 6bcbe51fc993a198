"""From a field that is known to leaves that stay: what an octree of harmonics begins with.

Where a voxel is too transparent to be seen, the tree stays empty; everywhere else the field's
values at the voxel's centre are those of a leaf. A step function then stands for a trilinear one,
and what that loses is what fine-tuning the leaves brings back.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from photograd_course.portable_math import expm1, log, log1p, sigmoid, softplus

from photograd import sh
from photograd.errors import RangeError, message
from photograd.fields.dense_grid import DenseGrid
from photograd.fields.sparse_sh import SparseSh
from photograd.grids.octree import Octree
from photograd.types import Array

Corner = tuple[float, float, float]


@dataclass(frozen=True)
class TreePolicy:
    """Where a tree stands, and what its densities mean."""

    box: tuple[Corner, Corner]  # world, metres
    cells: tuple[int, int, int]  # along each edge of the box
    density_scale: float = 1.0  # 1/m

    def __post_init__(self) -> None:
        """Raises RangeError for a density scale that is not finite."""
        if not math.isfinite(self.density_scale):
            got = self.density_scale
            raise RangeError(message("TreePolicy", "density_scale", "a finite number", got))


@dataclass(frozen=True)
class Leaves:
    """A tree, the row (L,) of each of its leaves or -1, density (N,) raw and sh (N, K, 3)."""

    tree: Octree
    row: NDArray[np.int32]
    density: Array
    sh: Array


def leaves_of_grid(field: DenseGrid, *, degree: int, opacity: float, tolerance: float) -> Leaves:
    """See `OctreeSh.from_dense_grid`: voxels that are nearly equal share a larger leaf."""
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
    """See `OctreeSh.from_sparse_sh`: harmonics differ from voxel to voxel, so none share a leaf."""
    policy = field.policy
    if (policy.density_activation, policy.color_activation) != ("softplus", "sigmoid"):
        expected = "a field with density_activation 'softplus' and color_activation 'sigmoid'"
        got = f"{policy.density_activation!r} and {policy.color_activation!r}"
        raise RangeError(message("OctreeSh.from_sparse_sh", "field", expected, got))
    cell = (field.box[1, 0] - field.box[0, 0]) / field.active.shape[0]
    density = field.params["density"].astype(np.float64)
    shown = -expm1(-policy.density_scale * softplus(density) * cell)
    kept = np.flatnonzero(shown > opacity)
    label = np.full(field.active.shape, -1.0)
    i, j, k = field.active.voxels[kept].T
    label[i, j, k] = kept
    tree = Octree.from_dense(label[..., None], field.box, background=-1.0)
    source = tree.values[:, 0].astype(np.int64)
    occupied = source >= 0
    row = np.where(occupied, np.cumsum(occupied) - 1, -1).astype(np.int32)
    own = field.params["sh"].shape[1]
    count = own if degree is None else sh.count(degree)
    coefficients = np.zeros((int(occupied.sum()), count, 3))
    shared = min(own, count)
    coefficients[:, :shared] = field.params["sh"][source[occupied], :shared]
    return Leaves(tree, row, density[source[occupied]], coefficients)
