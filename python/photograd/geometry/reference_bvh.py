"""A bounding volume hierarchy that can be looked into, and what each ray costs in it.

Built by the surface area heuristic (cpp/photograd/geometry/reference/bvh_build.h) and walked with a
stack, one ray at a time (cpp/photograd/geometry/reference/bvh_walk.h). `photograd.Bvh` gives the
same answers many times faster; this one is there to be read, drawn and counted.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.geometry.checks import checked_interval, checked_rays
from photograd.geometry.mesh import Mesh
from photograd.types import Array


@typed_call
@dataclass(frozen=True, eq=False)
class BvhHits:
    """What R rays met, and what it cost to know.

    Attributes:
        t: (R,) distance in lengths of the direction; infinite where nothing was hit.
        primitive: (R,) int32 triangle, or -1.
        barycentrics: (R, 2) weights u, v of the triangle's second and third corner.
        boxes, triangles: (R,) int32, how many were tested.
    """

    t: Array
    primitive: npt.NDArray[np.int32]
    barycentrics: Array
    boxes: npt.NDArray[np.int32]
    triangles: npt.NDArray[np.int32]

    @property
    def hit(self) -> npt.NDArray[np.bool_]:
        """(R,) whether anything was hit."""
        return self.primitive >= 0


@typed_call
class ReferenceBvh:
    """A hierarchy of boxes over the triangles of one mesh.

    Attributes:
        boxes: (N, 2, 3) lower and upper corner of each node, the root first.
        first, count: (N,) a leaf holds the triangles order[first : first + count]; count is 0 in
            any other node.
        right: (N,) its second child; its first is the next node. -1 in leaves.
        depth: (N,) 0 at the root.
        order: (F,) triangle numbers, those of a leaf side by side.
    """

    def __init__(
        self, mesh: Mesh, *, leaf_size: int = 4, bins: int = 16, max_depth: int = 64
    ) -> None:
        """Build it.

        Args:
            mesh: what rays will meet.
            leaf_size: a larger leaf is divided even if the heuristic would not.
            bins: slices of an axis whose borders are tried, 2 to 256.
            max_depth: levels below the root, 0 to 64. What is left there stays in one leaf, as do
                triangles with one common centroid.

        Raises:
            SceneError: vertices that are not finite, vertex numbers out of range, triangles without
                area, no triangle.
            RangeError: an option out of range.
        """
        self._core = Arguments("ReferenceBvh").run(
            _core.ReferenceBvh, mesh.vertices, mesh.faces, leaf_size, bins, max_depth
        )
        self.boxes, links, self.order = self._core.nodes()
        self.first, self.count, self.right, self.depth = links.T

    def trace(
        self, origins: Any, directions: Any, t_min: float = 0.0, t_max: float = np.inf
    ) -> BvhHits:
        """Nearest hit of each ray within [t_min, t_max]; of several at one t, the first triangle.

        Args:
            origins, directions: (R, 3), taken as float64; directions of any length but 0.
            t_min, t_max: in lengths of the direction.

        Raises:
            ShapeError, RangeError: rays that are none.
        """
        return self._traced("trace", origins, directions, t_min, t_max, False)

    def any_hit(
        self, origins: Any, directions: Any, t_min: float = 0.0, t_max: float = np.inf
    ) -> BvhHits:
        """As `trace`, but the first hit that is found, which need not be the nearest."""
        return self._traced("any_hit", origins, directions, t_min, t_max, True)

    def trace_all(
        self, origins: Any, directions: Any, t_min: float = 0.0, t_max: float = np.inf
    ) -> BvhHits:
        """As `trace`, without the hierarchy: every ray is tested against every triangle."""
        call = Arguments("ReferenceBvh.trace_all")
        rays = checked_rays(call, origins, directions)
        low, high = checked_interval(call, t_min, t_max)
        arrays = _room(len(rays[0]))
        self._core.trace_all(*rays, low, high, *arrays)
        return BvhHits(*arrays[:3], *arrays[3])

    def cost(self) -> float:
        """Tests that a random line through the root's box takes, as the heuristic expects it.

        The chance of meeting a node is its area over the root's; a node costs 1, a leaf its
        triangles as well [Goldsmith1987].
        """
        extent = self.boxes[:, 1] - self.boxes[:, 0]
        area = (extent * np.roll(extent, 1, axis=1)).sum(axis=1)
        return float((area * (1 + self.count)).sum() / area[0])

    def _traced(
        self, function: str, origins: Any, directions: Any, t_min: float, t_max: float, any_: bool
    ) -> BvhHits:
        call = Arguments(f"ReferenceBvh.{function}")
        rays = checked_rays(call, origins, directions)
        low, high = checked_interval(call, t_min, t_max)
        arrays = _room(len(rays[0]))
        self._core.trace(*rays, low, high, any_, *arrays)
        return BvhHits(*arrays[:3], *arrays[3])


def _room(count: int) -> tuple[Array, Array, Array, Array]:
    """Arrays for t (R,), primitive (R,), barycentrics (R, 2) and visits (2, R)."""
    return (
        np.empty(count),
        np.empty(count, np.int32),
        np.empty((count, 2)),
        np.empty((2, count), np.int32),
    )
