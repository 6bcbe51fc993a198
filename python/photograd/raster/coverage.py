"""The exact coverage of pixels by a polygon, and its adjoint: slow, and the measure of the others.

The coverage of a pixel is the area of the polygon within its square. A polygon is clipped by the
four sides of the square [Sutherland1974], and the shoelace formula gives the area. When the edge
from a to b moves, the area changes by the length of the edge within the square times its motion
along the outward normal: with t from t0 to t1 there, and n = (dy, -dx) of b - a = (dx, dy),

    d_a += g n ((t1 - t0) - (t1^2 - t0^2) / 2)        d_b += g n (t1^2 - t0^2) / 2

A point sample of the same pixel is 0 or 1, and its derivative is 0 almost everywhere.
"""

from __future__ import annotations

import numpy as np

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.types import Array, FloatArray


@typed_call
def polygon_coverage(points: Array, size: tuple[int, int]) -> FloatArray:
    """Area of a polygon in each pixel.

    Args:
        points: (K, 2) corners in pixels, in either direction around; convex or not, but simple.
        size: (height, width) of the picture.

    Returns:
        (H, W) float64; counted positive where the corners run clockwise as the picture shows them,
        with y downwards, and negative otherwise.

    Raises:
        DtypeError, ShapeError, RangeError: points that are not at least three finite (K, 2).
    """
    call = Arguments("polygon_coverage", np.float64)
    polygon = call.array("points", points, ("K", 2), min_length=3)
    height, width = call.size("size", size)
    out = np.zeros((height, width))
    for y, x in np.ndindex(height, width):
        inside = _clipped(polygon, x, y)
        if len(inside):
            following = np.roll(inside, -1, axis=0)
            twice = inside[:, 0] * following[:, 1] - following[:, 0] * inside[:, 1]
            out[y, x] = twice.sum() / 2
    return out


@typed_call
def polygon_coverage_backward(points: Array, d_coverage: Array) -> FloatArray:
    """dL/dpoints (K, 2).

    Args:
        points: as for `polygon_coverage`.
        d_coverage: (H, W) dL/d of what it returned.

    Raises:
        DtypeError, ShapeError, RangeError: as for `polygon_coverage`.
    """
    call = Arguments("polygon_coverage_backward", np.float64)
    polygon = call.array("points", points, ("K", 2), min_length=3)
    d_coverage = call.array("d_coverage", d_coverage, ("H", "W"))
    out = np.zeros_like(polygon)
    for (y, x), g in np.ndenumerate(d_coverage):
        for k, a in enumerate(polygon):
            following = (k + 1) % len(polygon)
            b = polygon[following]
            low, high = _within(a, b, x, y)
            if low >= high:
                continue
            along = b - a
            normal = g * np.array([along[1], -along[0]])
            second = (high**2 - low**2) / 2
            out[k] += normal * (high - low - second)
            out[following] += normal * second
    return out


def _clipped(polygon: FloatArray, x: int, y: int) -> FloatArray:
    """The part of a polygon within the pixel [x, x + 1] x [y, y + 1]."""
    for axis, limit, sign in ((0, x, 1), (0, x + 1, -1), (1, y, 1), (1, y + 1, -1)):
        if not len(polygon):
            break
        height = sign * (polygon[:, axis] - limit)
        following, after = np.roll(polygon, -1, axis=0), np.roll(height, -1)
        kept = []
        for p, q, h, k in zip(polygon, following, height, after, strict=True):
            if h >= 0:
                kept.append(p)
            if (h >= 0) != (k >= 0):
                kept.append(p + h / (h - k) * (q - p))
        polygon = np.array(kept).reshape(-1, 2)
    return polygon


def _within(a: FloatArray, b: FloatArray, x: int, y: int) -> tuple[float, float]:
    """Parameters between which a + t (b - a) lies in a pixel; the first is larger if it misses."""
    low, high = 0.0, 1.0
    for start, change, limit in ((a[0], b[0] - a[0], x), (a[1], b[1] - a[1], y)):
        if change == 0:
            # An edge along the border of two pixels belongs to the second.
            if not limit <= start < limit + 1:
                return 1.0, 0.0
            continue
        first, last = sorted(((limit - start) / change, (limit + 1 - start) / change))
        low, high = max(low, first), min(high, last)
    return low, high
