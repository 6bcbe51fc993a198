"""Task 01.3, hidden checks."""

import math

import numpy as np
from photograd_course.grading import Array, Items, Subject, Tolerance, Truth, hidden_check

from ..common import EXACT, on_points, rotated_bowl, walk
from .common import FAR, MANY, asked_once_a_step, bowls, rate


def left_domain(t, n):
    """Arguments of `gd_nd`, for n steps of which each ends where f is NaN."""

    def f(x):
        return float(np.sum(x - np.log(x))) if (x > 0.0).all() else math.nan

    return *on_points(2, f, lambda x: 1.0 - 1.0 / x), t.rng.uniform(1.15, 1.2, 2), 12.0, n


@hidden_check(
    "01.3.contraction",
    points=4,
    calls=("gd_nd",),
    tolerance=Tolerance(
        1e-6,
        "over the last 20 steps the factor is right to 4e-16, so 2 % are not needed; "
        "wrong ones differ by 0.08 or more",
    ),
    hint="At the best learning rate each step multiplies the distance by Eq. (11), to the end.",
    battery=[
        Subject(
            "gd_nd",
            lambda t, n: (*bowls(t, n), rate(n), n),
            lambda n: walk(n, max(n, 1)),
            **FAR,
            tolerance=EXACT,
        ),
        Subject(
            "gd_nd",
            left_domain,
            lambda n: Items(Array((n + 1, 2)), Array((n + 1,), finite=False), Truth()),
            sizes=(1, 2),
            large=60,
        ),
    ],
)
def the_condition_number_gives_the_rate(t):
    """At the best learning rate the distance shrinks by (kappa - 1) / (kappa + 1) a step."""
    for kappa in (5.0, 25.0):
        low = float(t.rng.uniform(0.5, 2.0))
        curvatures = low * np.array([1.0, 0.5 + 0.5 * kappa, kappa])
        f, grad, vectors = rotated_bowl(t.rng, curvatures)
        start, n = vectors @ t.rng.uniform(1.0, 2.0, 3), 75 if kappa < 10.0 else 150
        tau = 2.0 / (low + low * kappa)
        x, _, _ = t.call("gd_nd", f, grad, start, tau, n, returns=walk(n, 3))
        asked_once_a_step(
            t,
            "gd_nd",
            grad,
            lambda slope, f=f, at=start: t.call(
                "gd_nd", f, slope, at, 0.01, MANY, returns=walk(MANY, 3)
            ),
        )
        length = np.linalg.norm(np.asarray(x), axis=1)
        t.require(bool(length[-1] > 0.0), "the distance is still far above rounding here")
        t.close(
            f"factor per step, kappa = {kappa:g}",
            (length[n] / length[n - 20]) ** (1.0 / 20.0),
            (kappa - 1.0) / (kappa + 1.0),
        )
