"""Renderings that are not finite are reported with their place, not handed on."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from photograd.errors import Error, message

Place = Callable[[tuple[int, ...]], str]


def require_finite(function: str, outputs: Mapping[str, NDArray[Any] | None], place: Place) -> None:
    """Check what a renderer returns.

    Args:
        function: the renderer, for the error.
        outputs: arrays by name; None is skipped.
        place: what an index of an array is called, such as a pixel.

    Raises:
        Error: an array with NaN or infinity, and where the first one is.
    """
    for name, array in outputs.items():
        if array is None:
            continue
        with np.errstate(over="ignore", invalid="ignore"):
            if np.isfinite(array.sum()):  # one pass; the sum alone may overflow, too
                continue
        bad = np.argwhere(~np.isfinite(array))
        if len(bad):
            got = f"{len(bad)} that are not, the first in {place(tuple(bad[0].tolist()))}"
            remedy = "a parameter holds NaN, infinity, or a number too large to add up"
            raise Error(message(function, name, "finite values", got, remedy))
