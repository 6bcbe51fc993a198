"""Helpers for the checks of several tasks."""

import numpy as np
from photograd_course.grading import Tolerance

# Evidence: worst of the solution and the alternatives over several seeds, against the nearest of
# all named wrong solutions.
EXACT = Tolerance(1e-11, "right ones differ by 1e-15, wrong ones by 1e-3 or more")
FAITHFUL = Tolerance(1e-12, "numbers that are handed on unchanged")


def whole(t, what, got, right, hint=""):
    """Integers that must be equal, all of them."""
    t.close(what, got, right, FAITHFUL, reveal=True, hint=hint)


def layout(resolutions, dimensions, most):
    """Levels (L, 3): resolution, first row, rows; all corners where they fit into `most` rows."""
    rows = np.minimum((np.array(resolutions) + 1) ** dimensions, most)
    return np.stack([np.array(resolutions), np.cumsum(rows) - rows, rows], axis=1)


def table_for(t, levels, features=2):
    """A random table (R, F) of these levels, no row like another."""
    return t.rng.uniform(-1.0, 1.0, (int(levels[-1, 1] + levels[-1, 2]), features))


def points_within(t, count, dimensions, levels, margin=0.02):
    """Points (count, D), none closer to a face of a cell of any level than margin of the cell."""
    points = np.zeros((0, dimensions))
    while len(points) < count:
        more = t.rng.uniform(0.0, 1.0, (4 * count + 50, dimensions))
        within = np.ones(len(more), bool)
        for n in levels[:, 0]:
            part = more * n % 1.0
            within &= ((part > margin) & (part < 1 - margin)).all(axis=1)
        points = np.concatenate([points, more[within]])
    return points[:count]
