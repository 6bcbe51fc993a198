"""Rows of numbers that functions of this folder take, converted to float64 and checked."""

from __future__ import annotations

from typing import Any

import numpy as np

from photograd.errors import RangeError, ShapeError, message
from photograd.types import Array


def finite_rows(function: str, argument: str, value: Any, columns: int = 3) -> Array:
    """`value` as a C-contiguous float64 array (N, columns).

    Raises:
        ShapeError: another shape.
        RangeError: a number that is not finite; names its row.
    """
    rows = np.ascontiguousarray(value, np.float64)
    if rows.ndim != 2 or rows.shape[1] != columns:
        raise ShapeError(message(function, argument, f"shape (N, {columns})", rows.shape))
    if not np.isfinite(rows).all():
        row = int(np.flatnonzero(~np.isfinite(rows).all(axis=1))[0])
        raise RangeError(message(function, argument, "finite numbers", f"{rows[row]} in row {row}"))
    return rows


def checked_rays(function: str, origins: Any, directions: Any) -> tuple[Array, Array]:
    """Origins and directions (R, 3) as float64.

    Raises:
        ShapeError: other shapes, or different ones.
        RangeError: numbers that are not finite, or a direction of length 0; names the row.
    """
    starts = finite_rows(function, "origins", origins)
    ways = finite_rows(function, "directions", directions)
    if starts.shape != ways.shape:
        expected = f"shape {starts.shape} as origins"
        raise ShapeError(message(function, "directions", expected, ways.shape))
    still = ~ways.any(axis=1)
    if still.any():
        row = int(np.flatnonzero(still)[0])
        raise RangeError(message(function, "directions", "some length", f"none in row {row}"))
    return starts, ways


def checked_interval(function: str, t_min: float, t_max: float) -> tuple[float, float]:
    """Both as numbers that are no NaN; an empty interval is allowed.

    Raises:
        RangeError: NaN, or an infinite t_min.
    """
    low, high = float(t_min), float(t_max)
    if not np.isfinite(low) or np.isnan(high):
        raise RangeError(message(function, "t_min, t_max", "a finite and a number", (low, high)))
    return low, high
