"""Few values in place of many: tables of 256 numbers, and palettes of vectors."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from photograd.types import Array

ENTRIES = 256
LLOYD_STEPS = 24


def table_of(values: Array) -> tuple[Array, NDArray[np.uint8]]:
    """256 numbers in ascending order (float64), and which of them is nearest to each value.

    Lloyd's method in one dimension [Lloyd1982], from equal shares of the values mixed with equal
    steps. A quarter as many values, evenly spread, are added, so that rare ones far out keep
    entries; the first and the last entry are the extremes, so that no error exceeds half a step.

    Args:
        values: of any shape, finite.
    """
    low, high = float(values.min()), float(values.max())
    spread = np.linspace(low, high, max(values.size // 4, ENTRIES))
    flat = np.sort(np.concatenate([values.astype(np.float64).ravel(), spread]))
    shares = flat[np.linspace(0, len(flat) - 1, ENTRIES).astype(np.int64)]
    table = 0.5 * (shares + np.linspace(flat[0], flat[-1], ENTRIES))
    total = np.concatenate([[0.0], np.cumsum(flat)])
    for _ in range(LLOYD_STEPS):
        ends = np.searchsorted(flat, 0.5 * (table[1:] + table[:-1]))
        first = np.concatenate([[0], ends])
        last = np.concatenate([ends, [len(flat)]])
        count = last - first
        mean = (total[last] - total[first]) / np.maximum(count, 1)
        table = np.where(count > 0, mean, table)
        table[0], table[-1] = flat[0], flat[-1]
        table = np.maximum.accumulate(table)
    nearest = np.searchsorted(0.5 * (table[1:] + table[:-1]), values.astype(np.float64))
    return table, nearest.astype(np.uint8)


def palette_of(rows: Array, largest: int) -> tuple[Array, NDArray[np.int64]]:
    """At most `largest` rows (P, C) that stand for all, and the number of each one's.

    As many as there are, if they are not more. Else the set is halved, at the median of the
    column that varies most in each part [Bentley1975], until there are `largest` parts; a part's
    mean stands for it.

    Args:
        rows: (N, C), finite, N >= 1.
        largest: a power of 2.
    """
    values = rows.astype(np.float64)
    n = len(values)
    if n <= largest:
        return values, np.arange(n)
    order, starts = np.arange(n), np.array([0, n])
    for _ in range(int(largest).bit_length() - 1):
        part = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
        order = _sorted_in_parts(values, order, starts, part)
        middle = (starts[:-1] + starts[1:]) // 2
        starts = np.sort(np.concatenate([starts, middle]))
    count = np.diff(starts)
    label = np.empty(n, np.int64)
    label[order] = np.repeat(np.arange(len(count)), count)
    means = np.add.reduceat(values[order], starts[:-1], axis=0) / count[:, None]
    return means, label


def _sorted_in_parts(
    values: Array, order: NDArray[np.int64], starts: NDArray[np.int64], part: NDArray[np.int64]
) -> NDArray[np.int64]:
    """The order with each part sorted by the column that varies most in it."""
    inside = values[order]
    count = np.diff(starts)[:, None]
    mean = np.add.reduceat(inside, starts[:-1], axis=0) / count
    square = np.add.reduceat(inside * inside, starts[:-1], axis=0) / count
    widest = (square - mean * mean).argmax(axis=1)
    key = np.take_along_axis(inside, widest[part][:, None], axis=1)[:, 0]
    return order[np.lexsort((key, part))]
