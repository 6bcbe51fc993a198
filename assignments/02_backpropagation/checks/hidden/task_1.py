"""Task 02.1, hidden checks."""

import numpy as np
from photograd_course.grading import Subject, hidden_check

from ..common import EXACT, gates, gates_spec


def multiplied(t, n):
    """Arguments of the adapter `gates`, for n products."""
    return "mul", *t.rng.normal(0.0, 3.0, (2, n))


@hidden_check(
    "02.1.many",
    points=3,
    calls=("Value.__add__", "Value.__mul__"),
    tolerance=EXACT,
    sole="the same mistakes, to rounding, at unseen places",
    battery=[
        Subject(
            "adapters.gates",
            multiplied,
            gates_spec,
            right=lambda *args: {"values": args[2] * args[3], "slopes": np.stack(args[3:1:-1], 1)},
            sizes=(1, 7),
        )
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
