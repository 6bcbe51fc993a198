"""Task 06.6, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Subject, hidden_check

from ..common import EXACT
from ..task_6 import bumpy, occluded


def spec_of(n):
    return Items(Array((n, n + 2)), Array((3,)))


@hidden_check(
    "06.6.hidden",
    points=2,
    calls=("ambient_occlusion",),
    tolerance=EXACT,
    adjoints=("ambient_occlusion",),
    sole="the same mistakes in unseen depths",
    battery=[
        Subject(
            "ambient_occlusion", lambda t, n: bumpy(t, n, n + 2), spec_of, sizes=(4, 9), large=40
        )
    ],
)
def rough_walls(t):
    """Rough walls with holes, samples beyond the picture, on sky and on the pixel itself."""
    for size, radius in (((10, 13), 0.9), ((14, 9), 6.0)):
        given = bumpy(t, *size, samples=9)
        given[4][0] = radius
        given[3][::3, :, 0] = 0.0
        got, right = occluded(t, *given), t.reference.ambient_occlusion(*given)
        t.require(float(np.min(right[0])) < 0.9, "the test case is not informative")
        t.close("open sky", got[0], right[0])
        for k, name in enumerate(("radius", "falloff", "strength")):
            t.close(f"d_settings, {name}", got[1][k], right[1][k])
