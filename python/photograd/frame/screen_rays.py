"""Rays that are followed through the depths of a frame: what it does not show, they cannot meet.

Such a ray tells whether light from its direction arrives [Ritschel2009], and which pixel's light
arrives in its place.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from photograd._arrays import Arguments
from photograd._checks import require_types
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.frame.screen import along_camera_axes, screen_arguments
from photograd.types import Array

MISSED, LEFT_FRAME = -1, -2
"""Of `follow_screen_rays`: nothing was met, or the ray left the picture before its end."""


@typed_call
@dataclass(frozen=True)
class ScreenRaySettings:
    """How rays are followed.

    Attributes:
        length: meters.
        thickness: meters; a surface hides what is behind it by no more than this.
        steps: points of a ray that are compared with the frame, equally far apart in the picture.

    Raises:
        DtypeError, RangeError: no numbers, or out of range.
    """

    length: float = 1.0
    thickness: float = 0.5
    steps: int = 16

    def __post_init__(self) -> None:
        require_types(self)
        call = Arguments("ScreenRaySettings")
        call.number("length", self.length, above=0.0, high=1e6)
        call.number("thickness", self.thickness, above=0.0, high=1e6)
        call.integer("steps", self.steps, low=1, high=4096)


SCREEN_RAY_DEFAULTS = ScreenRaySettings()


@typed_call
def follow_screen_rays(
    depth: Array,
    normals: Array,
    camera: Camera,
    wi: Array,
    settings: ScreenRaySettings = SCREEN_RAY_DEFAULTS,
) -> Array:
    """The pixel that shows what a ray from the surface in each pixel meets.

    Args:
        depth: (H, W) along the camera's axis, meters; infinite where nothing is visible.
        normals: (H, W, 3) unit normals in the world, towards the viewer.
        camera: of the frame.
        wi: (3,) or (H, W, 3) unit vectors in the world, the directions of the rays.
        settings: how they are followed.

    Returns:
        (H, W) int32: y W + x of a pixel whose surface faces the ray, `MISSED`, or `LEFT_FRAME`.
        Pixels that show nothing miss.

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other types or sizes than the camera's.
    """
    call = Arguments("follow_screen_rays")
    size = (camera.height, camera.width)
    inverse, local, intrinsics = screen_arguments(call, depth, normals, camera)
    wi = along_camera_axes(call.array("wi", wi, (3,), (*size, 3), dtype=inverse.dtype), camera)
    wi = np.ascontiguousarray(np.broadcast_to(wi, (*size, 3)))
    hit = np.empty(size, np.int32)
    numbers = (settings.length, settings.thickness, settings.steps)
    call.run(_core.follow_screen_rays, inverse, local, intrinsics, *numbers, wi, hit)
    return hit
