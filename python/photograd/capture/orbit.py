"""Cameras around a box, looking at its middle: on a circle, rising, or in all directions."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from photograd.capture.camera import Camera
from photograd.errors import RangeError, message
from photograd.types import Array

Size: TypeAlias = int | tuple[int, int]
"""Of a picture in pixels: width and height, or one number for both."""


def orbit_cameras(
    box: Array, count: int, *, size: Size, elevation: float = 25.0, field_of_view: float = 40.0
) -> list[Camera]:
    """`count` cameras of `size` pixels around the vertical (+Y) axis.

    elevation and field_of_view (across the shorter edge) in degrees; the distance is such that the
    box's sphere fills 90 % of the view.

    Raises:
        RangeError: a box without extent; what `Camera` raises.
    """
    tilt = np.radians(elevation)
    outward = []
    for k in range(count):
        turn = 2 * np.pi * k / count
        outward.append([np.cos(tilt) * np.sin(turn), np.sin(tilt), np.cos(tilt) * np.cos(turn)])
    return _around("orbit_cameras", box, np.array(outward), size, field_of_view)


def helix_cameras(
    box: Array,
    count: int,
    *,
    size: Size,
    elevation: float = 60.0,
    turns: float = 2.0,
    field_of_view: float = 40.0,
) -> list[Camera]:
    """`count` cameras that turn around the vertical axis and rise from the horizon.

    Args:
        box: (2, 3) corners in the world, meters.
        count: of cameras.
        size: pixels.
        elevation: of the last camera, in degrees above the horizon; the first is level.
        turns: around the axis.
        field_of_view: across the shorter edge, in degrees.

    Raises:
        RangeError: a box without extent; what `Camera` raises.
    """
    share = np.arange(count) / max(count - 1, 1)
    tilt, turn = np.radians(elevation) * share, 2 * np.pi * turns * share
    level = np.cos(tilt)
    outward = np.stack([level * np.sin(turn), np.sin(tilt), level * np.cos(turn)], axis=-1)
    return _around("helix_cameras", box, outward, size, field_of_view)


def spiral_cameras(
    box: Array, count: int, *, size: Size, turn: float = 0.0, field_of_view: float = 40.0
) -> list[Camera]:
    """`count` cameras of `size` pixels in all directions around a box, evenly spread.

    They lie on a spiral from below to above, each a golden angle on [Vogel1979]. `turn` and
    field_of_view in degrees; the distance is that of `orbit_cameras`.

    Args:
        box: (2, 3) corners in the world, meters.
        count: of cameras.
        size: pixels.
        turn: of the whole spiral about the vertical axis.
        field_of_view: of each camera.

    Raises:
        RangeError: a box without extent; what `Camera` raises.
    """
    number = np.arange(count)
    height = (2 * number + 1) / count - 1
    angle = np.radians(turn) + np.pi * (3 - np.sqrt(5.0)) * number
    level = np.sqrt(1 - height * height)
    outward = np.stack([level * np.sin(angle), height, level * np.cos(angle)], axis=-1)
    return _around("spiral_cameras", box, outward, size, field_of_view)


def _around(
    function: str, box: Array, outward: Array, size: Size, field_of_view: float
) -> list[Camera]:
    """A camera in each direction (N, 3) from the middle of a box."""
    center = np.asarray(box, np.float64).mean(axis=0)
    radius = 0.5 * float(np.linalg.norm(box[1] - box[0]))
    if not 0 < radius < np.inf:
        got = f"{np.asarray(box).tolist()}"
        raise RangeError(message(function, "box", "two different finite corners", got))
    half = np.radians(field_of_view) / 2
    distance = radius / np.sin(half) / 0.9
    width, height = (size, size) if isinstance(size, int) else size
    focal = 0.5 * min(width, height) / np.tan(half)
    return [
        Camera(
            width,
            height,
            focal,
            focal,
            width / 2,
            height / 2,
            look_at(center + distance * d, center),
        )
        for d in outward
    ]


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
