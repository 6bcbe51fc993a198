"""The leaves of an octree of harmonics: where they come from, and the rays that pass through them.

Where a voxel is too transparent to be seen, the tree stays empty; everywhere else the field's
values at the voxel's center are those of a leaf. A step function then stands for a trilinear one,
and what that loses is what fine-tuning the leaves brings back.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd_course.portable_math import exp, expm1, log, log1p, sigmoid, softplus

from photograd import sh
from photograd._checks import require_bounds
from photograd.errors import RangeError, message
from photograd.fields.dense_grid import DenseGrid
from photograd.fields.sparse_sh import SparseSh
from photograd.grids.octree import Octree
from photograd.representation import Outputs
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


# The leaves of an octree that rays pass through, and how their borders move with a ray.


@dataclass(frozen=True)
class Borders:
    """A tree and the rays (R, 3) that cross its leaves."""

    tree: Octree
    origins: Array
    directions: Array


@dataclass(frozen=True)
class Segments:
    """M pieces of rays in leaves that have a row, those of a ray in the order of t.

    `first` (R,) and `count` (R,) say where the pieces of each ray stand.
    """

    ray: NDArray[np.int64]  # (M,)
    leaf: NDArray[np.int32]  # (M,)
    row: NDArray[np.int32]  # (M,)
    t0: Array  # (M,) in lengths of the ray's direction
    t1: Array  # (M,)
    first: NDArray[np.int64]
    count: NDArray[np.int64]

    @property
    def middle(self) -> Array:
        """(M,) halfway between t0 and t1."""
        halfway: Array = (self.t0 + self.t1) / 2
        return halfway

    def batches(self) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
        """(rays, pieces): the first piece of each ray that has one, then the second, ..."""
        rays = np.flatnonzero(self.count > 0)
        k = 0
        while len(rays):
            yield rays, self.first[rays] + k
            k += 1
            rays = rays[self.count[rays] > k]


def segments_of(borders: Borders, row: NDArray[np.int32]) -> Segments:
    """Trace the rays; leaves with row -1 are passed over.

    Args:
        borders: of the leaves, and the rays.
        row: of each leaf.
    """
    visits = borders.tree.traverse(borders.origins, borders.directions)
    rays = len(borders.origins)
    ray = np.repeat(np.arange(rays), np.diff(visits.ray_offset))
    kept = row[visits.leaf] >= 0
    ray, leaf = ray[kept], visits.leaf[kept]
    count = np.bincount(ray, minlength=rays)
    first = np.cumsum(count) - count
    return Segments(ray, leaf, row[leaf], visits.t0[kept], visits.t1[kept], first, count)


def border_gradients(
    borders: Borders, segments: Segments, d_t0: Array, d_t1: Array
) -> tuple[Array, Array]:
    """dL/dorigins and dL/ddirections (R, 3) for dL/dt0 and dL/dt1 (M,) of the segments.

    A ray enters a box through the plane that it meets last of the three it comes towards, and
    leaves it through the first of the three others. A ray that begins inside of its first box
    enters it at t = 0, whatever the camera does.

    Args:
        borders: of the leaves, and the rays.
        segments: of the rays.
        d_t0: (M,).
        d_t1: (M,).
    """
    lower, side = borders.tree.leaf_boxes()
    cell = borders.tree.cell_size
    low = borders.tree.bounds[0] + lower[segments.leaf] * cell
    high = low + side[segments.leaf, None] * cell
    origin, direction = borders.origins[segments.ray], borders.directions[segments.ray]
    with np.errstate(divide="ignore", invalid="ignore"):
        planes = np.stack([(low - origin) / direction, (high - origin) / direction])
    enter = np.where(direction == 0, -np.inf, planes.min(axis=0))
    leave = np.where(direction == 0, np.inf, planes.max(axis=0))
    d_origins = np.zeros(borders.origins.shape)
    d_directions = np.zeros(borders.origins.shape)
    for times, axis, d_t in (
        (enter, enter.argmax(axis=1), np.where(segments.t0 > 0, d_t0, 0.0)),
        (leave, leave.argmin(axis=1), d_t1),
    ):
        m = np.arange(len(axis))
        pull = -d_t / direction[m, axis]
        slot = segments.ray * 3 + axis
        size = d_origins.size
        d_origins += np.bincount(slot, pull, size).reshape(d_origins.shape)
        moved = pull * times[m, axis]
        d_directions += np.bincount(slot, moved, size).reshape(d_origins.shape)
    return d_origins, d_directions


# Compositing the segments of all rays, front to back.


@dataclass(frozen=True)
class Walk:
    """What compositing leaves for each segment (M,), and for each ray (R,)."""

    weight: Array  # w_k
    behind: Array  # transmittance behind the segment
    visible: NDArray[np.bool_]  # in front of where the ray was stopped
    transmittance: Array  # (R,) behind the last segment


def composite(segments: Segments, s: Array, rays: int, stop: float) -> Walk:
    """Front to back, the k-th segments of all rays at a time.

    A ray of which less than `stop` is left meets nothing any more.

    Args:
        segments: of the rays.
        s: (M,) optical depths.
        rays: R.
        stop: see above.
    """
    tau, transmittance = np.zeros(rays, s.dtype), np.ones(rays, s.dtype)
    weight, behind, visible = np.zeros_like(s), np.zeros_like(s), np.zeros(len(s), np.bool_)
    for ray, m in segments.batches():
        front = transmittance[ray]
        visible[m] = front > stop
        thick = s[m] * visible[m]
        weight[m] = front * -expm1(-thick)
        tau[ray] += thick
        behind[m] = transmittance[ray] = exp(-tau[ray])
    return Walk(weight, behind, visible, transmittance)


def optical_depth_backward(
    segments: Segments, walk: Walk, v: Array, outputs: Outputs, d_outputs: Outputs
) -> Array:
    """d_s (M,), front to back again; `v` is <d_color, rgb> + d_depth (t0 + t1) / 2.

    Args:
        segments: of the rays.
        walk: what `composite` returned.
        v: (M,).
        outputs: of the rendering.
        d_outputs: dL/d of these.
    """
    kind = v.dtype
    left = (np.asarray(d_outputs.color, kind) * outputs.color).sum(axis=1)
    if d_outputs.depth is not None:
        left += np.asarray(d_outputs.depth, kind) * outputs.depth
    end = np.zeros_like(left)
    if d_outputs.opacity is not None:
        end += np.asarray(d_outputs.opacity, kind) * walk.transmittance
    passed = walk.weight * v
    d_s = np.zeros_like(v)
    for ray, m in segments.batches():
        left[ray] -= passed[m]
        d_s[m] = (walk.behind[m] * v[m] - left[ray] + end[ray]) * walk.visible[m]
    return d_s


def sums(owner: NDArray[np.integer[Any]], values: Array, count: int) -> Array:
    """Sums of `values` by owner, in their order.

    Args:
        owner: (M,) numbers below `count`.
        values: (M, ...).
        count: of owners.
    """
    return np.bincount(owner, values, minlength=count)
