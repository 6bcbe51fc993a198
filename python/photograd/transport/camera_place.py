"""Where a camera stands, from two points."""

from __future__ import annotations

import numpy as np

from photograd.capture.camera import Camera
from photograd.capture.orbit import look_at


def camera_at(
    position: object, target: object, field_of_view: float, width: int, height: int
) -> Camera:
    """A camera that looks from one point to another; field_of_view is vertical, in degrees."""
    focal = 0.5 * height / float(np.tan(np.radians(field_of_view) / 2))
    pose = look_at(np.asarray(position, np.float64), np.asarray(target, np.float64))
    return Camera(width, height, focal, focal, width / 2, height / 2, pose)
