"""Task 11.2, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, hidden_check
from photograd_course.grading.generators import unit_vectors

from ..common import EXACT


def weighted(t, n):
    """Arguments of `sh_project`, for n directions."""
    return unit_vectors(t.rng, n), t.rng.uniform(0.1, 1.0, n), t.rng.uniform(-1.0, 1.0, (n, 2)), 3


@hidden_check(
    "11.2.hidden",
    points=3,
    calls=("sh_project",),
    needs=("sh_basis",),
    tolerance=EXACT,
    sole="the same mistakes at unseen values",
    battery=[Subject("sh_project", weighted, lambda _: Array((16, 2)))],
)
def projections_of_random_values(t):
    """Projections of random values are right, with weights of any kind."""
    for degree, n in ((4, 30), (0, 3), (2, 11)):
        d, weights = unit_vectors(t.rng, n), t.rng.uniform(0.1, 1.0, n)
        weights *= 4 * np.pi / weights.sum()
        f = t.rng.uniform(-1.0, 1.0, (n, 3))
        got = t.call("sh_project", d, weights, f, degree, returns=Array(((degree + 1) ** 2, 3)))
        t.close(f"degree {degree}", got, t.reference.sh_project(d, weights, f, degree))
