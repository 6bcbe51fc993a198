"""Task 05.3, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Subject, hidden_check

from ..common import EXACT
from ..task_3 import arrivals, refracted


@hidden_check(
    "05.3.hidden",
    points=2,
    calls=("refract",),
    tolerance=EXACT,
    sole="the same mistakes at unseen directions",
    battery=[
        Subject(
            "refract",
            lambda t, n: (*arrivals(t, n), 0.7),
            lambda n: Items(Array((n, 3)), Array((n,), "bool")),
            rows=(0, 1),
        )
    ],
)
def glass_at_random(t):
    """Random directions from both sides, many of them beyond the critical angle."""
    for eta in (1.5, 0.6, 2.0):
        outer, inner = arrivals(t, 20), arrivals(t, 20, inside=True)
        d, n = (np.concatenate([one, two]) for one, two in zip(outer, inner, strict=True))
        right, expected = t.reference.refract(d, n, eta)
        out, through = refracted(t, d, n, eta)
        t.require(bool((through == expected).all()), "through is wrong for some rays")
        t.close("out", out, right)
