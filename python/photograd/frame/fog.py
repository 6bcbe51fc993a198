"""Homogeneous fog between the viewer and the surfaces, in closed form.

    L = T L_surface + (1 - T) L_fog,  T = exp(-sigma_t d)

d is the distance along the ray. L_fog is the radiance of infinitely deep fog: light that the fog
scatters is not followed.
"""

from __future__ import annotations

import numpy as np
from photograd_course.portable_math import exp

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.frame.pixels import pixel_centers
from photograd.types import Array


@typed_call
def add_fog(radiance: Array, depth: Array, camera: Camera, sigma_t: float, color: Array) -> Array:
    """A picture seen through fog.

    Args:
        radiance: (H, W, 3), W/(m^2 sr).
        depth: (H, W) along the camera's axis, meters; where it is infinite, the fog hides all.
        camera: of the picture.
        sigma_t: extinction, 1/m.
        color: (3,) radiance of infinitely deep fog.

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other types or sizes, negative numbers.
    """
    call = Arguments("add_fog")
    size = (camera.height, camera.width)
    radiance = call.array("radiance", radiance, (*size, 3))
    depth = call.array("depth", depth, size, dtype=np.float64, finite=False, above=0.0)
    sigma_t = call.number("sigma_t", sigma_t, low=0.0)
    color = call.array("color", color, (3,), dtype=radiance.dtype, low=0.0)
    if not sigma_t:
        return radiance
    x, y = pixel_centers(*size)
    x, y = (x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy
    path = depth * np.sqrt(1.0 + x * x + y * y)
    clear = exp(-np.minimum(sigma_t * path, 700.0)).astype(radiance.dtype)[..., None]
    clear[np.isinf(depth)] = 0
    out: Array = clear * radiance + (1 - clear) * color
    return out
