"""What is nearer to an eye: polygons in an order to paint them in, objects by distance.

Sorting triangles by distance fails where they overlap in a circle or pierce each other. A binary
space partition cuts them until an order exists, once for all eyes
(cpp/photograd/geometry/reference/bsp.h).

Objects are sorted by the stable radix sort that puts Gaussians in order
(cpp/photograd/splat/sort.h).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.geometry.mesh import Mesh
from photograd.types import Array


@typed_call
class BspTree:
    """A partition of space by the planes of triangles.

    Attributes:
        points: (Q, 3) corners of all polygons, one polygon after another.
        begin: (P + 1,) polygon p has the corners points[begin[p] : begin[p + 1]].
        face: (P,) int32, the triangle that it is a part of.
        planes: (N, 4) unit normal and offset of each node; in front is <n, p> > offset.
        front, back: (N,) int32 children, -1 where there is nothing.
        first, count: (N,) int32, the polygons in the node's plane.
        depth: (N,) int32, 0 at the root.
    """

    def __init__(self, mesh: Mesh, *, candidates: int = 8, max_polygons: int = 1_000_000) -> None:
        """Cut the mesh.

        Args:
            mesh: its triangles may pierce each other.
            candidates: how many polygons of a list are tried for its plane; the one that cuts few
                others and halves the list is taken.
            max_polygons: an error where more are made; n triangles can fall into n^2 parts.

        Raises:
            SceneError: as `photograd.geometry.mesh.Bvh`: no triangle, no number, no area.
            RangeError: an option below 1, or more polygons than allowed.
        """
        self._core = Arguments("BspTree").run(
            _core.BspTree, mesh.vertices, mesh.faces, candidates, max_polygons
        )
        self.points, self.begin, self.face = self._core.polygons()
        self.planes, links = self._core.nodes()
        self.front, self.back, self.first, self.count, self.depth = links.T

    def polygons(self) -> list[Array]:
        """The corners (K, 3) of each polygon, in the order of the triangle it comes from."""
        return np.split(self.points, self.begin[1:-1])

    def back_to_front(self, eyes: Any) -> npt.NDArray[np.uint32]:
        """Polygon numbers (E, P) for each eye (E, 3): none hides a later one.

        Raises:
            ShapeError, RangeError: eyes that are not (E, 3), or not finite.
        """
        call = Arguments("BspTree.back_to_front", np.float64)
        order: npt.NDArray[np.uint32] = self._core.back_to_front(call.array("eyes", eyes, ("E", 3)))
        return order


# Things by their distance from an eye, for blending (far ones first) or early tests (near ones).


@typed_call
def order_by_distance(points: Any, eye: Any, *, far_first: bool = False) -> npt.NDArray[np.uint32]:
    """Row numbers (N,) of points (N, 3), sorted by their distance from `eye` (3,).

    Equally distant points keep the order of their rows, whichever end comes first.

    Raises:
        ShapeError: points that are not (N, 3), an eye that is not (3,).
        RangeError: numbers that are not finite.
    """
    call = Arguments("order_by_distance", np.float64)
    rows = call.array("points", points, ("N", 3))
    squared = ((rows - call.array("eye", eye, (3,))) ** 2).sum(axis=1)
    order: npt.NDArray[np.uint32] = _core.order_by_depth(squared, far_first)
    return order
