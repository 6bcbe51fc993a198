"""Task 06.5, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Subject, hidden_check
from photograd_course.grading.adjoint_gate import random_cotangent

from ..common import EXACT
from ..task_5 import case, toned


def spec_of(n):
    shape = Array((n, n + 1, 3))
    return Items(shape, shape, Array((2,)))


@hidden_check(
    "06.5.hidden",
    points=3,
    calls=("tone_map",),
    tolerance=EXACT,
    adjoints=("tone_map",),
    sole="the same mistakes in unseen pictures",
    battery=[
        Subject("tone_map", lambda t, n: case(t, n, n + 1), spec_of, sizes=(1, 2, 6), large=40)
    ],
)
def random_pictures(t):
    """Random pictures with black pixels, of any exposure."""
    for size in ((4, 5), (7, 3)):
        radiance, settings, _ = case(t, *size)
        radiance[t.rng.random(size) < 0.2] = 0.0
        given = radiance, settings, random_cotangent(t.rng, radiance.shape)
        right = t.reference.tone_map(*given)
        t.require(bool(np.any(right[1])), "the test case is not informative")
        for name, mine, theirs in zip(
            ("shown", "d_radiance"), toned(t, *given), right, strict=False
        ):
            t.close(name, mine, theirs)
        for k, name in enumerate(("d_exposure", "d_white")):
            t.close(name, toned(t, *given)[2][k], right[2][k])
