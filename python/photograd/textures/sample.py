"""Bilinear lookups in a texture, and their adjoint."""

from __future__ import annotations

import numpy as np

from photograd._compiled import _core
from photograd.errors import DtypeError, message
from photograd.types import Array


def float_array(function: str, argument: str, value: Array) -> Array:
    """`value` itself, or a contiguous copy; refuses what is no array of float32 or float64.

    Raises:
        DtypeError: no NumPy array, or of another dtype.
    """
    if not isinstance(value, np.ndarray) or value.dtype not in (np.float32, np.float64):
        got = getattr(value, "dtype", type(value).__name__)
        remedy = "use numpy.asarray(..., numpy.float32)"
        raise DtypeError(message(function, argument, "a float32 or float64 array", got, remedy))
    return np.ascontiguousarray(value)


def sample(texture: Array, uv: Array, *, out: Array | None = None) -> Array:
    """Look up points of a texture.

    Args:
        texture: (H, W, C).
        uv: (N, 2) texture coordinates of the same dtype.
        out: (N, C) to write to and return, of unknown content after an error; fresh memory for
            millions of points costs as much as their lookup.

    Returns:
        (N, C), the same bits on any number of threads.

    Raises:
        DtypeError, ShapeError: arrays of other or different types or shapes.
        RangeError: texture coordinates that are not finite, counted; no texel, or more than four
            channels.
    """
    texture = float_array("sample", "texture", texture)
    uv = float_array("sample", "uv", uv)
    if out is None:
        rows = len(uv) if uv.ndim else 0
        out = np.empty((rows, texture.shape[-1] if texture.ndim else 0), texture.dtype)
    _core.sample(texture, uv, out)
    return out


def sample_backward(texture: Array, uv: Array, d_color: Array) -> tuple[Array, Array]:
    """The adjoint of `sample`.

    Args:
        texture, uv: as for `sample`.
        d_color: (N, C) dL/dcolor.

    Returns:
        dL/dtexture (H, W, C), every texel's contributions added in one order whatever the number
        of threads, and dL/duv (N, 2), zero along an axis where the point is clamped to the border.
        At a texel centre, where the colour has a kink, it is the derivative towards growing uv.

    Raises:
        DtypeError, ShapeError, RangeError: as for `sample`.
    """
    name = "sample_backward"
    texture = float_array(name, "texture", texture)
    uv, d_color = float_array(name, "uv", uv), float_array(name, "d_color", d_color)
    d_texture, d_uv = np.zeros_like(texture), np.zeros_like(uv)
    _core.sample_backward(texture, uv, d_color, d_texture, d_uv)
    return d_texture, d_uv
