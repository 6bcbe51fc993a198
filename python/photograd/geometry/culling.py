"""Which objects may a camera see? An octree of their boxes answers for whole groups at once.

An object lies in the cell of its center, on the deepest level whose cells are as large as the
object: it may reach over the border, by half a cell at most. (In the smallest cell that contains
all of it, a small object across the middle of the world would lie in the root.) What is compared
with the camera's view is the box of all that lies in a cell and below.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from photograd_course.checks import require_integer, require_number

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.capture.frames import invert_rigid
from photograd.errors import RangeError, message
from photograd.types import Array


@typed_call
@dataclass(frozen=True, eq=False)
class Frustum:
    """What a camera sees: the points for which all six planes give at least 0.

    Attributes:
        planes: (6, 4) rows (n, d), in the world, of n . p + d: left, right, top, bottom, near, far.
    """

    planes: Array

    @classmethod
    def of_camera(cls, camera: Camera, near: float, far: float) -> Frustum:
        """The pyramid through the borders of the picture, between two depths in meters.

        A point in camera coordinates is right of the left border where (x / z) fx + cx >= 0, that
        is x + (cx / fx) z >= 0; the other borders are alike.

        Raises:
            RangeError: not 0 < near < far.
        """
        require_number("Frustum", "near", near, least=0.0, open_ends=True)
        require_number("Frustum", "far", far, least=near, open_ends=True)
        left, right = camera.cx / camera.fx, (camera.width - camera.cx) / camera.fx
        top, bottom = camera.cy / camera.fy, (camera.height - camera.cy) / camera.fy
        in_camera = np.array(
            [
                [1.0, 0.0, left, 0.0],
                [-1.0, 0.0, right, 0.0],
                [0.0, 1.0, top, 0.0],
                [0.0, -1.0, bottom, 0.0],
                [0.0, 0.0, 1.0, -near],
                [0.0, 0.0, -1.0, far],
            ]
        )
        return cls(in_camera @ invert_rigid(camera.world_from_camera))

    def misses(self, boxes: Array) -> npt.NDArray[np.bool_]:
        """(N,) whether boxes (N, 2, 3) lie wholly beyond one of the planes.

        The corner of a box that is farthest along n has n . center + |n| . half size. Boxes beside
        an edge of the frustum, beyond no single plane, are kept: a few too many, never too few.
        """
        normals, offsets = self.planes[:, :3].T, self.planes[:, 3]
        middle, half = 0.5 * (boxes[:, 0] + boxes[:, 1]), 0.5 * (boxes[:, 1] - boxes[:, 0])
        reach = half @ np.abs(normals)
        highest = middle @ normals + reach + offsets
        # Far more than the rounding of these sums: what touches a plane is kept.
        slack = 1e-12 * (np.abs(middle) @ np.abs(normals) + reach + np.abs(offsets))
        return np.asarray((highest < -slack).any(axis=1))


@dataclass(frozen=True, eq=False)
class Culled:
    """Which objects may be seen.

    Attributes:
        visible: (N,) False only for objects of which nothing can be seen.
        tested: boxes that were compared with the frustum, of nodes and of objects.
    """

    visible: npt.NDArray[np.bool_]
    tested: int


@typed_call
class CullingTree:
    """An octree over the boxes of N objects.

    Attributes:
        boxes: (N, 2, 3) float64, lower and upper corners in the world, m.
        node: (N,) in which node an object lies.
        node_boxes: (M, 2, 3) around everything in a node and below it; the root comes first, and
            every node after its parent.
        parent: (M,) -1 at the root.
        level: (M,) 0 at the root.
    """

    def __init__(self, boxes: Any, *, max_depth: int = 4) -> None:
        """Sort the objects into cells.

        Args:
            boxes: (N, 2, 3) with lower <= upper.
            max_depth: levels below the root, 0 to 16.

        Raises:
            ShapeError: not (N, 2, 3).
            RangeError: no object, a box that is none or not finite (named), a depth out of range.
        """
        self.boxes = _checked_boxes(boxes)
        require_integer("CullingTree", "max_depth", max_depth, least=0, most=16)
        level, cell = _cells(self.boxes, max_depth)
        # A row (level, x, y, z) for every cell in use and all cells above it.
        rows = [
            np.column_stack([np.full(len(level), k), cell >> (max_depth - k)])[level >= k]
            for k in range(max_depth + 1)
        ]
        keys = np.unique(np.concatenate(rows), axis=0)
        number = {tuple(key): i for i, key in enumerate(keys.tolist())}
        own = np.column_stack([level, cell >> (max_depth - level)[:, None]]).tolist()
        self.node = np.array([number[tuple(key)] for key in own])
        above = np.column_stack([keys[:, 0] - 1, keys[:, 1:] >> 1]).tolist()
        self.parent = np.array([number.get(tuple(key), -1) for key in above])
        self.level = keys[:, 0]
        self.node_boxes = np.empty((len(keys), 2, 3))
        self.node_boxes[:, 0], self.node_boxes[:, 1] = np.inf, -np.inf
        self._grow(self.node, self.boxes)
        for k in range(max_depth, 0, -1):
            here = np.flatnonzero(self.level == k)
            self._grow(self.parent[here], self.node_boxes[here])
        self._levels = [np.flatnonzero(self.level == k) for k in range(int(self.level.max()) + 1)]

    def cull(self, frustum: Frustum) -> Culled:
        """Walk down level by level; below a node that is missed, nothing is looked at."""
        visible = np.zeros(len(self.parent), np.bool_)
        tested = 0
        for nodes in self._levels:
            waiting = nodes[(self.parent[nodes] < 0) | visible[self.parent[nodes]]]
            tested += len(waiting)
            visible[waiting] = ~frustum.misses(self.node_boxes[waiting])
        left = np.flatnonzero(visible[self.node])
        visible = np.zeros(len(self.boxes), np.bool_)
        visible[left] = ~frustum.misses(self.boxes[left])
        return Culled(visible, tested + len(left))

    def _grow(self, nodes: Array, boxes: Array) -> None:
        """Make the boxes of nodes contain others, row by row."""
        np.minimum.at(self.node_boxes[:, 0], nodes, boxes[:, 0])
        np.maximum.at(self.node_boxes[:, 1], nodes, boxes[:, 1])


def _cells(boxes: Array, depth: int) -> tuple[Array, Array]:
    """Level (N,) of each object, and the finest cell (N, 3) in which its center lies."""
    low = boxes[:, 0].min(axis=0)
    side = max(float((boxes[:, 1].max(axis=0) - low).max()), 1e-300)
    size = np.maximum((boxes[:, 1] - boxes[:, 0]).max(axis=1), side * 2.0**-depth)
    level = np.floor(np.log2(side / size)).astype(np.int64).clip(0, depth)
    middle = 0.5 * (boxes[:, 0] + boxes[:, 1])
    cells = 1 << depth
    return level, np.clip(((middle - low) / side * cells).astype(np.int64), 0, cells - 1)


def _checked_boxes(boxes: Any) -> Array:
    call = Arguments("CullingTree", np.float64)
    rows = call.array("boxes", boxes, ("N", 2, 3), finite=False)
    if not len(rows):
        raise RangeError(message("CullingTree", "boxes", "at least one object", "none"))
    good = np.isfinite(rows).all(axis=(1, 2)) & (rows[:, 0] <= rows[:, 1]).all(axis=1)
    if not good.all():
        row = int(np.flatnonzero(~good)[0])
        got = f"{rows[row].tolist()} in row {row}"
        raise RangeError(message("CullingTree", "boxes", "finite, lower <= upper", got))
    return rows
