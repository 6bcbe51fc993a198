"""Task 02.2, hidden checks."""

import numpy as np
from photograd_course.grading import hidden_check

from ..common import EXACT, gates
from .common import gate_battery


def whole_numbers(rng, n):
    """Two numbers for each use, which are often equal."""
    return rng.integers(-2, 3, (2, n)).astype(float)


@hidden_check(
    "02.2.many",
    points=2,
    calls=("Value.maximum",),
    tolerance=EXACT,
    sole="the same mistakes at unseen places",
    battery=[
        gate_battery(
            "max",
            whole_numbers,
            np.maximum,
            lambda a, b: [(a > b).astype(float), (a <= b).astype(float)],
        )
    ],
)
def maximum_at_random(t):
    """maximum is right at 100 random places."""
    a, b = t.rng.normal(0.0, 3.0, (2, 100))
    found = gates(t, "max", a, b)
    t.close("values of maximum", found["values"], np.maximum(a, b))
    t.close(
        "local derivatives of maximum", found["slopes"], np.stack([a > b, a < b], 1).astype(float)
    )
