"""Helpers for the hidden checks of several tasks."""

from photograd_course.grading import Tolerance

SUMS = Tolerance(
    1e-10, "right ones differ by at most 8e-15, the nearest wrong one (T_end_forgotten) by 3e-5"
)


def placed(t, n):
    """A grid, and n points."""
    return t.rng.uniform(-1.0, 1.0, (3, 1, 4, 2)), t.rng.uniform(-0.5, 1.5, (n, 3))
