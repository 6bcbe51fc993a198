"""What a lens does to a picture besides its blur: colors of several sizes, and darker corners."""

from __future__ import annotations

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.frame.pixels import color_argument, look_up, pixel_centers
from photograd.types import Array


@typed_call
def chromatic_aberration(color: Array, strength: float) -> Array:
    """Red drawn larger and blue smaller than green, about the picture's center.

    Args:
        color: (H, W, 3) linear radiance, float32 or float64.
        strength: relative difference of sizes, such as 0.002; 0 changes nothing, green never
            changes.

    Returns:
        (H, W, 3) of the same dtype; beyond the border the last pixel is repeated.

    Raises:
        DtypeError, ShapeError, RangeError: color of another dtype or shape, not finite, or a
            strength of 0.5 or more.
    """
    call = Arguments("chromatic_aberration")
    color = color_argument(call, color)
    strength = call.number("strength", strength, above=-0.5, below=0.5)
    if strength == 0:
        return color.copy()
    height, width = color.shape[:2]
    x, y = pixel_centers(height, width, color.dtype)
    out = color.copy()
    for channel, scale in ((0, 1 + strength), (2, 1 - strength)):
        from_x = 0.5 * width + (x - 0.5 * width) / scale
        from_y = 0.5 * height + (y - 0.5 * height) / scale
        out[..., channel] = look_up(color[..., channel : channel + 1].copy(), from_x, from_y)[
            ..., 0
        ]
    return out


@typed_call
def vignette(color: Array, camera: Camera, strength: float = 1.0) -> Array:
    """The natural fall of light towards the corners: the fourth power of the cosine to the axis.

    Args:
        color: (H, W, 3) linear radiance, float32 or float64.
        camera: of the picture.
        strength: 1 for the whole fall, 0 for none; in between it is mixed.

    Returns:
        (H, W, 3) of the same dtype.

    Raises:
        DtypeError, ShapeError, RangeError: color of another dtype or of another size than the
            camera's, not finite, or a strength outside of [0, 1].
    """
    call = Arguments("vignette")
    color = call.array("color", color, (camera.height, camera.width, 3))
    strength = call.number("strength", strength, low=0.0, high=1.0)
    x, y = pixel_centers(camera.height, camera.width)
    slope_x, slope_y = (x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy
    cosine_squared = 1.0 / (1.0 + slope_x * slope_x + slope_y * slope_y)
    factor = 1.0 - strength * (1.0 - cosine_squared * cosine_squared)
    out: Array = color * factor[..., None].astype(color.dtype)
    return out
