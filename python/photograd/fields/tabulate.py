"""A field of networks, read into the leaves of an octree: the conversion of PlenOctrees [Yu2021].

1. In each cell of a grid over the field's box, extinction is read at a few points; what is too
   transparent to be visible stays empty.
2. Of the others, those stay that have a weight in some pixel of some photograph.
3. In these, color is read at the points in many directions, and projected onto spherical harmonics
   of raw color (before the sigmoid); the points count as much as their opacity.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd_course.portable_math import cos, expm1, log, sin
from photograd_course.random import uniform

from photograd import sh
from photograd._compiled import _core
from photograd.fields.neural_field import NeuralField
from photograd.fields.octree_leaves import Leaves, tree_of_cells
from photograd.types import Array

Radiance = Callable[[Array, Array], tuple[Array, Array]]
"""(points (N, 3) in meters, directions (N, 3)) -> extinction (N,) in 1/m, linear color (N, 3)."""

POINTS = 4
"""In a cell, at random places that are the same for every cell of the same number."""
HEIGHTS = (0.8611363115940526, 0.3399810435848563)
"""Gauss nodes for polynomials of degree 7 on [-1, 1]: these, and their negatives."""
HEIGHT_WEIGHTS = (0.3478548451374538, 0.6521451548625461)
TURNS = 8
"""Directions at each height. Products of harmonics of degree 3 are integrated exactly."""
AT_ONCE = 1 << 20
DARKEST, BRIGHTEST = 1e-3, 1 - 1e-3
"""Color before it is projected: raw values of pure black and white are infinite."""


@dataclass(frozen=True)
class Cells:
    """Cells of a box that are visible: which (N, 3), and extinction (N, S) at points of each."""

    box: Array
    shape: tuple[int, int, int]
    index: NDArray[np.int64]
    sigma_t: Array

    @property
    def edge(self) -> float:
        """Of a cell, in meters."""
        return float((self.box[1, 0] - self.box[0, 0]) / self.shape[0])

    def kept(self, those: NDArray[np.bool_]) -> Cells:
        """Some of them.

        Args:
            those: (N,).
        """
        return Cells(self.box, self.shape, self.index[those], self.sigma_t[those])


def radiance_of(field: NeuralField, dt: float) -> Radiance:
    """What a march through a field of networks finds at single points.

    Args:
        field: of networks; in its empty cells extinction is 0.
        dt: step of the march in meters; extinction above about 69 / dt is cut off.
    """
    march = replace(field.policy, dt=dt).settings(0.0)
    kind, cells = field.params["density"].dtype, field.occupied()

    def radiance(points: Array, directions: Array) -> tuple[Array, Array]:
        origins, along = (np.ascontiguousarray(a, kind) for a in (points, directions))
        first = np.full(len(origins), -0.5 * dt, kind)  # the first sample lies half a step on
        rays = origins, along, first, np.ones(len(origins), np.int32)
        of_field = field._settings, field._arrays(), cells
        color, through, _ = _core.march_neural(*of_field, march, rays)
        rgb = color / np.maximum(1 - through, 1e-12)[:, None]
        return -log(np.maximum(through, 1e-30)) / dt, rgb

    return radiance


def points_in(
    box: Array, shape: tuple[int, int, int], index: NDArray[np.int64], sample: int
) -> Array:
    """(N, 3) a random point in each of some cells, in meters, float64.

    Args:
        box: (2, 3) in meters.
        shape: cells along each edge of the box.
        index: (N, 3) which cells.
        sample: number of the point in its cell.
    """
    number = np.ravel_multi_index(tuple(index.T), shape)
    u = [uniform(0, step=0, pixel=number, sample=sample, dimension=k) for k in range(3)]
    points: Array = box[0] + (index + np.stack(u, axis=1)) * ((box[1] - box[0]) / shape)
    return points


def cells_in_reach(
    field: NeuralField, box: Array, shape: tuple[int, int, int]
) -> NDArray[np.bool_] | None:
    """(X, Y, Z) which cells touch one that the field's occupancy marks; None for all.

    In the others extinction is 0 wherever it is read.

    Args:
        field: of networks.
        box: (2, 3) in meters, of the cells.
        shape: cells along each edge of the box.
    """
    occupied = field.occupied()
    if occupied is None:
        return None
    lower, upper = field.box
    touched: NDArray[np.bool_] = occupied.transpose(2, 1, 0) > 0  # [x, y, z]
    for axis, (cells, marked) in enumerate(zip(shape, touched.shape, strict=True)):
        edges = box[0, axis] + np.arange(cells + 1) * ((box[1, axis] - box[0, axis]) / cells)
        at = (edges - lower[axis]) / (upper[axis] - lower[axis]) * marked
        slack = 1e-4  # a point is rounded to float32 before its cell is looked up
        first = np.clip(np.floor(at[:-1] - slack), 0, marked - 1).astype(np.int64)
        last = np.clip(np.floor(at[1:] + slack), 0, marked - 1).astype(np.int64)
        known = np.insert(np.cumsum(touched, axis=axis), 0, 0, axis=axis)
        counts = known.take(last + 1, axis=axis) - known.take(first, axis=axis)
        touched = counts > 0
    return touched


def visible_cells(
    radiance: Radiance,
    box: Array,
    shape: tuple[int, int, int],
    *,
    opacity: float,
    reach: NDArray[np.bool_] | None = None,
) -> Cells:
    """The cells that are more opaque than `opacity` along their edge, at the mean of their points.

    Args:
        radiance: of the field.
        box: (2, 3) in meters.
        shape: cells along each edge of the box.
        opacity: see above.
        reach: (X, Y, Z) which cells are looked at; None for all.
    """
    edge = (box[1, 0] - box[0, 0]) / shape[0]
    found, values = [], []
    numbers = np.arange(np.prod(shape)) if reach is None else np.flatnonzero(reach)
    for first in range(0, len(numbers), AT_ONCE):
        index = np.stack(np.unravel_index(numbers[first : first + AT_ONCE], shape), axis=1)
        along = np.tile([0.0, 0.0, 1.0], (len(index), 1))
        sigma_t = np.stack(
            [radiance(points_in(box, shape, index, s), along)[0] for s in range(POINTS)], axis=1
        )
        visible = -expm1(-edge * sigma_t.mean(axis=1, dtype=np.float64)) > opacity
        found.append(index[visible])
        values.append(sigma_t[visible])
    if not found:
        return Cells(box, shape, np.zeros((0, 3), np.int64), np.zeros((0, POINTS)))
    return Cells(box, shape, np.concatenate(found), np.concatenate(values))


def projected_colors(radiance: Radiance, cells: Cells, *, degree: int) -> Array:
    """Coefficients (N, K, 3) of raw color: the mean over the points of a cell.

    Args:
        radiance: of the field.
        cells: where it is read.
        degree: of the harmonics.
    """
    directions, weight = directions_around()
    dual = (sh.basis(directions, degree) * weight[:, None]).T  # (K, D)
    count = len(directions)
    share = -expm1(-cells.edge * cells.sigma_t.astype(np.float64)) + 1e-9
    share /= share.sum(axis=1, keepdims=True)
    coefficients = np.zeros((len(cells.index), sh.count(degree), 3))
    step = max(1, AT_ONCE // count)
    for first in range(0, len(cells.index), step):
        some = slice(first, first + step)
        for sample in range(POINTS):
            points = points_in(cells.box, cells.shape, cells.index[some], sample)
            _, rgb = radiance(points.repeat(count, axis=0), np.tile(directions, (len(points), 1)))
            known = np.clip(rgb.astype(np.float64), DARKEST, BRIGHTEST)
            raw = log(known / (1 - known)).reshape(len(points), count, 3)
            fitted = np.einsum("kd,ndc->nkc", dual, raw)
            coefficients[some] += share[some, sample, None, None] * fitted
    return coefficients


def directions_around() -> tuple[Array, Array]:
    """Unit vectors (D, 3) all around, and their quadrature weights (D,) in sr."""
    z = np.array([*HEIGHTS, *(-h for h in HEIGHTS)]).repeat(TURNS)
    around = np.array(2 * HEIGHT_WEIGHTS).repeat(TURNS)
    turn = np.tile((np.arange(TURNS) + 0.5) * (2 * np.pi / TURNS), 4)
    radius = np.sqrt(1 - z * z)
    directions = np.stack([radius * cos(turn), radius * sin(turn), z], axis=1)
    return directions, around * (2 * np.pi / TURNS)


def tabulated(
    radiance: Radiance,
    box: Array,
    shape: tuple[int, int, int],
    *,
    degree: int,
    opacity: float,
    weights: Callable[[Leaves], Array],
    least: float,
    reach: NDArray[np.bool_] | None = None,
) -> Leaves:
    """The leaves of a field; raw densities are of a density scale of 1 / edge of a cell.

    Args:
        radiance: of the field.
        box: (2, 3) in meters.
        shape: cells along each edge of the box.
        degree: of the harmonics.
        opacity: of a cell that is not empty, see `visible_cells`.
        weights: the greatest weight (N,) that each row of a tree has in any pixel.
        least: weight of a leaf that stays.
        reach: (X, Y, Z) outside of which the field is empty; None for nowhere.
    """
    cells = visible_cells(radiance, box, shape, opacity=opacity, reach=reach)
    bare = np.zeros((len(cells.index), 1, 3))
    leaves, order = _leaves(cells, bare)
    cells = cells.kept(_scattered(weights(leaves) >= least, order))
    return _leaves(cells, projected_colors(radiance, cells, degree=degree))[0]


def _leaves(cells: Cells, coefficients: Array) -> tuple[Leaves, NDArray[np.int64]]:
    tree, row, order = tree_of_cells(cells.index, cells.shape, cells.box)
    depth = np.minimum(cells.edge * cells.sigma_t.mean(axis=1, dtype=np.float64), 500.0)
    return Leaves(tree, row, log(expm1(depth[order])), coefficients[order]), order


def _scattered(values: NDArray[Any], order: NDArray[np.int64]) -> NDArray[Any]:
    back = np.empty_like(values)
    back[order] = values
    return back
