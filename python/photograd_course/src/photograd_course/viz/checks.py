"""Refusals shared by the figures: what a field, a box or an image must be before it is drawn."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import require_float_array
from ..errors import RangeError, ShapeError, message


def check_field(function: str, argument: str, values: object) -> NDArray[np.floating]:
    """A non-empty finite floating-point array (X, Y, Z).

    Raises:
        DtypeError, ShapeError, RangeError: as the name says; the first bad voxel is named.
    """
    array = require_float_array(function, argument, values)
    if array.ndim != 3 or array.size == 0:
        raise ShapeError(message(function, argument, "a non-empty (X, Y, Z)", array.shape))
    return check_finite(function, argument, array)


def check_bounds(function: str, bounds: ArrayLike) -> NDArray[np.float64]:
    """A box (2, 3) in meters: lower corner, then upper corner, strictly larger on every axis.

    Raises:
        ShapeError, RangeError: it is no such box.
    """
    box = np.asarray(bounds, dtype=np.float64)
    if box.shape != (2, 3):
        raise ShapeError(message(function, "bounds", "shape (2, 3)", box.shape))
    if not np.isfinite(box).all() or not (box[1] > box[0]).all():
        raise RangeError(message(function, "bounds", "finite corners, lower < upper", box.tolist()))
    return box


def check_images(
    function: str, argument: str, images: Sequence[object]
) -> list[NDArray[np.floating]]:
    """Display-encoded color images (H, W, 3), floating point, in [0, 1].

    Raises:
        DtypeError, ShapeError, RangeError: naming the image that is wrong.
    """
    if len(images) == 0:
        raise ShapeError(message(function, argument, "at least one image (H, W, 3)", "none"))
    checked = []
    for index, image in enumerate(images):
        name = f"{argument}[{index}]"
        array = require_float_array(function, name, image)
        if array.ndim != 3 or array.shape[2] != 3 or array.size == 0:
            raise ShapeError(message(function, name, "a non-empty (H, W, 3)", array.shape))
        check_finite(function, name, array)
        if array.min() < 0.0 or array.max() > 1.0:
            extremes = f"[{array.min():.4g}, {array.max():.4g}]"
            raise RangeError(
                message(function, name, "display values in [0, 1]", extremes, "encode and clip")
            )
        checked.append(array)
    return checked


def check_finite(
    function: str, argument: str, values: NDArray[np.floating]
) -> NDArray[np.floating]:
    """The array itself if all of it is finite.

    Raises:
        RangeError: naming how many entries are not, and the first of them.
    """
    bad = ~np.isfinite(values)
    if bad.any():
        first = tuple(int(i) for i in np.argwhere(bad)[0])
        got = f"{int(bad.sum())} non-finite, the first at {first}"
        raise RangeError(message(function, argument, "finite values", got))
    return values
