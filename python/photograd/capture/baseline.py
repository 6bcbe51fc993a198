"""How far apart the cameras of a capture stand, over their distance from the scene.

Depth comes from parallax: for a given error in pixels, the relative error of depth grows as one
over the baseline-to-distance ratio of the cameras.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from photograd_course.portable_math import norm

from photograd.capture.capture import evenly_spaced
from photograd.capture.view import View
from photograd.types import FloatArray

MIN_BASELINE_RATIO = 0.1
"""Below this ratio, an angle of 5.7 degrees, `baseline_warning` warns."""
MAX_CAMERAS = 500
"""All pairs of so many cameras are compared."""


def baseline_ratio(views: Sequence[View], box: FloatArray) -> float:
    """The longest baseline over the distance from the scene, at most 2; 0 for one view.

    It is the smaller of two ratios, both near the parallax angle in radians where they are small:
    the distance of two cameras after all were moved along their lines of sight to one meter from
    the center of the box, which is small where all look from one direction; and the distance of two
    cameras over their mean distance from that center, or over half the diagonal of the box if that
    is more, which is small where cameras only turn.

    Args:
        views: their cameras are compared, at most `MAX_CAMERAS` of them, evenly spaced.
        box: (2, 3) of the scene, in meters.
    """
    centers = np.array([view.camera.position for view in evenly_spaced(views, MAX_CAMERAS)])
    towards = centers - box.mean(axis=0)
    distances = np.linalg.norm(towards, axis=1)
    directions = towards / np.maximum(distances, 1e-300)[:, None]
    distance = max(float(distances.mean()), 0.5 * norm(box[1] - box[0]))
    return min(_longest(directions), _longest(centers) / distance)


def _longest(points: FloatArray) -> float:
    """The greatest distance between two of the points (N, 3)."""
    squares = [np.square(points - point).sum(axis=1).max() for point in points]
    return float(np.sqrt(max(squares)))


def baseline_warning(views: Sequence[View], box: FloatArray) -> str | None:
    """A sentence for cameras whose ratio is below `MIN_BASELINE_RATIO`; else None.

    Args:
        views: that a fit learns from.
        box: (2, 3) of the scene, in meters.
    """
    ratio = baseline_ratio(views, box)
    if ratio >= MIN_BASELINE_RATIO:
        return None
    return (
        f"the training cameras have a baseline of {ratio:.2g} times their distance from the scene, "
        f"below {MIN_BASELINE_RATIO:g}: depth is uncertain; add photographs from other places"
    )
