"""Things by their distance from an eye, for blending (far ones first) or early tests (near ones).

The routine is the stable radix sort that puts Gaussians in order (cpp/photograd/splat/sort.h).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from photograd._compiled import _core
from photograd.errors import ShapeError, message
from photograd.geometry.checks import finite_rows


def order_by_distance(points: Any, eye: Any, *, far_first: bool = False) -> npt.NDArray[np.uint32]:
    """Row numbers (N,) of points (N, 3), sorted by their distance from `eye` (3,).

    Equally distant points keep the order of their rows, whichever end comes first.

    Raises:
        ShapeError: points that are not (N, 3), an eye that is not (3,).
        RangeError: numbers that are not finite.
    """
    rows = finite_rows("order_by_distance", "points", points)
    if np.shape(eye) != (3,):
        raise ShapeError(message("order_by_distance", "eye", "shape (3,)", np.shape(eye)))
    (place,) = finite_rows("order_by_distance", "eye", [eye])
    squared = ((rows - place) ** 2).sum(axis=1)
    order: npt.NDArray[np.uint32] = _core.order_by_depth(squared, far_first)
    return order
