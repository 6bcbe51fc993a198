"""Helpers for the hidden checks of several tasks."""

import numpy as np
from photograd_course.grading import Subject

from ..common import gates_spec


def gate_battery(op, draw, values, slopes):
    """The battery of one gate.

    Args:
        op: its name.
        draw: (a, b) of n uses, from random numbers and n; b is None where there is none.
        values, slopes: what is right for a and b: values (N,), and two local derivatives (N,).
    """
    return Subject(
        "adapters.gates",
        lambda t, n: (op, *draw(t.rng, n)),
        gates_spec,
        right=lambda _ref, _op, a, b: {"values": values(a, b), "slopes": np.stack(slopes(a, b), 1)},
        sizes=(1, 7),
    )


def normal_pairs(rng, n):
    """Two numbers of either sign for each use."""
    return rng.normal(0.0, 3.0, (2, n))
