"""A sphere whose faces fill the whole square of a texture: an octahedron, folded open [Praun2003].

A point (a, b) of [-1, 1]^2 with y = 1 - |a| - |b| lies on the octahedron at (a, y, b) if y >= 0,
else at ((1 - |b|) sgn a, y, (1 - |a|) sgn b). The two halves of each border of the square are one
edge of the lower half, cut open.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd.types import FloatArray

Numbers = npt.NDArray[np.uint32]


def unwrapped_sphere(divisions: int) -> tuple[FloatArray, FloatArray, Numbers, Numbers]:
    """A unit sphere of 8 n^2 triangles.

    Args:
        divisions: n, of each edge of the octahedron, 2 to 4096.

    Returns:
        Vertices (V, 3), texture coordinates uv (T, 2) in [0, 1], faces (F, 3) as numbers of these,
        and the vertex (T,) that has them.

    Raises:
        DtypeError, RangeError: divisions out of range.
    """
    n = Arguments("unwrapped_sphere").integer("divisions", divisions, low=2, high=4096)
    row, column = (grid.reshape(-1) for grid in np.mgrid[-n : n + 1, -n : n + 1])
    # Whole numbers, so that corners of one vertex agree to the bit.
    up = n - abs(column) - abs(row)
    x = np.where(up >= 0, column, (n - abs(row)) * np.sign(column))
    z = np.where(up >= 0, row, (n - abs(column)) * np.sign(row))
    points, vertex = np.unique(np.stack([x, up, z], axis=1), axis=0, return_inverse=True)
    length = np.sqrt(np.square(points).sum(axis=1, keepdims=True))
    uv = np.stack([column + n, row + n], axis=1) / (2 * n)
    corners = _triangles(n)
    return points / length, uv, corners, vertex.reshape(-1).astype(np.uint32)


def _triangles(n: int) -> Numbers:
    """(F, 3) numbers of texture coordinates; squares are cut along the edges of the octahedron."""
    row, column = (grid.reshape(-1) for grid in np.mgrid[0 : 2 * n, 0 : 2 * n])
    first = row * (2 * n + 1) + column
    a, b, c, d = first, first + 1, first + 2 * n + 2, first + 2 * n + 1
    descending = (row < n) != (column < n)  # the cut runs from a to c
    one = np.where(descending[:, None], np.stack([a, c, b], axis=1), np.stack([a, d, b], axis=1))
    two = np.where(descending[:, None], np.stack([a, d, c], axis=1), np.stack([b, d, c], axis=1))
    return np.concatenate([one, two]).astype(np.uint32)
