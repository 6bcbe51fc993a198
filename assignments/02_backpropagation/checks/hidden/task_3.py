"""Task 02.3, hidden checks."""

import numpy as np
from photograd_course.grading import hidden_check

from ..common import EXACT, gates
from .common import gate_battery


def positive(rng, n):
    """A number for each use, and no second input."""
    return rng.uniform(0.05, 4.0, n), None


def with_powers(rng, n):
    """A number for each use, and the power."""
    return rng.uniform(0.05, 4.0, n), rng.uniform(-2.5, 2.5, n)


@hidden_check(
    "02.3.many",
    points=3,
    calls=("Value.exp", "Value.log", "Value.__pow__"),
    tolerance=EXACT,
    sole="the same mistakes, to rounding, at unseen places",
    battery=[
        gate_battery("exp", positive, lambda a, _: np.exp(a), lambda a, _: [np.exp(a), 0 * a]),
        gate_battery("log", positive, lambda a, _: np.log(a), lambda a, _: [1 / a, 0 * a]),
        gate_battery("pow", with_powers, lambda a, b: a**b, lambda a, b: [b * a ** (b - 1), 0 * a]),
    ],
)
def gates_of_one_input_at_random(t):
    """exp, log and powers are right at 100 random places."""
    a, n = t.rng.uniform(0.05, 4.0, 100), t.rng.uniform(-2.5, 2.5, 100)
    cases = (
        ("exp", None, np.exp(a), np.exp(a)),
        ("log", None, np.log(a), 1 / a),
        ("pow", n, a**n, n * a ** (n - 1)),
    )
    for op, b, values, slopes in cases:
        found = gates(t, op, a, b)
        t.close(f"values of {op}", found["values"], values)
        t.close(f"local derivatives of {op}", found["slopes"][:, 0], slopes)
