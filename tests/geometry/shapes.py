"""Small meshes, rays and a brute-force oracle."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from photograd_course.random import uniform

Array = npt.NDArray[Any]


def bumpy_sphere(rings: int = 24, columns: int = 40) -> tuple[Array, Array]:
    """Closed mesh (V, 3), (F, 3) around the origin, radius about 1, outside counter-clockwise."""
    theta = np.pi * np.arange(1, rings) / rings
    phi = 2.0 * np.pi * np.arange(columns) / columns
    t, p = (x.ravel() for x in np.meshgrid(theta, phi, indexing="ij"))
    r = 1.0 + 0.1 * np.sin(4 * p) * np.sin(3 * t)
    around = np.stack([np.sin(t) * np.cos(p), np.cos(t), np.sin(t) * np.sin(p)], -1) * r[:, None]
    vertices = np.concatenate([around, [[0, 1.0, 0], [0, -1.0, 0]]]).astype(np.float32)
    north, south = len(vertices) - 2, len(vertices) - 1
    faces = []
    for c in range(columns):
        e = (c + 1) % columns
        faces.append([north, e, c])
        for ring in range(rings - 2):
            a, b = ring * columns + c, ring * columns + e
            faces += [[a, b, a + columns], [b, b + columns, a + columns]]
        last = (rings - 2) * columns
        faces.append([south, last + c, last + e])
    return vertices, np.array(faces, np.uint32)


def random_rays(count: int, *, seed: int, spread: float = 1.5) -> tuple[Array, Array]:
    """Origins (R, 3) in a cube of half width `spread` and unit directions (R, 3), float64."""
    row = np.arange(count)[:, None]
    u = uniform(seed, pixel=row, dimension=np.arange(6))
    directions = u[:, 3:] - 0.5
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return spread * (2.0 * u[:, :3] - 1.0), directions


def brute_force(
    corners: Array, origins: Array, directions: Array, t_max: float = np.inf
) -> tuple[Array, Array]:
    """Nearest t (R,) and triangle (R,) or -1 by Cramer's rule on all pairs; corners (F, 3, 3)."""
    a, ab, ac = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    best_t, best_f = np.full(len(origins), np.inf), np.full(len(origins), -1)
    for r, (o, d) in enumerate(zip(origins, directions, strict=True)):
        p, q = np.cross(d, ac), np.cross(o - a, ab)
        with np.errstate(divide="ignore", invalid="ignore"):
            scale = 1.0 / (ab * p).sum(1)
            u, v = ((o - a) * p).sum(1) * scale, (d * q).sum(1) * scale
            t = (ac * q).sum(1) * scale
        inside = (u >= 0) & (v >= 0) & (u + v <= 1) & (t >= 0) & (t <= t_max)
        t = np.where(inside, t, np.inf)
        f = int(np.argmin(t))
        if np.isfinite(t[f]):
            best_t[r], best_f[r] = t[f], f
    return best_t, best_f


def camera_rays(size: int, *, distance: float = 3.0) -> tuple[Array, Array]:
    """Rays of a pinhole on +Z looking at the origin, row by row, float64."""
    x = (np.arange(size) + 0.5) / size * 2 - 1
    right, up = np.meshgrid(x, -x)
    directions = np.stack([0.5 * right, 0.5 * up, -np.ones_like(up)], -1).reshape(-1, 3)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return np.broadcast_to([0.0, 0.0, distance], directions.shape).copy(), directions
