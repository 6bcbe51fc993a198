"""How good a picture is: PSNR and SSIM, each with the protocol that its number depends on.

Protocol of this project for 8-bit captures: composite truth and render over white, display-encode
(sRGB), clip to [0, 1], round to 8 bits (`round_to_8_bits`), peak 1. State it beside every number;
a tenth of a decibel is easily gained by leaving one of these steps out.

A photograph may lack pixels: the border that undistortion leaves, or what a mask excludes. `valid`
keeps both scores to the pixels that exist; without it, whatever fills the rest is scored as well.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from .checks import (
    FloatArray,
    require_float_array,
    require_like,
    require_mask,
    require_not_empty,
    require_number,
)
from .errors import RangeError, ShapeError, message

_WINDOW = 11
_SIGMA = 1.5
_K1, _K2 = 0.01, 0.03


def psnr(
    prediction: FloatArray,
    target: FloatArray,
    *,
    peak: float = 1.0,
    valid: NDArray[np.bool_] | None = None,
) -> float:
    """Peak signal-to-noise ratio in decibels: 10 log10(peak^2 / mean squared error).

    Args:
        prediction, target: same shape and dtype; the mean runs over all pixels and channels of
            this one image (a mean of PSNRs over images is another number).
        peak: largest possible value, 1 for encoded images in [0, 1].
        valid: (H, W), the pixels that count, in all of their channels; None for all of them. What
            the others hold, NaN included, does not matter.

    Returns:
        decibels; infinity for images that are equal wherever they are valid.

    Raises:
        DtypeError, ShapeError, RangeError: images that do not match, are empty, or not finite; a
            mask of another type or shape, or without a valid pixel.
    """
    prediction, target = _check("psnr", prediction, target, valid)
    peak = require_number("psnr", "peak", peak, least=0.0, open_ends=True)
    if valid is not None:
        if not valid.any():
            raise RangeError(message("psnr", "valid", "at least one valid pixel", "none"))
        prediction, target = prediction[valid], target[valid]
    difference = prediction.astype(np.float64) - target
    error = float(np.mean(difference * difference))
    return math.inf if error == 0.0 else 10.0 * math.log10(peak * peak / error)


def ssim(
    prediction: FloatArray,
    target: FloatArray,
    *,
    peak: float = 1.0,
    valid: NDArray[np.bool_] | None = None,
) -> float:
    """Structural similarity [Wang2004], averaged over positions and channels.

    Protocol: 11 x 11 Gaussian window of sigma 1.5 (weights sum to 1, biased variances),
    K1 = 0.01, K2 = 0.03; only windows that lie inside the image count, no downsampling, each
    channel on its own, then the plain mean. All in float64.

    Args:
        prediction, target: (H, W) or (H, W, C), at least 11 x 11, same shape and dtype.
        peak: largest possible value.
        valid: (H, W), the pixels that exist; only windows count that hold no others
            (`whole_windows`). None for all of them.

    Returns:
        1 for images that are equal wherever they are valid, less otherwise.

    Raises:
        DtypeError, ShapeError, RangeError: images that do not match, too small, or not finite; a
            mask of another type or shape, or without a window of valid pixels.
    """
    prediction, target = _check("ssim", prediction, target, valid)
    peak = require_number("ssim", "peak", peak, least=0.0, open_ends=True)
    if prediction.ndim not in (2, 3) or min(prediction.shape[:2]) < _WINDOW:
        expected = f"shape (H, W) or (H, W, C), at least {_WINDOW} x {_WINDOW}"
        raise ShapeError(message("ssim", "prediction", expected, prediction.shape))
    windows = None if valid is None else whole_windows(valid)
    if windows is not None and not windows.any():
        expected = f"at least one {_WINDOW} x {_WINDOW} window of valid pixels"
        raise RangeError(message("ssim", "valid", expected, "none"))
    x, y = prediction.astype(np.float64), target.astype(np.float64)
    mean_x, mean_y = _blur(x), _blur(y)
    variance_x = _blur(x * x) - mean_x * mean_x
    variance_y = _blur(y * y) - mean_y * mean_y
    covariance = _blur(x * y) - mean_x * mean_y
    c1, c2 = (_K1 * peak) ** 2, (_K2 * peak) ** 2
    luminance = (2.0 * mean_x * mean_y + c1) / (mean_x * mean_x + mean_y * mean_y + c1)
    structure = (2.0 * covariance + c2) / (variance_x + variance_y + c2)
    similarity = luminance * structure
    return float(np.mean(similarity if windows is None else similarity[windows]))


def whole_windows(valid: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which windows of `ssim` hold valid pixels alone.

    Args:
        valid: (H, W), the pixels that exist.

    Returns:
        (H - 10, W - 10), by the window's upper left pixel; empty for a mask that no window fits in.

    Raises:
        DtypeError, ShapeError: not boolean, or not of two axes.
    """
    if np.ndim(valid) != 2:
        raise ShapeError(message("whole_windows", "valid", "shape (H, W)", np.shape(valid)))
    whole = require_mask("whole_windows", "valid", valid, valid.shape)
    if min(whole.shape) < _WINDOW:
        return np.zeros([max(0, n - _WINDOW + 1) for n in whole.shape], np.bool_)
    for axis in (0, 1):
        whole = np.asarray(sliding_window_view(whole, _WINDOW, axis=axis).all(axis=-1))
    return whole


def round_to_8_bits(image: FloatArray) -> FloatArray:
    """Clip encoded values to [0, 1] and round to the nearest of 256 levels, as a file would.

    Halves round up: floor(255 x + 0.5) / 255. Same shape and dtype.
    """
    image = require_float_array("round_to_8_bits", "image", image)
    levels = np.floor(np.clip(image, 0.0, 1.0) * 255.0 + 0.5)
    return np.asarray(levels / 255.0).astype(image.dtype, copy=False)


def gaussian_window() -> NDArray[np.float64]:
    """The 11 weights of the separable window; they sum to 1."""
    offset = np.arange(_WINDOW) - (_WINDOW - 1) / 2
    weights = np.exp(-0.5 * (offset / _SIGMA) ** 2)
    return np.asarray(weights / weights.sum())


def _blur(image: NDArray[np.float64]) -> NDArray[np.float64]:
    """Weighted mean under the window at every valid position, rows first, then columns."""
    for axis in (0, 1):
        count = image.shape[axis] - _WINDOW + 1
        blurred = np.zeros_like(np.take(image, range(count), axis=axis))
        for offset, weight in enumerate(gaussian_window()):
            part = (slice(None),) * axis + (slice(offset, offset + count),)
            blurred += weight * image[part]
        image = blurred
    return image


def _check(
    function: str, prediction: FloatArray, target: FloatArray, valid: NDArray[np.bool_] | None
) -> tuple[FloatArray, FloatArray]:
    """Both images, with zeros where they are not valid."""
    checked = require_float_array(function, "prediction", prediction)
    require_not_empty(function, "prediction", checked)
    require_like(function, "target", target, "prediction", checked)
    if valid is not None:
        require_mask(function, "valid", valid, checked.shape[:2])
        kept = valid.reshape(valid.shape + (1,) * (checked.ndim - valid.ndim))
        prediction, target = np.where(kept, prediction, 0), np.where(kept, target, 0)
    for name, image in (("prediction", prediction), ("target", target)):
        bad = int(np.count_nonzero(~np.isfinite(image)))
        if bad:
            got = f"{bad} of {image.size} that are not"
            raise RangeError(message(function, name, "finite values", got))
    return prediction, target
