"""Task 01.4, public checks."""

import numpy as np
from photograd_course.grading import Array, checks_for

from .common import EXACT

check = checks_for(calls=("momentum",), tolerance=EXACT)


@check(
    "01.4.constant",
    points=4,
    sole="arithmetic that a student can do by hand; the others need the run to bend",
    hint="With a constant gradient the steps grow toward tau g / (1 - beta), Eq. (14).",
)
def a_constant_slope_leads_to_a_terminal_velocity(t):
    """For a linear function the k-th step is tau g (1 - beta^k) / (1 - beta) long."""
    g, x0 = t.rng.uniform(0.5, 2.0, 3) * t.rng.choice([-1.0, 1.0], 3), t.rng.uniform(-1.0, 1.0, 3)
    tau, beta, n = 0.1, float(t.rng.uniform(0.5, 0.9)), 30
    x = t.call("momentum", lambda _: g, x0, tau, beta, n, returns=Array((n + 1, 3)))
    lengths = (1.0 - beta ** np.arange(1, n + 1)) / (1.0 - beta)
    t.close("the steps", np.diff(x, axis=0), -tau * lengths[:, None] * g)


@check(
    "01.4.plain",
    points=3,
    hint="With beta = 0 there is no memory: the run is that of gradient descent.",
)
def without_memory_it_is_gradient_descent(t):
    """With beta = 0 a quadratic contracts by 1 - tau lambda_i, as without momentum."""
    curvatures = t.rng.uniform(0.5, 2.0, 3)
    x0, tau, n = t.rng.uniform(1.0, 2.0, 3), 0.4, 10
    x = t.call("momentum", lambda y: curvatures * y, x0, tau, 0.0, n, returns=Array((n + 1, 3)))
    t.close("the points", x, x0 * (1.0 - tau * curvatures) ** np.arange(n + 1)[:, None])
