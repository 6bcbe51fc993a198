"""The right values at the wrong places: transposed, reversed, shifted, exchanged."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations
from typing import Any

import numpy as np

Array = np.ndarray[Any, np.dtype[np.float64]]
Same = Callable[[Array, Array], bool]
Said = tuple[str, str]  # with the indices, and without

MOST_SLICES = 64
MOST_NUMBERS = 1_000_000  # of all comparisons of slices
MOST_LISTED = 12
TELLING = 3  # so many different values, or slices, make an order more than a coincidence


def another_order(got: Array, right: Array, same: Same) -> Said | None:
    """How the entries of an answer are another order of the right ones, or None.

    Args:
        got, right: of equal shape, with an axis at least; not the same.
        same: whether two arrays count as equal.

    Returns:
        a sentence with indices, and one without.
    """
    if np.unique(right).size < TELLING or not same(np.sort(got, None), np.sort(right, None)):
        return _shifted(got, right, same)
    return _axes_exchanged(got, right, same) or _slices(got, right, same) or _anyhow()


def _anyhow() -> Said:
    text = "yours has the expected values in another order"
    return text, text


def _axes_exchanged(got: Array, right: Array, same: Same) -> Said | None:
    for a, b in combinations(range(right.ndim), 2):
        if right.shape[a] == right.shape[b] and same(got, right.swapaxes(a, b)):
            which = "" if right.ndim == 2 else f", axes {a} and {b} exchanged"
            return f"yours is the transpose of what is expected{which}", (
                "yours is the transpose of what is expected"
            )
    return None


def _slices(got: Array, right: Array, same: Same) -> Said | None:
    for axis in reversed(range(right.ndim)):
        n = right.shape[axis]
        if n < 2 or n > MOST_SLICES or n * right.size > MOST_NUMBERS:
            continue
        mine, theirs = np.moveaxis(got, axis, 0), np.moveaxis(right, axis, 0)
        order = _permutation(mine, theirs, same)
        if order is not None:
            return _order_said(order, axis, right.ndim)
    return None


def _permutation(mine: Array, theirs: Array, same: Same) -> list[int] | None:
    """For each slice of `mine` the index of its like among `theirs`, each used once."""
    free, order = list(range(len(theirs))), []
    for k in range(len(mine)):
        # Its own place first: of equal slices none has moved.
        alike = [j for j in sorted(free, key=lambda j: j != k) if same(mine[k], theirs[j])]
        if not alike:
            return None
        order.append(alike[0])
        free.remove(alike[0])
    return order if order != sorted(order) else None


def _order_said(order: list[int], axis: int, ndim: int) -> Said:
    n, names = len(order), slices_name(axis, ndim)
    moved = [k for k in range(n) if order[k] != k]
    if n > 2 and order == list(range(n))[::-1]:
        text = f"your {names} are those expected, in reverse order"
        return text, text
    if len(moved) == 2:
        plain = f"two of your {names} are exchanged"
        return f"your {names} {moved[0]} and {moved[1]} are exchanged", plain
    plain = f"your {names} are those expected, in another order"
    for step in (1, -1):
        if n > 2 and order == [(k + step) % n for k in range(n)]:
            text = f"your {names} are those expected, shifted by one in a circle"
            return text, text
    listed = ", ".join(map(str, order))
    return (f"{plain}: {listed}" if n <= MOST_LISTED else plain), plain


def _shifted(got: Array, right: Array, same: Same) -> Said | None:
    """By one along an axis, with something else at the end."""
    for axis in range(right.ndim):
        mine, theirs = np.moveaxis(got, axis, 0), np.moveaxis(right, axis, 0)
        for step, where in ((1, "next"), (-1, "previous")):
            here = slice(None, -1) if step > 0 else slice(1, None)
            there = slice(1, None) if step > 0 else slice(None, -1)
            distinct = len(np.unique(theirs[there], axis=0)) if theirs[there].size else 0
            if distinct >= TELLING and same(mine[here], theirs[there]):
                names = slices_name(axis, right.ndim)
                text = f"your {names} are shifted by one: each is what is expected of the {where}"
                return text, text
    return None


def slices_name(axis: int, ndim: int) -> str:
    """What the slices of an array along an axis are called."""
    if ndim == 1:
        return "entries"
    return ("rows", "columns")[axis] if ndim == 2 else f"slices along axis {axis}"
