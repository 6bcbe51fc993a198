"""Checks of the toy assignment."""

from __future__ import annotations

import numpy as np
from photograd_course.grading import Array, Items, Number, Tolerance, check
from photograd_course.grading.adjoint_gate import (
    random_cotangent,
    require_cheap,
    require_gradients,
    require_zero_for_zero,
)

ROUNDING = Tolerance(1e-12, "two orders of summation differ by 2e-16")


@check(
    "90.1.value",
    task="90.1",
    points=3,
    calls=("weighted_sum",),
    tolerance=ROUNDING,
    sole="students need a public check; the hidden one repeats it",
)
def value_at_known_points(t):
    """exp(0) = 1 and exp(-log 2) = 1/2 give the sums they must."""
    w = t.rng.uniform(1.0, 2.0, 5)
    t.close("s", t.call("weighted_sum", w, np.zeros(5), returns=Number()), w.sum(), reveal=True)
    halves = np.full(5, np.log(2.0))
    t.close("s", t.call("weighted_sum", w, halves, returns=Number()), w.sum() / 2, reveal=True)


@check(
    "90.2.differences",
    task="90.2",
    points=3,
    calls=("weighted_sum_backward",),
    needs=("weighted_sum",),
)
def derivatives_agree_with_differences(t):
    """Both derivatives agree with central differences of your own forward function."""
    point = {"w": t.rng.uniform(0.5, 2.0, 6), "x": t.rng.uniform(-1.0, 1.0, 6)}
    d_s = float(random_cotangent(t.rng, (1,))[0])
    pair = Items(Array((6,)), Array((6,)), names=("d_w", "d_x"))
    d_w, d_x = t.call("weighted_sum_backward", point["w"], point["x"], d_s, returns=pair)

    def forward(p):
        return t.call("weighted_sum", p["w"], p["x"], returns=Number())

    require_gradients(t, {"w": d_w, "x": d_x}, forward, point, np.asarray(d_s))
    d_w, d_x = t.call("weighted_sum_backward", point["w"], point["x"], 0.0, returns=pair)
    require_zero_for_zero(t, {"w": d_w, "x": d_x})


@check("90.3.services", task="90.3", points=3, calls=("descend",), tolerance=ROUNDING)
def a_quadratic_contracts(t):
    """On a quadratic of curvature lambda each step shrinks x by 1 - tau lambda."""
    curvature = t.rng.uniform(0.5, 1.5, 3)
    x0 = t.rng.uniform(1.0, 2.0, 3)
    trail = t.call("descend", lambda x: curvature * x, x0, 0.5, 4, returns=Array((5, 3)))
    factor = (1 - 0.5 * curvature)[None, :] ** np.arange(5)[:, None]
    t.close("points", trail, factor * x0)


# >>> hidden
@check(
    "90.1.hidden",
    task="90.1",
    points=3,
    calls=("weighted_sum",),
    visibility="hidden",
    tolerance=ROUNDING,
    sole="the same mistakes, at points that are not known beforehand",
)
def value_at_random_points(t):
    """The sum is right at random points."""
    w, x = t.rng.uniform(0.5, 2.0, 7), t.rng.uniform(-2.0, 2.0, 7)
    s = t.call("weighted_sum", w, x, returns=Number())
    t.close("s", s, t.reference.weighted_sum(w, x))


@check(
    "90.2.cost",
    task="90.2",
    points=3,
    calls=("weighted_sum_backward",),
    visibility="hidden",
    needs=("weighted_sum",),
    tolerance=ROUNDING,
    seconds=5.0,
)
def the_derivative_is_cheap(t):
    """With 4,000 parameters the derivative is right, and costs a few forward calls."""
    w, x = t.rng.uniform(0.5, 2.0, 2000), t.rng.uniform(-2.0, 2.0, 2000)
    pair = Items(Array((2000,)), Array((2000,)), names=("d_w", "d_x"))
    d_w, d_x = t.call("weighted_sum_backward", w, x, 0.7, returns=pair)
    right = t.reference.weighted_sum_backward(w, x, 0.7)
    t.close("d_w", d_w, right[0])
    t.close("d_x", d_x, right[1])
    require_cheap(
        t, ("weighted_sum", (w, x), Number()), ("weighted_sum_backward", (w, x, 0.7), pair)
    )


# <<< hidden
