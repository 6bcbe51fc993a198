"""Lookups at points of a picture, for passes that move or gather pixels."""

from __future__ import annotations

import numpy as np

from photograd._arrays import Arguments
from photograd.textures import sample
from photograd.types import Array


def pixel_centers(height: int, width: int, dtype: object = np.float64) -> tuple[Array, Array]:
    """X and y (H, W) of the centers of all pixels; that of the top left one is (0.5, 0.5).

    Args:
        height, width: of the picture.
        dtype: of the numbers.
    """
    y, x = np.indices((height, width))
    return (x + 0.5).astype(dtype), (y + 0.5).astype(dtype)  # type: ignore[call-overload]


def look_up(picture: Array, x: Array, y: Array) -> Array:
    """Bilinear lookups (H, W, C) at points (H, W) in pixels, clamped to the border.

    Args:
        picture: (H', W', C), up to four channels.
        x, y: (H, W) of the picture's dtype.
    """
    height, width = picture.shape[:2]
    uv = np.stack([x / width, y / height], axis=-1).reshape(-1, 2).astype(picture.dtype)
    return sample(picture, uv).reshape((*np.shape(x), picture.shape[2]))


def color_argument(call: Arguments, color: Array) -> Array:
    """`color` (H, W, 3) as an argument of a `call`, not empty."""
    return call.array("color", color, ("H", "W", 3), min_length=1)
