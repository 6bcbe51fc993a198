"""Gaussians seen from a circle of cameras."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from photograd_course.metrics import round_to_8_bits

from photograd.data.camera import Camera
from photograd.errors import RangeError, message
from photograd.orbit import orbit_cameras
from photograd.representation import Array
from photograd.splat import Gaussians, SplatOptions, render

UP_AXES = ("+x", "-x", "+y", "-y", "+z", "-z")


def scene_box(gaussians: Gaussians) -> Array:
    """(2, 3) corners of what holds 96 % of the means along each axis; fitted scenes have strays.

    Raises:
        RangeError: there are no Gaussians.
    """
    if not len(gaussians):
        raise RangeError(message("scene_box", "gaussians", "at least one", 0))
    return np.percentile(gaussians.means.astype(np.float64), [2, 98], axis=0)


def file_from_upright(up: str) -> Array:
    """(3, 3) rotation from a frame with +Y up to one in which `up`, such as "-y", points up.

    Raises:
        RangeError: no axis of that name.
    """
    if up not in UP_AXES:
        raise RangeError(message("file_from_upright", "up", f"one of {', '.join(UP_AXES)}", up))
    axis, sign = "xyz".index(up[1]), 1.0 if up[0] == "+" else -1.0
    y = sign * np.eye(3)[axis]
    x = np.eye(3)[(axis + 1) % 3]
    return np.stack([x, y, np.cross(x, y)], axis=1)


def orbit_splats(
    gaussians: Gaussians, count: int, *, size: int, elevation: float = 25.0, up: str = "-y"
) -> Iterator[Array]:
    """Pictures (size, size, 3) over white in display values, from `count` cameras around the scene.

    The Gaussians' colours are taken for display colours, as scenes that others fitted have them;
    splats are antialiased.

    Raises:
        RangeError: no Gaussians, or no such axis.
    """
    turn = file_from_upright(up)
    box = scene_box(gaussians) @ turn  # corners in the upright frame, in any order
    upright = np.stack([box.min(axis=0), box.max(axis=0)])
    options = SplatOptions(antialiased=True)
    for camera in orbit_cameras(upright, count, size=size, elevation=elevation):
        pose = camera.world_from_camera.copy()
        pose[:3] = turn @ pose[:3]
        turned = Camera(
            camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy, pose
        )
        picture, _ = render(gaussians, turned, background=(1.0, 1.0, 1.0), options=options)
        yield round_to_8_bits(np.clip(picture.color.astype(np.float64), 0, 1))
