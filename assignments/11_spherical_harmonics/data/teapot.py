"""Photographs of a glazed teapot, by sphere tracing of signed distances; z is up.

The glaze has a matte color and a highlight of two lights, which moves with the viewer.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd_course.captures import all_around, rays_to_origin

Array = np.ndarray[Any, np.dtype[np.float64]]

GLAZE, TRIM = np.array([0.03, 0.22, 0.34]), np.array([0.85, 0.35, 0.06])
LIGHTS = (((0.35, -0.65, 0.68), 0.9), ((-0.7, 0.6, 0.35), 0.5))  # direction, strength
SHARPNESS = 7  # exponent of the highlight
TANGENT = 0.29  # of half the angle of view
SPOUT = ((0.36, -0.16, 0.13), (0.62, 0.04, 0.09), (0.84, 0.34, 0.06))  # x, z and radius


def photographs(views: int, size: int, turn: float = 0.0) -> tuple[Array, Array]:
    """(rays (2, R, 3), colors (R, 3)) of cameras all around; each the mean of 3 x 3 samples."""
    places = 3.2 * all_around(views, turn, top=0.85, span=1.15)
    fine = shaded(rays_to_origin(places, 3 * size, TANGENT)).reshape(views, size, 3, size, 3, 3)
    return rays_to_origin(places, size, TANGENT), fine.mean(axis=(2, 4)).reshape(-1, 3)


def _ellipsoid(p: Array, middle: tuple[float, ...], radii: tuple[float, ...]) -> Array:
    q = (p - np.array(middle)) / np.array(radii)
    return (np.linalg.norm(q, axis=-1) - 1) * min(radii)


def _cone(p: Array, a: tuple[float, ...], b: tuple[float, ...]) -> Array:
    """A rounded cone in the plane y = 0 between two points with their radii."""
    start, end = np.array([a[0], 0, a[1]]), np.array([b[0], 0, b[1]])
    way = end - start
    t = np.clip((p - start) @ way / (way @ way), 0, 1)
    return np.linalg.norm(p - start - t[..., None] * way, axis=-1) - a[2] - t * (b[2] - a[2])


def _distances(p: Array) -> Array:
    """(2, ...): distance from what is glazed, and from trim, lid knob and foot."""
    ring = np.hypot(np.hypot(p[..., 0] + 0.52, p[..., 2] - 0.04) - 0.25, p[..., 1])
    glazed = [
        _ellipsoid(p, (0.0, 0.0, -0.02), (0.53, 0.53, 0.42)),
        ring - 0.06,
        _cone(p, SPOUT[0], SPOUT[1]),
        _cone(p, SPOUT[1], SPOUT[2]),
        _ellipsoid(p, (0.0, 0.0, 0.33), (0.3, 0.3, 0.13)),
    ]
    trim = [
        np.linalg.norm(p - np.array([0.0, 0.0, 0.52]), axis=-1) - 0.1,
        _ellipsoid(p, (0.0, 0.0, -0.4), (0.34, 0.34, 0.06)),
    ]
    return np.stack([np.min(glazed, axis=0), np.min(trim, axis=0)])


def _nearest(p: Array) -> Array:
    """The distance from the teapot."""
    return np.min(_distances(p), axis=0)


def shaded(rays: Array) -> Array:
    """Colors (R, 3) of rays, before black."""
    origin, d = rays
    t = np.full(len(d), 2.0)
    for _ in range(60):
        t += 0.8 * _nearest(origin + t[:, None] * d)
    hit = _nearest(origin + t[:, None] * d) < 0.01
    p, d = (origin + t[:, None] * d)[hit], d[hit]
    near = _distances(p)
    steps = 1e-4 * np.eye(3)
    n = np.stack([_nearest(p + e) - _nearest(p - e) for e in steps], axis=1)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    paint = np.where((near[1] < near[0])[:, None], TRIM, GLAZE)
    color = 0.25 * paint * (1.2 + n[:, 2:])
    for direction, strength in LIGHTS:
        towards = np.array(direction) / np.linalg.norm(direction)
        mirrored = 2 * (n @ towards)[:, None] * n - towards
        shine = np.maximum(np.sum(mirrored * -d, axis=1), 0) ** SHARPNESS
        color += strength * np.maximum(n @ towards, 0)[:, None] * paint
        color += 0.75 * strength * (shine * (n @ towards > 0))[:, None]
    colors = np.zeros((len(hit), 3))
    colors[hit] = np.minimum(color, 1)
    return colors
