"""Checks of the arena: those of the toy assignment, a heavy tail, and poses held out."""

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
FITTED = Tolerance(1e-8, "two solvers of the normal equations differ by some 1e-13")


@check("91.1.value", task="91.1", points=3, calls=("weighted_sum",), tolerance=ROUNDING)
def value_at_known_points(t):
    """exp(0) = 1 and exp(-log 2) = 1/2 give the sums they must."""
    w = t.rng.uniform(1.0, 2.0, 5)
    t.close("s", t.call("weighted_sum", w, np.zeros(5), returns=Number()), w.sum(), reveal=True)
    halves = np.full(5, np.log(2.0))
    t.close("s", t.call("weighted_sum", w, halves, returns=Number()), w.sum() / 2, reveal=True)


@check(
    "91.2.differences",
    task="91.2",
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


@check("91.3.services", task="91.3", points=3, calls=("descend",), tolerance=ROUNDING)
def a_quadratic_contracts(t):
    """On a quadratic of curvature lambda each step shrinks x by 1 - tau lambda."""
    curvature = t.rng.uniform(0.5, 1.5, 3)
    x0 = t.rng.uniform(1.0, 2.0, 3)
    trail = t.call("descend", lambda x: curvature * x, x0, 0.5, 4, returns=Array((5, 3)))
    factor = (1 - 0.5 * curvature)[None, :] ** np.arange(5)[:, None]
    t.close("points", trail, factor * x0)


# >>> hidden
@check(
    "91.1.hidden",
    task="91.1",
    points=3,
    calls=("weighted_sum",),
    visibility="hidden",
    tolerance=ROUNDING,
)
def value_at_random_points(t):
    """The sum is right at random points."""
    w, x = t.rng.uniform(0.5, 2.0, 7), t.rng.uniform(-2.0, 2.0, 7)
    s = t.call("weighted_sum", w, x, returns=Number())
    t.close("s", s, t.reference.weighted_sum(w, x))


@check(
    "91.2.cost",
    task="91.2",
    points=3,
    calls=("weighted_sum_backward",),
    visibility="hidden",
    tolerance=ROUNDING,
    seconds=3.0,
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


@check(
    "91.4.tail",
    task="91.4",
    points=3,
    calls=("brightness",),
    visibility="hidden",
    tolerance=ROUNDING,
)
def the_mean_keeps_its_fireflies(t):
    """With a heavy tail, too, the mean is that of the samples drawn."""
    drawn = []

    def draw(n):
        if not 0 <= n <= 4000:  # what it makes stays in our memory
            raise ValueError(n)
        drawn.append(t.rng.pareto(1.5, int(n)))
        return drawn[-1]

    mean = t.call("brightness", draw, 4000, returns=Number())
    count = sum(map(len, drawn))
    t.require(count == 4000, f"expected 4000 samples to be drawn, got {count}")
    t.close("mean", mean, np.concatenate(drawn).mean())


@check(
    "91.5.unseen", task="91.5", points=3, calls=("predict",), visibility="hidden", tolerance=FITTED
)
def poses_held_out_are_met(t):
    """The cubic that made the values is met at poses that were held out."""
    cubic = np.polynomial.Polynomial(t.rng.uniform(-1.0, 1.0, 4))
    poses, unseen = t.rng.uniform(-1.0, 1.0, 20), t.rng.uniform(-1.0, 1.0, 5)
    got = t.call("predict", poses, cubic(poses), unseen, returns=Array((5,)))
    t.close("values", got, cubic(unseen))


# <<< hidden
