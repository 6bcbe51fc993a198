"""Task 01.5, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, hidden_check

from ..common import EXACT
from ..task_5 import scripted
from .common import FAR, MANY, asked_once_a_step, bowls, rate


@hidden_check(
    "01.5.sums",
    points=6,
    calls=("adam",),
    tolerance=EXACT,
    hint="beta1, beta2 and eps are arguments; their defaults are only defaults.",
    battery=[
        Subject(
            "adam",
            lambda t, n: (*bowls(t, n)[1:], rate(n) / 3, n),
            lambda n: Array((n + 1, max(n, 1))),
            **FAR,
        )
    ],
)
def random_gradients_are_weighted_as_they_should(t):
    """With other decays and random gradients the points are those of the sums, written out."""
    n, beta1, beta2, eps = 20, float(t.rng.uniform(0.5, 0.8)), float(t.rng.uniform(0.9, 0.98)), 1e-3
    gradients = t.rng.uniform(0.2, 1.0, (n, 3)) * t.rng.choice([-1.0, 1.0], (n, 3))
    x0 = t.rng.uniform(-1.0, 1.0, 3)
    grad, asked = scripted(gradients)
    got = t.call("adam", grad, x0, 0.1, n, beta1, beta2, eps, returns=Array((n + 1, 3)))
    steps = np.empty((n, 3))
    for k in range(n):
        age = np.arange(k, -1, -1)[:, None]  # of each gradient so far
        mean = np.sum(beta1**age * gradients[: k + 1], axis=0) / np.sum(beta1**age)
        square = np.sum(beta2**age * gradients[: k + 1] ** 2, axis=0) / np.sum(beta2**age)
        steps[k] = -0.1 * mean / (np.sqrt(square) + eps)
    t.close("the steps", np.diff(got, axis=0), steps)
    asked_once_a_step(
        t,
        "adam",
        lambda y: y,
        lambda slope: t.call("adam", slope, x0, 0.01, MANY, returns=Array((MANY + 1, 3))),
    )
    t.close("the points at which the gradient is taken", np.array(asked), got[:-1])
