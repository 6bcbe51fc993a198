"""Dithering: noise of one step before rounding, so that dark gradients show no bands."""

from __future__ import annotations

import numpy as np
from photograd_course.random import uniform

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.types import Array


@typed_call
def dither(display: Array, *, levels: int = 256, seed: int = 0, strength: float = 1.0) -> Array:
    """Round display-encoded colors to levels, after noise that makes the mean exact.

    The noise is triangular, the sum of two uniform numbers, so that neither the mean nor the
    variance of what is shown depends on the color.

    Args:
        display: (H, W, 3) display-encoded colors from 0 to 1, float32 or float64.
        levels: between 0 and 1, both included.
        seed: of the noise.
        strength: of the noise, in steps; 0 rounds alone.

    Returns:
        (H, W, 3) of the same dtype, multiples of 1 / (levels - 1) from 0 to 1.

    Raises:
        DtypeError, ShapeError, RangeError: colors of another dtype or shape, or outside of [0, 1].
    """
    call = Arguments("dither")
    display = call.array("display", display, ("H", "W", 3), low=0.0, high=1.0)
    most = call.integer("levels", levels, low=2, high=65536) - 1
    strength = call.number("strength", strength, low=0.0, high=4.0)
    noise = np.zeros(display.shape)
    if strength > 0:
        pixels = np.arange(display.size)
        pair = [uniform(seed, pixel=pixels, dimension=k) for k in range(2)]
        noise = strength * (pair[0] + pair[1] - 1.0).reshape(display.shape)
    rounded = np.floor(display * np.float64(most) + noise + 0.5)
    return np.asarray(np.clip(rounded, 0, most) / most, display.dtype)
