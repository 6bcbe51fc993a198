"""Ambient occlusion from the horizons around each pixel [Bavoil2008; Jimenez2016].

Formulas: cpp/photograd/frame/horizon.h. Within a slice through the line of sight the integral over
the open sky is exact; what the frame does not show hides nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from photograd._arrays import Arguments
from photograd._checks import require_types
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.frame.screen import screen_arguments
from photograd.types import Array


@typed_call
@dataclass(frozen=True)
class HorizonSettings:
    """How far and how finely horizons are looked for.

    Attributes:
        radius: meters; what is further away hides nothing.
        falloff: the last part of the radius, 0 to 1, over which occlusion fades.
        slices: planes through the line of sight, turned by a pattern of 4 x 4 pixels.
        steps: points on each side of a slice, gathered at the pixel.

    Raises:
        DtypeError, RangeError: no numbers, or out of range.
    """

    radius: float = 0.5
    falloff: float = 0.5
    slices: int = 4
    steps: int = 8

    def __post_init__(self) -> None:
        require_types(self)
        call = Arguments("HorizonSettings")
        call.number("radius", self.radius, above=0.0, high=1e6)
        call.number("falloff", self.falloff, low=0.0, high=1.0)
        call.integer("slices", self.slices, low=1, high=64)
        call.integer("steps", self.steps, low=1, high=256)


HORIZON_DEFAULTS = HorizonSettings()


@typed_call
def horizon_occlusion(
    depth: Array, normals: Array, camera: Camera, settings: HorizonSettings = HORIZON_DEFAULTS
) -> Array:
    """How much of the sky each pixel sees, weighted by the cosine.

    Args:
        depth: (H, W) along the camera's axis, meters; infinite where nothing is visible.
        normals: (H, W, 3) unit normals in the world, towards the viewer; not read where nothing is
            visible.
        camera: of the frame.
        settings: of the search.

    Returns:
        (H, W) from 0 to 1, of the dtype of `depth`; 1 on flat walls and where nothing is visible.

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other types or sizes than the camera's.
    """
    call = Arguments("horizon_occlusion")
    inverse, local, intrinsics = screen_arguments(call, depth, normals, camera)
    out = np.empty_like(inverse)
    numbers = (settings.radius, settings.falloff, settings.slices, settings.steps)
    call.run(_core.horizon_occlusion, inverse, local, intrinsics, *numbers, out)
    return out
