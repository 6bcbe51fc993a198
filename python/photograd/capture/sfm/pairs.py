"""Which photographs are compared with each other."""

from __future__ import annotations

MOST_FOR_ALL = 60
"""Photographs up to which every pair is compared; the work grows with the square of it."""

NEIGHBOURS = 10
KEYS = 30


def choose_pairs(count: int, *, exhaustive: bool | None = None) -> list[tuple[int, int]]:
    """Pairs (i, j), i < j, of photographs 0 to count - 1 in the order of their names.

    All of them for at most 60 photographs. For more, which are taken for a walk in the order of the
    names: each with the ten that follow and with those 16, 32, 64 ... further on, the end with
    the start, as of a walk around something, and 30 key photographs, evenly spread, all with
    each other, so that places are found again.

    Args:
        count: number of photographs.
        exhaustive: all pairs, or the walk, whatever the number.
    """
    if count <= MOST_FOR_ALL if exhaustive is None else exhaustive:
        return [(i, j) for i in range(count) for j in range(i + 1, count)]
    gaps = [*range(1, NEIGHBOURS + 1)]
    gap = 16
    while gap < count:
        gaps.append(gap)
        gap *= 2
    found = {(i, i + gap) for gap in gaps for i in range(count - gap)}
    found |= {(i, count - gap + i) for gap in gaps[:NEIGHBOURS] for i in range(gap) if gap < count}
    keys = sorted({k * count // KEYS for k in range(KEYS)})
    found |= {(i, j) for i in keys for j in keys if i < j}
    return sorted(pair for pair in found if pair[0] < pair[1])
