"""Rectangles and boxes as triangle meshes."""

from __future__ import annotations

from typing import Any

import numpy as np

from photograd.errors import RangeError, message
from photograd.transport.scene import MeshShape
from photograd.types import Array


def rectangle(
    name: str, corner: Any, edge_u: Any, edge_v: Any, material: str, emission: Any = (0, 0, 0)
) -> MeshShape:
    """A parallelogram of two triangles; its front is the side of edge_u x edge_v.

    A texture stands upright on the front: u grows along edge_u, v against edge_v.

    Args:
        name, material, emission: as for `MeshShape`.
        corner: (3,) metres.
        edge_u, edge_v: (3,) from the corner to its neighbours.
    """
    start, u, v = (np.asarray(x, np.float64) for x in (corner, edge_u, edge_v))
    vertices = np.array([start, start + u, start + u + v, start + v])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    uv = np.array([[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]])
    return MeshShape(name, vertices, faces, material, np.asarray(emission, np.float64), uv=uv)


def box(
    name: str, center: Any, size: Any, material: str, emission: Any = (0, 0, 0), *,
    turn: float = 0.0, inward: bool = False,
) -> MeshShape:  # fmt: skip
    """A closed box of twelve triangles.

    Args:
        name, material, emission: as for `MeshShape`.
        center, size: (3,) metres.
        turn: degrees around +Y, counter-clockwise seen from above.
        inward: whether the inside is the front: a room.

    Raises:
        RangeError: a size that is not positive.
    """
    extent = np.asarray(size, np.float64)
    if extent.shape != (3,) or not bool((extent > 0).all()):
        raise RangeError(message("box", f"{name}.size", "three lengths above 0 m", size))
    corners = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
    angle = np.radians(turn)
    c, s = np.cos(angle), np.sin(angle)
    world_from_object = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    vertices = (0.5 * corners * extent) @ world_from_object.T + np.asarray(center, np.float64)
    faces: Array = np.array(
        [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
         [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    )  # fmt: skip
    if inward:
        faces = faces[:, ::-1]
    return MeshShape(name, vertices, faces, material, np.asarray(emission, np.float64))
