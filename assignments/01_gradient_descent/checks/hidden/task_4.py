"""Task 01.4, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, Tolerance, hidden_check

from .common import FAR, MANY, asked_once_a_step, bowls, rate


@hidden_check(
    "01.4.roots",
    points=5,
    calls=("momentum",),
    tolerance=Tolerance(1e-11, "right answers differ by 4e-15 at most, wrong ones by 0.2 or more"),
    hint="The gradient is taken at the point, not where the velocity would lead.",
    battery=[
        Subject(
            "momentum",
            lambda t, n: (*bowls(t, n)[1:], rate(n) / 3, 0.7, n),
            lambda n: Array((n + 1, max(n, 1))),
            **FAR,
        )
    ],
)
def a_parabola_swings_as_two_roots_say(t):
    """On a quadratic each component is a sum of two powers, damped oscillations among them."""
    curvatures = np.array([0.1, 1.0, 6.0]) * t.rng.uniform(0.9, 1.1, 3)
    x0, n = t.rng.uniform(1.0, 2.0, 3), 25
    tau, beta = 0.3, float(t.rng.uniform(0.6, 0.85))
    x = t.call("momentum", lambda y: curvatures * y, x0, tau, beta, n, returns=Array((n + 1, 3)))
    expected = np.empty((n + 1, 3))
    for i, curvature in enumerate(curvatures):
        first, second = np.roots([1.0, -(1.0 + beta - tau * curvature), beta]).astype(complex)
        weight = (1.0 - tau * curvature - second) / (first - second)
        powers = np.arange(n + 1)
        expected[:, i] = (x0[i] * (weight * first**powers + (1 - weight) * second**powers)).real
    t.close("the points", x, expected)
    asked_once_a_step(
        t,
        "momentum",
        lambda y: curvatures * y,
        lambda slope: t.call("momentum", slope, x0, 0.01, beta, MANY, returns=Array((MANY + 1, 3))),
    )
