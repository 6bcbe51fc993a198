"""Structural similarity as a loss: what `photograd_course.metrics.ssim` measures, and its adjoint.

Both in the core, since a fit needs them at every step; the formulas stand in texture/ssim.h.
"""

from __future__ import annotations

import numpy as np

from photograd._compiled import _core
from photograd.types import Array


def ssim(x: Array, y: Array) -> float:
    """Mean structural similarity [Wang2004] of pictures (H, W, C) with values in 0 .. 1.

    11 x 11 Gaussian window of sigma 1.5, only windows that lie inside, each channel on its own.

    Raises:
        DtypeError, ShapeError, RangeError: not both float32 or float64, of different shapes,
            smaller than the window, or of more than four channels.
    """
    return float(_core.ssim(np.ascontiguousarray(x), np.ascontiguousarray(y)))


def ssim_backward(x: Array, y: Array, d_value: float = 1.0) -> tuple[float, Array]:
    """The value, which costs nothing more, and d_x = d_value dssim/dx in the shape of x.

    Raises:
        What `ssim` raises.
    """
    x = np.ascontiguousarray(x)
    d_x = np.zeros_like(x)
    value = _core.ssim_backward(x, np.ascontiguousarray(y), d_value, d_x)
    return float(value), d_x
