"""Input checks that every function of the course shares; each refuses with one typed sentence."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import DtypeError, RangeError, ShapeError, message

FloatArray = NDArray[Any]
"""An array of float32 or float64; the functions return the dtype that they were given."""


def require_float_array(function: str, argument: str, value: object) -> FloatArray:
    """Return `value` itself when it is a NumPy array of float32 or float64.

    Raises:
        DtypeError: `value` is no array, or has another dtype; nothing is converted silently.
    """
    if not isinstance(value, np.ndarray):
        got = type(value).__name__
        raise DtypeError(message(function, argument, "a NumPy array", got, "use np.asarray"))
    if value.dtype not in (np.float32, np.float64):
        remedy = "convert it yourself, with .astype(np.float64)"
        raise DtypeError(message(function, argument, "float32 or float64", value.dtype, remedy))
    return value


def require_like(
    function: str, argument: str, value: object, reference_name: str, reference: FloatArray
) -> FloatArray:
    """Return `value` when it is an array of the shape and dtype of `reference`.

    Raises:
        DtypeError: no array, or another dtype than the reference.
        ShapeError: another shape; broadcasting is refused, it hides mistakes in losses.
    """
    array = require_float_array(function, argument, value)
    if array.shape != reference.shape:
        expected = f"shape {reference.shape} as {reference_name} has"
        raise ShapeError(message(function, argument, expected, array.shape))
    if array.dtype != reference.dtype:
        expected = f"{reference.dtype} as {reference_name} has"
        raise DtypeError(message(function, argument, expected, array.dtype, "use .astype"))
    return array


def require_mask(
    function: str, argument: str, mask: object, shape: tuple[int, ...]
) -> NDArray[np.bool_]:
    """Return `mask` when it is a boolean array of the given shape.

    Raises:
        DtypeError, ShapeError: it is not boolean, or has another shape.
    """
    if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_:
        got = mask.dtype if isinstance(mask, np.ndarray) else type(mask).__name__
        raise DtypeError(message(function, argument, "a boolean array", got, "compare first"))
    if mask.shape != shape:
        raise ShapeError(message(function, argument, f"shape {shape}", mask.shape))
    return mask


def require_not_empty(function: str, argument: str, array: FloatArray) -> None:
    """Raise ShapeError for an array without elements: its mean does not exist."""
    if array.size == 0:
        raise ShapeError(message(function, argument, "at least one element", array.shape))


def require_number(
    function: str,
    argument: str,
    value: float,
    *,
    least: float = -math.inf,
    most: float = math.inf,
    open_ends: bool = False,
) -> float:
    """Return the finite number `value` when it lies in [least, most], or inside with `open_ends`.

    Raises:
        DtypeError: not a real number (bool is refused too).
        RangeError: not finite, or outside.
    """
    if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
        raise DtypeError(message(function, argument, "a number", type(value).__name__))
    number = float(value)
    inside = least < number < most if open_ends else least <= number <= most
    if not (math.isfinite(number) and inside):
        left, right = ("(", ")") if open_ends else ("[", "]")
        expected = f"a finite number in {left}{least:g}, {most:g}{right}"
        raise RangeError(message(function, argument, expected, number))
    return number


def require_integer(
    function: str, argument: str, value: int, *, least: int, most: int | None = None
) -> int:
    """Return `value` when it is an integer of at least `least` and at most `most`.

    Raises:
        DtypeError: not an integer (bool and 3.0 are refused too).
        RangeError: outside.
    """
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)):
        raise DtypeError(message(function, argument, "an integer", type(value).__name__))
    number = int(value)
    if number < least or (most is not None and number > most):
        bound = f"at least {least}" if most is None else f"in {least}..{most}"
        raise RangeError(message(function, argument, f"an integer {bound}", number))
    return number
