"""A sphere of nearly equal triangles: an icosahedron, each face divided, on the unit sphere."""

from __future__ import annotations

import math

import numpy as np

from photograd._arrays import Arguments
from photograd.geometry.mesh import Mesh
from photograd.types import FloatArray

GOLDEN = (1 + math.sqrt(5)) / 2
FACES = (
    *((0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11)),
    *((1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8)),
    *((3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9)),
    *((4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)),
)


def icosphere(divisions: int) -> Mesh:
    """A unit sphere about the origin: 10 n² + 2 vertices, 20 n² faces, n = `divisions`.

    Args:
        divisions: parts of each edge of the icosahedron, 1 to 1000.

    Raises:
        DtypeError, RangeError: another number.
    """
    n = Arguments("icosphere").integer("divisions", divisions, low=1, high=1000)
    number: dict[tuple[int, int], int] = {}  # of the points (i, j) of a face, i + j <= n
    for i in range(n + 1):
        for j in range(n + 1 - i):
            number[i, j] = len(number)
    weights = np.array([(n - i - j, i, j) for i, j in number])
    small = [(number[i, j], number[i + 1, j], number[i, j + 1]) for i, j in number if i + j < n]
    small += [
        (number[i + 1, j], number[i + 1, j + 1], number[i, j + 1])
        for i, j in number
        if i + j < n - 1
    ]
    # Points on an edge belong to two faces: equal weights of the twelve corners are one vertex.
    points = np.zeros((20, len(weights), 12), np.int64)
    for row, corners in zip(points, FACES, strict=True):
        row[:, corners] = weights
    unique, which = np.unique(points.reshape(-1, 12), axis=0, return_inverse=True)
    faces = which.reshape(20, -1)[:, np.array(small)].reshape(-1, 3)
    positions = np.einsum("vc,cd->vd", unique.astype(np.float64), _corners())
    return Mesh(positions / np.linalg.norm(positions, axis=1, keepdims=True), faces)


def _corners() -> FloatArray:
    """(12, 3) of the icosahedron."""
    flat = [(-1.0, GOLDEN), (1.0, GOLDEN), (-1.0, -GOLDEN), (1.0, -GOLDEN)]
    rows = [(a, b, 0.0) for a, b in flat]
    rows += [(0.0, a, b) for a, b in flat]
    rows += [(b, 0.0, a) for a, b in flat]
    return np.array(rows)
