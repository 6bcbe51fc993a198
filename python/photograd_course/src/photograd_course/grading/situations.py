"""For which class of sizes a call has failed: said of hidden checks too, where it helps most."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

MANY = 100  # rows, from here on
LARGE = 1e6  # magnitudes, from here on


def rows_said(n: int) -> str:
    """The class of a number of rows."""
    if n == 0:
        return "for no rows"
    if n == 1:
        return "for one row"
    return "for many rows" if n >= MANY else ""


def situation_of(args: Sequence[Any]) -> str:
    """The class of the arguments of a call; nothing where they are of everyday size."""
    plain = [value for value in args if isinstance(value, np.ndarray) and value.ndim]
    if any(array.size == 0 for array in plain):  # in a dict, such as a scene, empty is everyday
        return "for no rows"
    numbers = [array for array in _arrays(args) if array.dtype.kind == "f"]
    if not all(np.isfinite(array).all() for array in numbers):
        return "where a value is not finite"
    if any(np.abs(array).max(initial=0.0) >= LARGE for array in numbers):
        return "at a large magnitude"
    rows = [array for array in plain if array.ndim > 1]
    return "for one row" if rows and all(len(array) == 1 for array in rows) else ""


def lengths_of(args: Sequence[Any]) -> set[int]:
    """Lengths of the arrays among arguments, and products of the first of them."""
    found: set[int] = set()
    for array in _arrays(args):
        found.update(int(n) for n in array.shape)
        found.update(int(n) for n in np.cumprod(array.shape))
    return found


def _arrays(value: Any) -> Iterator[np.ndarray[Any, Any]]:
    if isinstance(value, np.ndarray):
        if value.ndim:
            yield value
    elif isinstance(value, dict):
        for each in value.values():
            yield from _arrays(each)
    elif isinstance(value, (list, tuple)):
        for each in value:
            yield from _arrays(each)
