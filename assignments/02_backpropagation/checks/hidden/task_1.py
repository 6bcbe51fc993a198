"""Task 02.1, hidden checks."""

import numpy as np
from photograd_course.grading import hidden_check

from ..common import EXACT, gates
from .common import gate_battery, normal_pairs


@hidden_check(
    "02.1.many",
    points=3,
    calls=("Value.__add__", "Value.__mul__"),
    tolerance=EXACT,
    sole="the same mistakes, to rounding, at unseen places",
    battery=[
        gate_battery(
            "add", normal_pairs, lambda a, b: a + b, lambda a, b: [np.ones(len(a)), np.ones(len(b))]
        ),
        gate_battery("mul", normal_pairs, lambda a, b: a * b, lambda a, b: [b, a]),
    ],
)
def sums_and_products_at_random(t):
    """Values and local derivatives of sums and products are right at 100 random places."""
    a, b = t.rng.normal(0.0, 3.0, (2, 100))
    ones = np.ones(100)
    for op, right, slopes in (("add", a + b, [ones, ones]), ("mul", a * b, [b, a])):
        found = gates(t, op, a, b)
        t.close(f"values of {op}", found["values"], right)
        t.close(f"local derivatives of {op}", found["slopes"], np.stack(slopes, 1))
