"""Gaussians seen from a circle of cameras."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from photograd_course.metrics import round_to_8_bits

from photograd.capture.camera import Camera
from photograd.capture.orbit import Size, orbit_cameras
from photograd.errors import RangeError, message
from photograd.splats.frames import UNSTATED, USUAL_UP, Presentation, file_from_upright
from photograd.splats.splatting import Gaussians, SplatOptions, SplatPicture, render
from photograd.types import Array

WHITE = (1.0, 1.0, 1.0)
PADDING = 0.05
"""Share of the extent that is added on each side."""
SIGMAS = 3.0
"""Standard deviations in the radius of a Gaussian that is drawn alone."""
POINT = 0.1
"""A splat of so many pixels is a point."""
NEAR = 0.01
"""The near plane, at most so many meters and that share of the distance to the scene."""


def scene_box(gaussians: Gaussians) -> Array:
    """(2, 3) corners of what holds 96 % of the means along each axis, padded by 5 %; fitted scenes
    have strays. Means that are all in one place have a cube of the widest Gaussian around them.

    Args:
        gaussians: of a scene.

    Raises:
        RangeError: there are no Gaussians.
    """
    if not len(gaussians):
        raise RangeError(message("scene_box", "gaussians", "at least one", 0))
    low, high = np.percentile(gaussians.means.astype(np.float64), [2, 98], axis=0)
    # What float32 still resolves there.
    min_extent = 1e-4 * float(np.abs([low, high]).max())
    if float((high - low).max()) > min_extent:
        pad = PADDING * (high - low)
        return np.stack([low - pad, high + pad])
    # Half an edge of the cube in a sphere: cameras stand so that the sphere fills the picture.
    half = max(SIGMAS * _widest(gaussians) / np.sqrt(3.0), min_extent) or 1.0
    middle = 0.5 * (low + high)
    return np.stack([middle - half, middle + half])


def orbit_splats(
    gaussians: Gaussians,
    count: int,
    *,
    size: Size,
    elevation: float = 25.0,
    presentation: Presentation = UNSTATED,
) -> Iterator[Array]:
    """Pictures (H, W, 3) in display values, from `count` cameras around the scene.

    The Gaussians' colors are taken for display colors, as scenes that others fitted have them.

    Args:
        gaussians: the scene; far strays are left outside of the picture.
        count: cameras on the circle.
        size: of the pictures in pixels.
        elevation: of the cameras, in degrees above the horizon.
        presentation: where it says nothing, -y is up, the background white, and splats are
            antialiased unless all are far thinner than a pixel: points, which would vanish.

    Raises:
        RangeError: no Gaussians, or no such axis.
    """
    box = upright_box(gaussians, presentation)
    for camera in orbit_cameras(box, count, size=size, elevation=elevation):
        picture = draw_splats(gaussians, camera, box=box, presentation=presentation)
        yield round_to_8_bits(np.clip(picture.color.astype(np.float64), 0, 1))


def upright_box(gaussians: Gaussians, presentation: Presentation = UNSTATED) -> Array:
    """(2, 3) corners of `scene_box`, after what is up in the file was turned to +Y.

    Args:
        gaussians: in the frame of the file.
        presentation: says which axis is up; -y where it says nothing.

    Raises:
        RangeError: no Gaussians, or no such axis.
    """
    box = scene_box(gaussians) @ file_from_upright(presentation.up or USUAL_UP)  # in any order
    return np.stack([box.min(axis=0), box.max(axis=0)])


def draw_splats(
    gaussians: Gaussians, camera: Camera, *, box: Array, presentation: Presentation = UNSTATED
) -> SplatPicture:
    """Gaussians of a file as a camera sees them that stands upright, over their background.

    Args:
        gaussians: in the frame of the file.
        camera: in the frame with +Y up, see `upright_box`.
        box: (2, 3) of `upright_box`; thin splats are told from points by the distance to it.
        presentation: as for `orbit_splats`.

    Raises:
        RangeError: no such axis.
        Error: colors that overflow; the pixel is named.
    """
    behind = WHITE if presentation.background is None else presentation.background
    turn = file_from_upright(presentation.up or USUAL_UP)
    distance = float(np.linalg.norm(camera.position - box.mean(axis=0)))
    antialiased = presentation.antialiased
    if antialiased is None:
        antialiased = _widest(gaussians) > POINT * distance / camera.fx
    near = max(1e-6, NEAR * min(1.0, distance))
    options = SplatOptions(antialiased=antialiased, near=near)
    pose = camera.world_from_camera.copy()
    pose[:3] = turn @ pose[:3]
    turned = replace(camera, world_from_camera=pose)
    picture, _ = render(gaussians, turned, background=behind, options=options)
    return picture


def _widest(gaussians: Gaussians) -> float:
    """The largest standard deviation of all, in meters."""
    return float(np.exp(min(float(gaussians.log_scales.max()), 80.0)))
