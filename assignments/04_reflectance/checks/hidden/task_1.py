"""Task 04.1, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, hidden_check

from ..common import EXACT
from ..task_1 import room


def some_model(t, n):
    """A model that `furnace` integrates, and the cosines of n viewers."""
    a, b = t.rng.uniform(0.5, 2.0, (3, 2)), t.rng.uniform(0.3, 1.0, (1, 2))
    return lambda wo, wi: np.exp(wi @ a * wo[:, 2:]) * b + wo @ a, t.rng.uniform(0.1, 1.0, n)


@hidden_check(
    "04.1.hidden",
    points=2,
    calls=("furnace",),
    tolerance=EXACT,
    sole="the same mistakes with unseen models",
    battery=[Subject("furnace", some_model, lambda n: Array((n, 2)), rows=(1,), large=40)],
)
def other_models(t):
    """An unseen model is integrated rightly."""
    a, b = t.rng.uniform(0.5, 2.0, (3, 2)), t.rng.uniform(0.3, 1.0, (1, 2))
    cosines = t.rng.uniform(0.1, 1.0, 3)

    def value(wo, wi):
        return np.exp(wi @ a * wo[:, 2:]) * b + wo @ a

    right = t.reference.furnace(value, cosines)
    t.close("albedo", room(t, value, 2, cosines), right)
