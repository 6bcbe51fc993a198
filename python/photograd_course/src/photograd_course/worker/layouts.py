"""Arguments as callers may have them: read-only arrays, and views with gaps or run backwards."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

Array = np.ndarray[Any, np.dtype[Any]]


def plain(array: Array) -> Array:
    """Contiguous, and free to be written to."""
    return array.copy()


def read_only(array: Array) -> Array:
    """Contiguous; writing to it raises ValueError."""
    copy = array.copy()
    copy.flags.writeable = False
    return copy


def strided(array: Array) -> Array:
    """A view with gaps between the elements, which hold NaN where that exists."""
    if array.ndim == 0:
        return array.copy()
    gap = np.nan if array.dtype.kind == "f" else 0
    wide = np.full((*array.shape[:-1], 2 * array.shape[-1]), gap, array.dtype)
    wide[..., ::2] = array
    return wide[..., ::2]


def backwards(array: Array) -> Array:
    """A view that runs against memory along each axis."""
    turned = (slice(None, None, -1),) * array.ndim
    return np.ascontiguousarray(array[turned]).reshape(array.shape)[turned]


LAYOUTS: dict[str, Callable[[Array], Array]] = {
    "plain": plain,
    "read-only": read_only,
    "strided": strided,
    "backwards": backwards,
}


def laid_out(value: Any, layout: str) -> Any:
    """The same value; all arrays in it, and in its lists and dicts, in another layout."""
    if isinstance(value, np.ndarray):
        return LAYOUTS[layout](value)
    if isinstance(value, list):
        return [laid_out(item, layout) for item in value]
    if isinstance(value, dict):
        return {key: laid_out(item, layout) for key, item in value.items()}
    return value


def without_functions(value: Any) -> Any:
    """The same value with None in the place of functions."""
    if isinstance(value, list):
        return [without_functions(item) for item in value]
    if isinstance(value, dict):
        return {key: without_functions(item) for key, item in value.items()}
    return None if callable(value) else value
