"""Curves through given points, walked at an even pace, and frames that do not twist along them."""

from __future__ import annotations

import numpy as np
from photograd_course.checks import require_integer

from photograd._arrays import Arguments
from photograd.errors import RangeError, message
from photograd.types import FloatArray


def smooth_curve(points: FloatArray, count: int, *, closed: bool = False) -> FloatArray:
    """A curve through all points with continuous tangents [Catmull1974], evenly spaced by length.

    Between b and c of four neighbors a, b, c, d it is, for t in 0..1,

        b + t (c - a)/2 + t^2 (a - 5b/2 + 2c - d/2) + t^3 (3b - a - 3c + d)/2.

    Where an open curve has a point twice in a row, it has a corner: the two parts know nothing of
    each other.

    Args:
        points: (P, D), P >= 2.
        count: number of points of the result, at least 2.
        closed: come back to the first point, which is then not repeated at the end.

    Returns:
        (count, D), float64.

    Raises:
        ShapeError, RangeError, DtypeError: too few points, or points that are not finite.
    """
    points = _checked("smooth_curve", points, ("P", "D"))
    require_integer("smooth_curve", "count", count, least=2)
    if closed:
        dense = _spline(np.concatenate([points[-1:], points, points[:2]]))
        return evenly_spaced(dense, count + 1)[:-1]
    corners = 1 + np.flatnonzero((points[1:] == points[:-1]).all(axis=1))
    parts = np.split(points, corners)
    ended = [np.concatenate([part[:1], part, part[-1:]]) for part in parts]
    return evenly_spaced(np.concatenate([_spline(part) for part in ended]), count)


def _spline(points: FloatArray) -> FloatArray:
    """Many points of the spline from the second point (P, D) to the last but one."""
    t = np.linspace(0.0, 1.0, 33)[:-1, None]
    pieces = []
    for k in range(len(points) - 3):
        a, b, c, d = points[k : k + 4]
        pieces.append(
            b
            + 0.5 * t * (c - a)
            + t**2 * (a - 2.5 * b + 2 * c - 0.5 * d)
            + 0.5 * t**3 * (3 * b - a - 3 * c + d)
        )
    return np.concatenate([*pieces, points[-2:-1]])


def evenly_spaced(points: FloatArray, count: int) -> FloatArray:
    """`count` points (count, D) along the polyline through `points` (P, D), equal lengths apart.

    Raises:
        ShapeError, RangeError, DtypeError: too few points, not finite, or all the same.
    """
    points = _checked("evenly_spaced", points, ("P", "D"))
    require_integer("evenly_spaced", "count", count, least=2)
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    if along[-1] == 0.0:
        raise RangeError(message("evenly_spaced", "points", "a curve with a length", "one point"))
    wanted = np.linspace(0.0, along[-1], count)
    return np.stack([np.interp(wanted, along, column) for column in points.T], axis=1)


def untwisted_frames(points: FloatArray, *, closed: bool = False) -> tuple[FloatArray, FloatArray]:
    """Unit tangents and normals (N, 3) along a curve; the normals turn as little as they can.

    Each frame is the one before, reflected twice: first in the plane halfway between the two
    points, then so that its tangent becomes the new one [Wang2008]. On a closed curve the angle
    that is left when it comes back to its start is spread over its length.

    Args:
        points: (N, 3), neighbors different, N >= 2 (3 if closed).
        closed: whether the last point is followed by the first.

    Raises:
        ShapeError, RangeError: not (N, 3), too few, or neighbors that coincide.
    """
    points = _checked("untwisted_frames", points, ("N", 3))
    tangents = _tangents(points, closed)
    count = len(points)
    normals = np.empty_like(points)
    normals[0] = _any_normal(tangents[0])
    for k in range(count - 1):
        normals[k + 1] = _carried(points[k : k + 2], tangents[k : k + 2], normals[k])
    if closed:
        ends = np.stack([points[-1], points[0]])
        arrived = _carried(ends, np.stack([tangents[-1], tangents[0]]), normals[-1])
        side = np.cross(tangents[0], normals[0])
        missing = -np.arctan2(arrived @ side, arrived @ normals[0])
        angle = (missing * np.arange(count) / count)[:, None]
        normals = np.cos(angle) * normals + np.sin(angle) * np.cross(tangents, normals)
    return tangents, normals


def _tangents(points: FloatArray, closed: bool) -> FloatArray:
    """Unit central differences; one-sided at the ends of an open curve."""
    if closed:
        differences = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
    else:
        differences = np.gradient(points, axis=0)
    lengths = np.linalg.norm(differences, axis=1, keepdims=True)
    if not bool((lengths > 0.0).all()):
        got = f"a point that stands still, number {int(np.argmin(lengths))}"
        raise RangeError(message("untwisted_frames", "points", "different neighbors", got))
    return np.asarray(differences / lengths)


def _any_normal(tangent: FloatArray) -> FloatArray:
    """The unit vector at right angles to the tangent that is nearest to an axis far from it."""
    axis = np.eye(3)[int(np.argmin(np.abs(tangent)))]
    normal = axis - (axis @ tangent) * tangent
    return np.asarray(normal / np.linalg.norm(normal))


def _carried(points: FloatArray, tangents: FloatArray, normal: FloatArray) -> FloatArray:
    """The normal at points[0] brought to points[1] by two reflections [Wang2008, Table I]."""
    first = points[1] - points[0]
    scale = 2.0 / (first @ first)
    reflected = normal - scale * (first @ normal) * first
    tangent = tangents[0] - scale * (first @ tangents[0]) * first
    second = tangents[1] - tangent
    length = float(second @ second)
    if length > 0.0:
        reflected = reflected - 2.0 / length * (second @ reflected) * second
    return np.asarray(reflected)


def _checked(function: str, points: FloatArray, shape: tuple[str | int, ...]) -> FloatArray:
    return Arguments(function, np.float64).array("points", points, shape, min_length=2)
