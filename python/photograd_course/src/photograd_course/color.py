"""Display encoding and alpha, with their gradients.

Radiance is linear Rec. 709; files and screens hold display-encoded (sRGB) values; buffers hold
premultiplied color, that is, color already multiplied by opacity [Porter1984].
"""

from __future__ import annotations

import numpy as np

from .checks import FloatArray, require_float_array, require_like
from .errors import DtypeError, ShapeError, message
from .portable_math import root

_LINEAR_END = 0.0031308
_ENCODED_END = 0.04045


def srgb_encode(linear: FloatArray) -> FloatArray:
    """Display-encode linear values [IEC61966]: 12.92 x up to x = 0.0031308, a power above.

    The power is 1.055 x^(1/2.4) - 0.055. Values below 0 continue the straight part and values
    above 1 the power; nothing is clipped.

    Args:
        linear: any shape, float32 or float64; 1 is display white.

    Returns:
        encoded values, same shape and dtype.

    Raises:
        DtypeError: not a float array.
    """
    x = require_float_array("srgb_encode", "linear", linear)
    power = 1.055 * _encoding_power(np.maximum(x, _LINEAR_END)) - 0.055
    return np.where(x <= _LINEAR_END, 12.92 * x, power).astype(x.dtype, copy=False)


def srgb_encode_backward(linear: FloatArray, d_encoded: FloatArray) -> FloatArray:
    """d_linear = d_encoded * 12.92, and above the threshold d_encoded * 1.055/2.4 x^(1/2.4 - 1).

    The slope jumps by 0.7 % at 0.0031308 (12.92 below, 12.70 above); the threshold itself belongs
    to the straight part.
    """
    x = require_float_array("srgb_encode_backward", "linear", linear)
    d_out = require_like("srgb_encode_backward", "d_encoded", d_encoded, "linear", x)
    held = np.maximum(x, _LINEAR_END)
    power = (1.055 / 2.4) * _encoding_power(held) / held
    return (d_out * np.where(x <= _LINEAR_END, 12.92, power)).astype(x.dtype, copy=False)


def srgb_decode(encoded: FloatArray) -> FloatArray:
    """The inverse of `srgb_encode`: y / 12.92, and above 0.04045 ((y + 0.055) / 1.055)^2.4.

    The rounded constants of the standard leave a gap of about 1e-8 between the two thresholds.
    """
    y = require_float_array("srgb_decode", "encoded", encoded)
    z = (np.maximum(y, _ENCODED_END) + 0.055) / 1.055
    power = np.square(z * root(z, 5))
    return np.where(y <= _ENCODED_END, y / 12.92, power).astype(y.dtype, copy=False)


def srgb_decode_backward(encoded: FloatArray, d_linear: FloatArray) -> FloatArray:
    """d_encoded = d_linear / 12.92, above the threshold d_linear * 2.4/1.055 (...)^1.4."""
    y = require_float_array("srgb_decode_backward", "encoded", encoded)
    d_out = require_like("srgb_decode_backward", "d_linear", d_linear, "encoded", y)
    z = (np.maximum(y, _ENCODED_END) + 0.055) / 1.055
    power = (2.4 / 1.055) * z * np.square(root(z, 5))
    return (d_out * np.where(y <= _ENCODED_END, 1.0 / 12.92, power)).astype(y.dtype, copy=False)


def composite_over(color: FloatArray, opacity: FloatArray, background: FloatArray) -> FloatArray:
    """Premultiplied color over a background: color + (1 - opacity) background [Porter1984].

    Args:
        color: (..., C), premultiplied.
        opacity: (...), one number per pixel.
        background: (C,) or (..., C).

    Returns:
        (..., C).

    Raises:
        DtypeError, ShapeError: shapes or dtypes that do not belong together.
    """
    _check_composite("composite_over", color, opacity, background)
    return np.asarray(color + (1.0 - opacity)[..., None] * background)


