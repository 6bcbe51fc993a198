"""How far a prediction is from its target, and the gradient of that distance.

Every loss is the MEAN over all elements (pixels times channels), so that the gradient per pixel
shrinks with the size of the batch and a learning rate means the same for any batch. Sums run in
float64 whatever the dtype. Targets are constants: only the prediction has a gradient.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .checks import FloatArray, require_like, require_not_empty, require_number
from .checks import require_float_array as require_array


def l2(prediction: FloatArray, target: FloatArray) -> float:
    """Mean squared error: mean((prediction - target)^2).

    Args:
        prediction: any shape, float32 or float64.
        target: same shape and dtype.

    Raises:
        DtypeError, ShapeError: the two do not match exactly; nothing broadcasts.
    """
    difference = _difference("l2", prediction, target)
    return _mean(np.multiply(difference, difference, out=difference))


def l2_backward(prediction: FloatArray, target: FloatArray, d_loss: float = 1.0) -> FloatArray:
    """d_prediction = d_loss * 2 (prediction - target) / N, with N the number of elements."""
    d_prediction = _difference("l2_backward", prediction, target)
    d_prediction *= _share("l2_backward", d_loss, d_prediction.size) * 2.0
    return d_prediction


def l1(prediction: FloatArray, target: FloatArray) -> float:
    """Mean absolute error: mean(|prediction - target|). Arguments and errors as for `l2`."""
    difference = _difference("l1", prediction, target)
    return _mean(np.abs(difference, out=difference))


def l1_backward(prediction: FloatArray, target: FloatArray, d_loss: float = 1.0) -> FloatArray:
    """d_prediction = d_loss * sign(prediction - target) / N; 0 where the two are equal."""
    difference = _difference("l1_backward", prediction, target)
    d_prediction: FloatArray = np.sign(difference, out=difference)
    d_prediction *= _share("l1_backward", d_loss, d_prediction.size)
    return d_prediction


def huber(prediction: FloatArray, target: FloatArray, *, delta: float) -> float:
    """Mean of r^2 / 2 where |r| <= delta, else delta (|r| - delta / 2) [Huber1964].

    Value and slope are continuous; outliers pull with at most `delta`.

    Args:
        prediction, target: as for `l2`; r = prediction - target.
        delta: where the parabola becomes a line, > 0, in units of the prediction.

    Raises:
        DtypeError, ShapeError, RangeError: arrays that do not match, or a bad delta.
    """
    delta = require_number("huber", "delta", delta, least=0.0, open_ends=True)
    size = np.abs(_difference("huber", prediction, target))
    core = np.minimum(size, delta)
    # With c = min(|r|, delta) both branches are c (|r| - c / 2).
    return _mean(core * (size - 0.5 * core))


def huber_backward(
    prediction: FloatArray, target: FloatArray, d_loss: float = 1.0, *, delta: float
) -> FloatArray:
    """d_prediction = d_loss * clip(prediction - target, -delta, delta) / N."""
    delta = require_number("huber_backward", "delta", delta, least=0.0, open_ends=True)
    difference = _difference("huber_backward", prediction, target)
    d_prediction: FloatArray = np.clip(difference, -delta, delta, out=difference)
    d_prediction *= _share("huber_backward", d_loss, d_prediction.size)
    return d_prediction


def _difference(function: str, prediction: FloatArray, target: FloatArray) -> FloatArray:
    checked = require_array(function, "prediction", prediction)
    require_not_empty(function, "prediction", checked)
    like = require_like(function, "target", target, "prediction", checked)
    return np.asarray(np.subtract(checked, like))


def _share(function: str, d_loss: float, count: int) -> float:
    return require_number(function, "d_loss", d_loss) / count


def _mean(values: Any) -> float:
    return float(np.mean(values, dtype=np.float64))
