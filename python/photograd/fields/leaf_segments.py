"""The leaves of an octree that rays pass through, and how their borders move with a ray."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from photograd.grids.octree import Octree
from photograd.types import Array


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

    def waves(self) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
        """(rays, pieces): the first piece of each ray that has one, then the second, ..."""
        rays = np.flatnonzero(self.count > 0)
        k = 0
        while len(rays):
            yield rays, self.first[rays] + k
            k += 1
            rays = rays[self.count[rays] > k]


def segments_of(borders: Borders, row: NDArray[np.int32]) -> Segments:
    """Trace the rays; leaves with row -1 are passed over."""
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
        place = segments.ray * 3 + axis
        size = d_origins.size
        d_origins += np.bincount(place, pull, size).reshape(d_origins.shape)
        moved = pull * times[m, axis]
        d_directions += np.bincount(place, moved, size).reshape(d_origins.shape)
    return d_origins, d_directions