def composite_over_backward(
    color: FloatArray, opacity: FloatArray, background: FloatArray, d_out: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The three gradients (d_color, d_opacity, d_background).

    d_color = d_out; d_opacity = -sum_c d_out background; d_background = (1 - opacity) d_out,
    summed over all pixels when one background (C,) serves them all.
    """
    name = "composite_over_backward"
    _check_composite(name, color, opacity, background)
    require_like(name, "d_out", d_out, "color", color)
    d_opacity = np.asarray(-np.sum(d_out * background, axis=-1))
    d_background = (1.0 - opacity)[..., None] * d_out
    if background.ndim == 1:
        d_background = d_background.reshape(-1, background.size).sum(axis=0)
    return d_out.copy(), d_opacity, d_background


def premultiply(straight: FloatArray, opacity: FloatArray) -> FloatArray:
    """Straight color (..., C) times opacity (...): premultiplied color (..., C)."""
    _check_pair("premultiply", "straight", straight, opacity)
    return np.asarray(straight * opacity[..., None])


def premultiply_backward(
    straight: FloatArray, opacity: FloatArray, d_out: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """(d_straight, d_opacity) = (d_out opacity, sum_c d_out straight)."""
    _check_pair("premultiply_backward", "straight", straight, opacity)
    require_like("premultiply_backward", "d_out", d_out, "straight", straight)
    return np.asarray(d_out * opacity[..., None]), np.asarray(np.sum(d_out * straight, axis=-1))


def unpremultiply(color: FloatArray, opacity: FloatArray) -> FloatArray:
    """Premultiplied color (..., C) divided by opacity (...); 0 where the opacity is 0."""
    _check_pair("unpremultiply", "color", color, opacity)
    return np.asarray(color * _reciprocal(opacity)[..., None])


def unpremultiply_backward(
    color: FloatArray, opacity: FloatArray, d_out: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """(d_color, d_opacity) = (d_out / opacity, -sum_c d_out color / opacity^2); 0 at opacity 0."""
    _check_pair("unpremultiply_backward", "color", color, opacity)
    require_like("unpremultiply_backward", "d_out", d_out, "color", color)
    inverse = _reciprocal(opacity)
    d_color = np.asarray(d_out * inverse[..., None])
    return d_color, np.asarray(-np.sum(d_color * color, axis=-1) * inverse)


def _encoding_power(x: FloatArray) -> FloatArray:
    """x^(1/2.4) as x^(1/3) x^(1/12)."""
    third = root(x, 3)
    return np.asarray(third * np.sqrt(np.sqrt(third)))


def _reciprocal(opacity: FloatArray) -> FloatArray:
    return np.asarray(np.divide(1.0, opacity, out=np.zeros_like(opacity), where=opacity != 0.0))


def _check_pair(function: str, name: str, color: FloatArray, opacity: FloatArray) -> None:
    color = require_float_array(function, name, color)
    opacity = require_float_array(function, "opacity", opacity)
    if color.ndim == 0 or opacity.shape != color.shape[:-1]:
        expected = f"shape (...) for {name} of shape (..., C) = {color.shape}"
        raise ShapeError(message(function, "opacity", expected, opacity.shape))
    if color.dtype != opacity.dtype:
        raise DtypeError(message(function, "opacity", color.dtype, opacity.dtype, "use .astype"))


def _check_composite(
    function: str, color: FloatArray, opacity: FloatArray, background: FloatArray
) -> None:
    _check_pair(function, "color", color, opacity)
    background = require_float_array(function, "background", background)
    if background.shape not in (color.shape, color.shape[-1:]):
        expected = f"shape {color.shape[-1:]} or {color.shape}"
        raise ShapeError(message(function, "background", expected, background.shape))
    if background.dtype != color.dtype:
        got = background.dtype
        raise DtypeError(message(function, "background", color.dtype, got, "use .astype"))
