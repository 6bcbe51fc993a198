"""What one mesh shows, as the texture of another one that lies close to it.

A ray leaves each texel's point on the new mesh along the normal there, and one against it; what
the nearer hit shows is the color. Texels beside the faces take the color of the nearest that has
one, so that lookups and mip maps at the border of a chart see nothing else.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from photograd.fields.layered_picture import Unwrapped
from photograd.fields.surface import SurfaceField
from photograd.geometry.mesh import Bvh, Hits, Mesh
from photograd.geometry.normals import vertex_normals
from photograd.raster import interpolate, rasterize
from photograd.types import Array, FloatArray

REACH = 0.1
"""How far a ray looks, in extents of the mesh."""


def baked(
    vertices: FloatArray, unwrapped: Unwrapped, size: int, source: SurfaceField
) -> FloatArray:
    """A texture (size, size, 4) of display color and opacity, straight.

    Args:
        vertices: (V, 3) of the new mesh, meters.
        unwrapped: its faces in the texture.
        size: texels along each edge.
        source: the other mesh.
    """
    flat = np.concatenate([size * unwrapped.uv, np.ones((len(unwrapped.uv), 1))], axis=1)
    visibility = rasterize(flat, unwrapped.corners, (size, size))
    covered = visibility.covered
    rgba = np.full((size, size, 4), 0.5)
    rgba[..., 3] = 1.0
    if not covered.any():
        return rgba
    attributes = np.concatenate([vertices, vertex_normals(vertices, unwrapped.faces)], axis=1)
    at = interpolate(attributes[unwrapped.vertex], unwrapped.corners, visibility)[covered]
    colors, found = colors_nearby(at[:, :3], at[:, 3:], source)
    rgba[covered] = colors
    known = np.zeros((size, size), bool)
    known[covered] = found
    return spread(rgba, known)


def spread(rgba: FloatArray, known: Array) -> FloatArray:
    """A texture whose unknown texels take the mean of known neighbors, ring by ring.

    Args:
        rgba: (H, W, 4).
        known: (H, W) bool; where none is, `rgba` stays.
    """
    filled, known = np.where(known[..., None], rgba, 0.0), known.copy()
    height, width = known.shape
    while known.any() and not known.all():
        padded = np.pad(
            np.concatenate([filled, known[..., None]], axis=2), ((1, 1), (1, 1), (0, 0))
        )
        shifts = [(i, j) for i in (0, 1, 2) for j in (0, 1, 2)]
        total = np.stack([padded[i : i + height, j : j + width] for i, j in shifts]).sum(axis=0)
        ring = ~known & (total[..., 4] > 0)
        filled[ring] = total[ring][:, :4] / total[ring][:, 4:]
        known |= ring
    return filled if known.any() else rgba


def colors_nearby(
    points: FloatArray, normals: FloatArray, source: SurfaceField
) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
    """What a mesh shows (N, 4) where it is nearest along or against a normal; 0 where it is not.

    Args:
        points: (N, 3) meters.
        normals: (N, 3) of any length.
        source: the mesh.

    Returns:
        Display color and opacity (N, 4), straight, and whether (N,) the mesh was found.
    """
    face, weights, found = _nearest_along(points, normals, source.mesh)
    colors = np.zeros((len(points), 4))
    colors[found] = source.colors_at(face[found], weights[found])
    return colors, found


def _nearest_along(
    points: FloatArray, normals: FloatArray, source: Mesh
) -> tuple[Array, FloatArray, npt.NDArray[np.bool_]]:
    """Face (N,), barycentrics (N, 3), and whether there is one, along or against the normal."""
    length = np.sqrt(np.square(normals).sum(axis=1, keepdims=True))
    towards = normals / np.where(length > 0, length, 1.0)
    towards[length[:, 0] == 0] = [0.0, 1.0, 0.0]
    bvh = Bvh(source)
    extent = float(np.ptp(source.vertices, axis=0).max())
    back = 1e-4 * extent  # a point that lies on the source is found from either side
    best: dict[str, Any] = {}
    for sign in (1.0, -1.0):
        directions = np.ascontiguousarray(sign * towards)
        origins = np.ascontiguousarray(points - back * directions)
        hits = bvh.trace(origins, directions)
        t = np.where(hits.t <= REACH * extent, hits.t, np.inf)
        if not best:
            best = {"t": t, "face": hits.primitive.copy(), "b": _weights(hits)}
            continue
        nearer = t < best["t"]
        best["face"] = np.where(nearer, hits.primitive, best["face"])
        best["b"] = np.where(nearer[:, None], _weights(hits), best["b"])
        best["t"] = np.minimum(t, best["t"])
    return best["face"], best["b"], np.isfinite(best["t"])


def _weights(hits: Hits) -> FloatArray:
    """(N, 3) barycentrics."""
    pair = hits.barycentrics.astype(np.float64)
    return np.concatenate([1 - pair.sum(axis=1, keepdims=True), pair], axis=1)
