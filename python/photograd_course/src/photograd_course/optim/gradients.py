"""Gradients as optimizers take them: an array like the parameter, or (rows, values)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..checks import FloatArray, require_float_array, require_like
from ..errors import DtypeError, RangeError, ShapeError, message

Rows = NDArray[np.int64]
Gradient = FloatArray | tuple[Rows, FloatArray]
"""Dense, or (rows (M,) int64 strictly increasing, values (M, ...)); other rows stay as they are."""


def merge_rows(rows: Rows, values: FloatArray) -> tuple[Rows, FloatArray]:
    """Sort rows and add up the values of equal ones, in their given order: a valid gradient."""
    require_float_array("merge_rows", "values", values)
    unique, inverse = np.unique(rows, return_inverse=True)
    sums = np.zeros((unique.size, *values.shape[1:]), dtype=values.dtype)
    np.add.at(sums, inverse, values)
    return unique.astype(np.int64), sums


def check_gradient_form(name: str, parameter: FloatArray, gradient: Gradient) -> None:
    """Refuse a gradient that does not belong to its parameter, before anything is changed.

    Raises:
        DtypeError, ShapeError: another dtype or shape than the parameter.
        RangeError: rows out of range, not strictly increasing, or values that are not finite.
    """
    argument = f"gradients[{name!r}]"
    if isinstance(gradient, tuple):
        values = _check_rows(argument, name, parameter, gradient)
    else:
        values = require_like("step", argument, gradient, f"params[{name!r}]", parameter)
    if not all_finite(values):
        bad = int(values.size - np.count_nonzero(np.isfinite(values)))
        got = f"{bad} of {values.size} that are not"
        raise RangeError(message("step", argument, "finite values", got, "nothing was changed"))


def all_finite(values: FloatArray) -> bool:
    """Whether no value is infinite or NaN; reads the array once, without an array of answers."""
    if values.size == 0:
        return True
    # The smallest and the largest value are finite exactly if all are: NaN wins both.
    return bool(np.isfinite(values.min()) and np.isfinite(values.max()))


def _check_rows(
    argument: str, name: str, parameter: FloatArray, gradient: tuple[Any, Any]
) -> FloatArray:
    if len(gradient) != 2:
        raise ShapeError(message("step", argument, "(rows, values)", f"{len(gradient)} items"))
    rows, values = gradient
    if not isinstance(rows, np.ndarray) or rows.dtype != np.int64:
        got = getattr(rows, "dtype", type(rows).__name__)
        raise DtypeError(message("step", f"{argument} rows", "an int64 array", got))
    if rows.ndim != 1 or parameter.ndim == 0:
        raise ShapeError(message("step", f"{argument} rows", "shape (M,)", rows.shape))
    values = require_float_array("step", f"{argument} values", values)
    expected = (rows.size, *parameter.shape[1:])
    if values.shape != expected:
        raise ShapeError(message("step", f"{argument} values", f"shape {expected}", values.shape))
    if values.dtype != parameter.dtype:
        like = f"{parameter.dtype} as params[{name!r}] has"
        raise DtypeError(message("step", f"{argument} values", like, values.dtype))
    if rows.size and (int(rows[0]) < 0 or int(rows[-1]) >= parameter.shape[0]):
        got = f"{rows[0]} .. {rows[-1]}"
        raise RangeError(message("step", f"{argument} rows", f"0 .. {parameter.shape[0] - 1}", got))
    if not (rows[1:] > rows[:-1]).all():
        got = "an unsorted or repeated row"
        remedy = "use merge_rows"
        raise RangeError(message("step", f"{argument} rows", "strictly increasing", got, remedy))
    return values
