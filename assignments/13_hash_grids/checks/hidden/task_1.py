"""Task 13.1, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Subject, hidden_check

from ..common import EXACT, whole
from ..task_1 import counting, same_cubes, tabulated


def bumps(t, D):
    """A smooth field of two channels that is nearly constant in most places."""
    middle, width = t.rng.uniform(0.2, 0.8, (2, D)), t.rng.uniform(0.05, 0.2, 2)
    return lambda x: np.exp(-((x[:, None] - middle) ** 2).sum(axis=2) / width**2)


def bumpy(t, n):
    """Arguments of `tabulate`, for a cube whose side is the power of two up to n."""
    field = counting(bumps(t, 2), 2, [])
    return field, 1 << n.bit_length() - 1, t.rng.uniform(0.0, 1.0, (3, 2)), 0.0


def leaves_of(n):
    side = 1 << n.bit_length() - 1
    return Items(Array((side, side), "i8"), Array((side * side, 2)))


def found(_t, _args, answer):
    """What right leaves have in common, in any order: which cells share one, and its values."""
    leaf, values = answer
    return [same_cubes(leaf).astype(float), values[leaf]]


@hidden_check(
    "13.1.hidden",
    points=2,
    calls=("tabulate",),
    tolerance=EXACT,
    sole="the same mistakes in unseen fields",
    battery=[Subject("tabulate", bumpy, leaves_of, common=found, large=32)],
)
def leaves_of_random_fields(t):
    """Leaves of smooth random fields are the largest cubes within the tolerance."""
    for D, n, tolerance in ((2, 32, 0.05), (3, 8, 0.1), (2, 2, 0.3)):
        field, offsets = bumps(t, D), t.rng.uniform(0.0, 1.0, (4, D))
        leaf, values = tabulated(t, field, n, offsets, tolerance)
        right = t.reference.tabulate(field, n, offsets, tolerance)
        whole(t, "cells in the leaf of each cell", same_cubes(leaf), same_cubes(right[0]))
        t.close("values", values[leaf], right[1][right[0]])
