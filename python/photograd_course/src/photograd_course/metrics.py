"""How good a picture is: PSNR and SSIM, each with the protocol that its number depends on.

Protocol of this project for 8-bit captures: composite truth and render over white, display-encode
(sRGB), clip to [0, 1], round to 8 bits (`round_to_8_bits`), peak 1. State it beside every number;
a tenth of a decibel is easily gained by leaving one of these steps out.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .checks import (
    FloatArray,
    require_float_array,
    require_like,
    require_not_empty,
    require_number,
)
from .errors import RangeError, ShapeError, message

_WINDOW = 11
_SIGMA = 1.5
_K1, _K2 = 0.01, 0.03


def psnr(prediction: FloatArray, target: FloatArray, *, peak: float = 1.0) -> float:
    """Peak signal-to-noise ratio in decibels: 10 log10(peak^2 / mean squared error).

    Args:
        prediction, target: same shape and dtype; the mean runs over all pixels and channels of
            this one image (a mean of PSNRs over images is another number).
        peak: largest possible value, 1 for encoded images in [0, 1].

    Returns:
        decibels; infinity for equal images.

    Raises:
        DtypeError, ShapeError, RangeError: images that do not match, are empty, or not finite.
    """
    _check("psnr", prediction, target)
    peak = require_number("psnr", "peak", peak, least=0.0, open_ends=True)
    difference = prediction.astype(np.float64) - target
    error = float(np.mean(difference * difference))
    return math.inf if error == 0.0 else 10.0 * math.log10(peak * peak / error)


def ssim(prediction: FloatArray, target: FloatArray, *, peak: float = 1.0) -> float:
    """Structural similarity [Wang2004], averaged over positions and channels.

    Protocol: 11 x 11 Gaussian window of sigma 1.5 (weights sum to 1, biased variances),
    K1 = 0.01, K2 = 0.03; only windows that lie inside the image count ("valid"), no downsampling,
    each channel on its own, then the plain mean. All in float64.

    Args:
        prediction, target: (H, W) or (H, W, C), at least 11 x 11, same shape and dtype.
        peak: largest possible value.

    Returns:
        1 for equal images, less otherwise.

    Raises:
        DtypeError, ShapeError, RangeError: images that do not match, too small, or not finite.
    """
    _check("ssim", prediction, target)
    peak = require_number("ssim", "peak", peak, least=0.0, open_ends=True)
    if prediction.ndim not in (2, 3) or min(prediction.shape[:2]) < _WINDOW:
        expected = f"shape (H, W) or (H, W, C), at least {_WINDOW} x {_WINDOW}"
        raise ShapeError(message("ssim", "prediction", expected, prediction.shape))
    x, y = prediction.astype(np.float64), target.astype(np.float64)
    mean_x, mean_y = _blur(x), _blur(y)
    variance_x = _blur(x * x) - mean_x * mean_x
    variance_y = _blur(y * y) - mean_y * mean_y
    covariance = _blur(x * y) - mean_x * mean_y
    c1, c2 = (_K1 * peak) ** 2, (_K2 * peak) ** 2
    luminance = (2.0 * mean_x * mean_y + c1) / (mean_x * mean_x + mean_y * mean_y + c1)
    structure = (2.0 * covariance + c2) / (variance_x + variance_y + c2)
    return float(np.mean(luminance * structure))


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


def _check(function: str, prediction: FloatArray, target: FloatArray) -> None:
    checked = require_float_array(function, "prediction", prediction)
    require_not_empty(function, "prediction", checked)
    require_like(function, "target", target, "prediction", checked)
    for name, image in (("prediction", prediction), ("target", target)):
        bad = int(np.count_nonzero(~np.isfinite(image)))
        if bad:
            got = f"{bad} of {image.size} that are not"
            raise RangeError(message(function, name, "finite values", got))
