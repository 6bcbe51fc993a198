"""Normals of a mesh at its vertices."""

from __future__ import annotations

import numpy as np

from photograd.types import Array, FloatArray


def vertex_normals(vertices: FloatArray, faces: Array) -> FloatArray:
    """(V, 3) sums of the normals of the faces at each vertex, each as long as twice its area.

    Args:
        vertices: (V, 3).
        faces: (F, 3), counter-clockwise seen from outside.
    """
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    total = np.zeros_like(vertices)
    for k in range(3):
        np.add.at(total, faces[:, k], normals)
    return total
