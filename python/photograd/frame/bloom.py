"""Bloom: bright pixels spread their light over their surroundings, by a pyramid of blurs.

    bright = max(color - threshold, 0)
    out = color + sum over levels l of weights[l] (blur_l(bright) - bright)

Formulas: cpp/photograd/frame/bloom.h. Light is moved, not added; a constant picture stays as it is.
"""

from __future__ import annotations

import numpy as np

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.types import Array


@typed_call
def bloom(color: Array, weights: Array, threshold: float = 0.0) -> Array:
    """A picture with bloom.

    Args:
        color: (H, W, 3) linear radiance, float32 or float64.
        weights: (L,) part of the light that each level spreads, the widest last; level l (from 0)
            blurs over about 2^(l + 1) pixels. All together at most 1; zeros change nothing.
        threshold: radiance above which light spreads; at 0 all does, as in a lens.

    Returns:
        (H, W, 3) of the same dtype.

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other types or shapes, more than 16 levels,
            weights below 0 or of more than 1 together, or numbers that are not finite.
    """
    call = Arguments("bloom")
    color, numbers, threshold = _arguments(call, color, weights, threshold)
    out = np.empty_like(color)
    call.run(_core.bloom, color, threshold, numbers, out)
    return out


@typed_call
def bloom_backward(
    color: Array, weights: Array, d_out: Array, threshold: float = 0.0
) -> tuple[Array, Array, float]:
    """dL/dcolor (H, W, 3), dL/dweights (L,) and dL/dthreshold.

    Args:
        color, weights, threshold: as for `bloom`.
        d_out: (H, W, 3), dL/d(its result).

    Raises:
        DtypeError, ShapeError, RangeError: as for `bloom`.
    """
    call = Arguments("bloom_backward")
    color, numbers, threshold = _arguments(call, color, weights, threshold)
    d_out = call.array("d_out", d_out, ("H", "W", 3))
    d_color, d_weights = np.zeros_like(color), np.zeros_like(numbers)
    d_threshold = np.zeros(1, color.dtype)
    call.run(
        _core.bloom_backward, color, threshold, numbers, d_out, d_color, d_weights, d_threshold
    )
    return d_color, d_weights, float(d_threshold[0])


def _arguments(
    call: Arguments, color: Array, weights: Array, threshold: float
) -> tuple[Array, Array, float]:
    color = call.array("color", color, ("H", "W", 3), min_length=1)
    numbers = call.array("weights", weights, ("L",), dtype=color.dtype, low=0.0, high=1.0)
    call.number("weights.sum()", float(numbers.sum()), high=1.0 + 1e-6)
    return color, numbers, call.number("threshold", threshold, low=0.0)
