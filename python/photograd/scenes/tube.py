"""Tubes along curves: wires, handles, branches."""

from __future__ import annotations

import numpy as np
from photograd_course.checks import require_integer

from photograd.errors import RangeError, ShapeError, message
from photograd.scenes.curves import untwisted_frames
from photograd.scenes.surface import Surface, from_grid
from photograd.types import FloatArray

_CAP_RINGS = 4


def tube(
    curve: FloatArray, radius: float | FloatArray, *, sides: int = 16, closed: bool = False
) -> Surface:
    """A round tube, watertight: closed upon itself, or with half a ball at both ends.

    u runs around, v along the curve. The curve is expected to bend by less than 1 / radius.

    Args:
        curve: (N, 3), neighbours different.
        radius: metres, one number or (N,).
        sides: number of faces around, at least 3.
        closed: whether the last point is followed by the first.

    Raises:
        ShapeError, RangeError, DtypeError: a curve that `untwisted_frames` refuses, radii of
            another count or not positive, fewer than 3 sides.
    """
    require_integer("tube", "sides", sides, least=3)
    tangents, normals = untwisted_frames(curve, closed=closed)
    centres = np.asarray(curve, dtype=np.float64)
    radii = np.asarray(radius, dtype=np.float64)
    if radii.shape not in ((), (len(centres),)):
        expected = f"one number or shape ({len(centres)},)"
        raise ShapeError(message("tube", "radius", expected, radii.shape))
    radii = np.broadcast_to(radii, len(centres)).copy()
    if not bool((np.isfinite(radii) & (radii > 0.0)).all()):
        raise RangeError(message("tube", "radius", "positive numbers", radii.min()))
    if not closed:
        centres, radii, tangents, normals = _with_caps(centres, radii, tangents, normals)
    angle = 2.0 * np.pi * np.arange(sides) / sides
    # Seen from outside with the curve running down, the right-hand side is normal x tangent.
    across = np.cross(normals, tangents)
    ring = np.cos(angle)[:, None] * normals[:, None] + np.sin(angle)[:, None] * across[:, None]
    points = centres[:, None] + radii[:, None, None] * ring
    return from_grid(points, closed_rows=closed, closed_columns=True)


def _with_caps(
    centres: FloatArray, radii: FloatArray, tangents: FloatArray, normals: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Rings of half a ball before the first and after the last, down to a pole of radius 0."""
    angle = 0.5 * np.pi * np.arange(_CAP_RINGS) / _CAP_RINGS
    rise, shrink = np.cos(angle), np.sin(angle)
    start = centres[0] - radii[0] * rise[:, None] * tangents[0]
    end = (centres[-1] + radii[-1] * rise[:, None] * tangents[-1])[::-1]
    index = np.pad(np.arange(len(centres)), _CAP_RINGS, mode="edge")
    all_radii = np.concatenate([radii[0] * shrink, radii, radii[-1] * shrink[::-1]])
    return np.concatenate([start, centres, end]), all_radii, tangents[index], normals[index]
