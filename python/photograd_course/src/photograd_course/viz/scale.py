"""The symmetric color scale of a signed field, and which of its ends are clipped."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..checks import require_number
from ..errors import RangeError, message

Extend = Literal["neither", "min", "max", "both"]


@dataclass(frozen=True)
class Scale:
    """Colors span [-limit, limit]; values beyond it get the end color and an arrow on the bar."""

    limit: float
    extend: Extend


def signed_scale(
    function: str, fields: Iterable[NDArray[Any]], limit: float | None, *, quantile: float = 0.999
) -> Scale:
    """A common scale for ``fields``: ``limit`` itself, or a quantile rounded up to a round number.

    The quantile is taken over the non-zero magnitudes, since the gradient of a volume is zero in
    most voxels and very large in a few, and either would leave the picture white.

    Raises:
        RangeError: ``limit`` is not a positive finite number.
    """
    arrays = list(fields)
    magnitudes = [np.abs(array[array != 0.0]) for array in arrays]
    if limit is None:
        magnitude = np.concatenate(magnitudes) if magnitudes else np.zeros(0)
        limit = nice_limit(float(np.quantile(magnitude, quantile)) if magnitude.size else 0.0)
    elif require_number(function, "limit", limit) <= 0.0:
        raise RangeError(message(function, "limit", "a positive number", limit))
    below = any(float(array.min()) < -limit for array in arrays)
    above = any(float(array.max()) > limit for array in arrays)
    if below and above:
        return Scale(limit, "both")
    return Scale(limit, "min" if below else "max" if above else "neither")


def nice_limit(value: float) -> float:
    """The next round number at or above ``value`` (1 for zero), so that color bars read well."""
    if value <= 0.0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(value))
    # The slack keeps 0.3 = 3 * 10**-1 at 3 although 0.3 / 0.1 is a little above 3 in binary.
    steps = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)
    return next(step for step in steps if value <= step * power * (1.0 + 1e-9)) * power
