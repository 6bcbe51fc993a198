"""The point of a mesh that is nearest to a point."""

from __future__ import annotations

from typing import Any

import numpy as np

from photograd.geometry.checks import finite_rows
from photograd.geometry.mesh import Mesh
from photograd.types import Array


def nearest_on_mesh(points: Any, mesh: Mesh) -> tuple[Array, Array]:
    """Distances (N,) and nearest points (N, 3) of points (N, 3), by a look at every triangle.

    Where the foot of the perpendicular lies in the triangle, it is the nearest point; otherwise one
    of the three edges has it.

    Raises:
        ShapeError, RangeError: points that are not (N, 3) or not finite.
    """
    rows = finite_rows("nearest_on_mesh", "points", points)
    if not len(rows):
        return np.zeros(0), np.zeros((0, 3))
    corners = mesh.vertices.astype(np.float64)[mesh.faces]
    step = max(1, 100_000 // len(corners))  # pairs at a time: 2.4 MB a vector
    parts = [_nearest(rows[i : i + step], corners) for i in range(0, len(rows), step)]
    distance, place = (np.concatenate(part) for part in zip(*parts, strict=True))
    return distance, place


def _nearest(points: Array, corners: Array) -> tuple[Array, Array]:
    p = points[:, None]
    a, b, c = (corners[None, :, k] for k in range(3))
    candidates = [_on_segment(p, *edge) for edge in ((a, b), (b, c), (c, a))]
    ab, ac = b - a, c - a
    normal = np.cross(ab, ac)
    square = (normal**2).sum(axis=-1)
    v = (np.cross(p - a, ac) * normal).sum(axis=-1) / square  # weight of b
    w = (np.cross(ab, p - a) * normal).sum(axis=-1) / square  # weight of c
    foot = a + v[..., None] * ab + w[..., None] * ac
    inside = (v >= 0) & (w >= 0) & (v + w <= 1)
    candidates.append(np.where(inside[..., None], foot, np.inf))
    gaps = np.array([((q - p) ** 2).sum(axis=-1) for q in candidates])  # (4, N, F)
    least = gaps.swapaxes(0, 1).reshape(len(points), -1).argmin(axis=1)
    kind, face = np.divmod(least, len(corners))
    row = np.arange(len(points))
    place = np.array(candidates)[kind, row, face]
    return np.sqrt(gaps[kind, row, face]), place


def _on_segment(p: Array, a: Array, b: Array) -> Array:
    along = b - a
    share = ((p - a) * along).sum(axis=-1) / (along**2).sum(axis=-1)
    place: Array = a + share.clip(0.0, 1.0)[..., None] * along
    return place
