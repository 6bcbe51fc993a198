"""Rays and intervals that functions of this folder take, converted to float64 and checked."""

from __future__ import annotations

from typing import Any

import numpy as np

from photograd._arrays import Arguments
from photograd.errors import RangeError, message
from photograd.types import Array


def checked_rays(call: Arguments, origins: Any, directions: Any) -> tuple[Array, Array]:
    """Origins and directions (R, 3) as float64.

    Raises:
        ShapeError: other shapes, or different ones.
        RangeError: numbers that are not finite, or a direction of length 0; names the row.
    """
    starts = call.array("origins", origins, ("R", 3), dtype=np.float64)
    along = call.array("directions", directions, ("R", 3), dtype=np.float64)
    still = ~along.any(axis=1)
    if still.any():
        row = int(np.flatnonzero(still)[0])
        raise RangeError(message(call.function, "directions", "some length", f"none in row {row}"))
    return starts, along


def checked_interval(call: Arguments, t_min: float, t_max: float) -> tuple[float, float]:
    """Both as numbers that are no NaN; an empty interval is allowed.

    Raises:
        RangeError: NaN, or an infinite t_min.
    """
    low = call.array("t_min", t_min, (), dtype=np.float64)
    high = call.array("t_max", t_max, (), dtype=np.float64, finite=False, low=-np.inf)
    return float(low), float(high)
