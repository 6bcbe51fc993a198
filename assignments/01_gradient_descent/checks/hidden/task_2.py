"""Task 01.2, hidden checks."""

import math

import numpy as np
from photograd_course.grading import Array, Items, Subject, Tolerance, Truth, checks_for

from ..common import walk
from .common import FAR, MANY, asked_once_a_step, rate

check = checks_for(calls=("gd_1d",), visibility="hidden")


@check(
    "01.2.basins",
    points=3,
    tolerance=Tolerance(1e-9, "right answers differ by 1.1e-15 at most, wrong ones by 1"),
    hint="Short steps converge to the near minimum; a long one may cross the maximum.",
    battery=[
        Subject(
            "gd_1d",
            lambda t, n: (
                math.cos,
                lambda x: -math.sin(x),
                float(t.rng.uniform(0.3, 3.0)),
                rate(n),
                n,
            ),
            walk,
            **FAR,
        )
    ],
)
def the_walk_ends_in_the_predicted_valley(t):
    """With two minima, start and learning rate decide in which one the run ends."""
    tilt = float(t.rng.uniform(0.1, 0.3))  # f = (x^2 - 1)^2 + tilt x

    def f(x):
        return (x * x - 1.0) ** 2 + tilt * x

    def df(x):
        return 4.0 * x * (x * x - 1.0) + tilt

    left, hump, right = np.sort(np.roots([4.0, 0.0, -4.0, tilt]).real)
    for x0, end in ((hump - 0.1, left), (hump + 0.1, right), (-1.6, left), (1.5, right)):
        x, _, _ = t.call("gd_1d", f, df, float(x0), 0.05, 200, returns=walk(200))
        t.close(f"the end of a run from {x0:.2f}", x[-1], end)
    # One long step over the maximum: from 1.7 by -0.1 f'(1.7), about -1.3, to 0.4; twice: past it.
    x, _, _ = t.call("gd_1d", f, df, 1.9, 0.14, 200, returns=walk(200))
    asked_once_a_step(
        t, "gd_1d", df, lambda slope: t.call("gd_1d", f, slope, 1.9, 0.01, MANY, returns=walk(MANY))
    )
    t.close("the end of a run that jumps", x[-1], t.reference.gd_1d(f, df, 1.9, 0.14, 200)[0][-1])


@check(
    "01.2.undefined",
    points=3,
    hint="NaN > 1 is False: write the flag so that NaN counts as gone wrong, Eq. (8).",
)
def nothing_is_not_better(t):
    """A run that leaves the domain of the function has gone wrong."""

    def f(x):
        return x - math.log(x) if x > 0.0 else math.nan

    names = ("the points", "the values", "the flag")
    spec = Items(Array((4,)), Array((4,), finite=False), Truth(), names=names)
    x0 = float(t.rng.uniform(1.15, 1.2))
    _, loss, wrong = t.call("gd_1d", f, lambda x: 1.0 - 1.0 / x, x0, 12.0, 3, returns=spec)
    t.require(bool(np.isnan(loss[-1])), "f is not defined where this run must end")
    t.require(wrong, "the last value is NaN, so the flag should be True")
