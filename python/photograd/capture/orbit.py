"""Cameras on a circle around a box, looking at its middle."""

from __future__ import annotations

import numpy as np

from photograd.capture.camera import Camera
from photograd.errors import RangeError, message
from photograd.types import Array


def orbit_cameras(
    box: Array, count: int, *, size: int, elevation: float = 25.0, field_of_view: float = 40.0
) -> list[Camera]:
    """`count` square cameras of `size` pixels around the vertical (+Y) axis.

    elevation and field_of_view in degrees; the distance is such that the box's sphere fills 90 % of
    the view.

    Raises:
        RangeError: a box without extent; what `Camera` raises.
    """
    center = np.asarray(box, np.float64).mean(axis=0)
    radius = 0.5 * float(np.linalg.norm(box[1] - box[0]))
    if not 0 < radius < np.inf:
        got = f"{np.asarray(box).tolist()}"
        raise RangeError(message("orbit_cameras", "box", "two different finite corners", got))
    half = np.radians(field_of_view) / 2
    distance = radius / np.sin(half) / 0.9
    focal = 0.5 * size / np.tan(half)
    tilt = np.radians(elevation)
    cameras = []
    for k in range(count):
        turn = 2 * np.pi * k / count
        outward = np.array([np.cos(tilt) * np.sin(turn), np.sin(tilt), np.cos(tilt) * np.cos(turn)])
        cameras.append(
            Camera(
                size,
                size,
                focal,
                focal,
                size / 2,
                size / 2,
                look_at(center + distance * outward, center),
            )
        )
    return cameras


def look_at(eye: Array, target: Array) -> Array:
    """world_from_camera (4, 4) of a camera at `eye`: +Z towards `target`, +Y down, world +Y up."""
    forward = target - eye
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, [0.0, 1.0, 0.0])
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2] = right, np.cross(forward, right), forward
    pose[:3, 3] = eye
    return pose
