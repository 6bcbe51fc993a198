"""Solids turned on a lathe, and profiles for them."""

from __future__ import annotations

import numpy as np
from photograd_course.checks import require_integer

from photograd.errors import RangeError, ShapeError, message
from photograd.scenes.curves import smooth_curve
from photograd.scenes.surface import Surface, from_grid
from photograd.types import FloatArray


def lathe(profile: FloatArray, *, columns: int = 96) -> Surface:
    """The solid that a profile sweeps around the +Y axis.

    Args:
        profile: (M, 2) of (radius, height), from top to bottom on the outside, both ends on the
            axis (radius 0). A vessel starts on the floor inside, rises along the inner wall and
            comes down outside. u runs around, v along the profile.
        columns: number of faces around, at least 3.

    Raises:
        ShapeError, RangeError, DtypeError: not (M, 2), negative radii, ends off the axis, fewer
            than 3 columns.
    """
    profile = np.asarray(profile, dtype=np.float64)
    require_integer("lathe", "columns", columns, least=3)
    if profile.ndim != 2 or profile.shape[1] != 2 or len(profile) < 3:
        raise ShapeError(message("lathe", "profile", "shape (M, 2), M >= 3", profile.shape))
    radius, height = profile.T
    if not bool(np.isfinite(profile).all()) or float(radius.min()) < 0.0:
        raise RangeError(message("lathe", "profile", "finite, radii of at least 0", "others"))
    if radius[0] != 0.0 or radius[-1] != 0.0:
        got = f"radii {radius[0]:g} and {radius[-1]:g}"
        raise RangeError(message("lathe", "profile", "both ends on the axis", got))
    angle = 2.0 * np.pi * np.arange(columns) / columns
    ring = np.stack([np.sin(angle), np.zeros(columns), np.cos(angle)], axis=-1)
    points = radius[:, None, None] * ring
    points[..., 1] = height[:, None]
    return from_grid(points, closed_columns=True)


def rounded_profile(corners: list[tuple[float, float]], *, count: int = 96) -> FloatArray:
    """A profile (count, 2) for `lathe` through `corners` (radius, height), both ends on the axis.

    A corner given twice stays sharp; all others are rounded.
    """
    profile = smooth_curve(np.array(corners, dtype=np.float64), count)
    profile[:, 0] = np.clip(profile[:, 0], 0.0, None)
    profile[[0, -1], 0] = 0.0
    return profile
