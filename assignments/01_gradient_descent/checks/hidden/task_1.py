"""Task 01.1, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, hidden_check

from ..common import derivative
from ..task_1 import DIFFERENCE


def cubics(t, n):
    """A function of n variables with a third derivative, where, and how far to move."""
    a = t.rng.uniform(0.5, 2.0, n)
    return lambda x: float(np.sum(a * x**3 - x**2)), t.rng.uniform(1.0, 2.0, n), 0.1


@hidden_check(
    "01.1.cubic",
    points=4,
    calls=("numeric_derivative",),
    tolerance=DIFFERENCE,
    hint="For a x^3 the result is 3 a x^2 + a eps^2 exactly: Eq. (4) has no further term.",
    battery=[Subject("numeric_derivative", cubics, lambda n: Array((n,)), large=300)],
)
def a_cubic_is_off_by_a_known_amount(t):
    """For a cubic the error is eps^2 times a sixth of the third derivative, exactly."""
    for eps in (1.0, 0.5):
        a, b = t.rng.uniform(0.5, 2.0, 2)
        x = np.array([float(t.rng.uniform(1.5, 3.0))])
        got = derivative(t, lambda y, a=a, b=b: float(a * y[0] ** 3 + b * y[0]), x, eps)
        excess = got - 3.0 * a * x**2 - b
        t.close("the error", excess, np.array([a * eps**2]))
