"""What makes a mesh a solid: no gaps, one side, a volume."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from photograd.scenes.surface import Surface

Array = npt.NDArray[np.float64]


def open_edges(surfaces: Sequence[Surface]) -> int:
    """Directed edges without exactly one partner, vertices of equal float32 position taken as one.

    On a closed, consistently turned surface every directed edge occurs once, and so does its
    reverse.
    """
    vertices = np.concatenate([surface.vertices for surface in surfaces]).astype(np.float32)
    starts = np.cumsum([0, *[len(surface.vertices) for surface in surfaces]])
    faces = np.concatenate([s.faces + start for s, start in zip(surfaces, starts, strict=False)])
    same = np.zeros(len(vertices), dtype=np.int64)
    for column in vertices.T:
        ranks = np.unique(column, return_inverse=True)[1]
        same = np.unique(same * len(vertices) + ranks, return_inverse=True)[1]
    faces = same[faces]
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    count = len(vertices)
    forward, counts = np.unique(edges[:, 0] * count + edges[:, 1], return_counts=True)
    backward = np.unique(edges[:, 1] * count + edges[:, 0])
    return int((counts != 1).sum() + len(np.setxor1d(forward, backward)))


def volume(surface: Surface) -> float:
    """Enclosed volume by the divergence theorem: positive if counter-clockwise from outside."""
    a, b, c = (surface.vertices[surface.faces[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def uv_turn(surface: Surface) -> Array:
    """Twice the signed area of each triangle in (u, -v): positive where a texture is not mirrored.

    u runs right and v down, so that (u, -v) is right-handed as seen from outside.
    """
    a, b, c = (surface.uv[surface.faces[:, k]] * [1.0, -1.0] for k in range(3))
    first, second = b - a, c - a
    turn: Array = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    return turn
