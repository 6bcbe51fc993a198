"""Task 06.3, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, hidden_check

from ..common import EXACT
from ..task_3 import case, lit_layer


@hidden_check(
    "06.3.hidden",
    points=2,
    calls=("light_surfaces",),
    needs=("gltf",),
    tolerance=EXACT,
    sole="the same mistakes in unseen G-buffers",
    battery=[
        Subject(
            "light_surfaces",
            lambda t, n: case(t, n, n + 1),
            lambda n: Array((n, n + 1, 4)),
            sizes=(1, 2, 5),
            large=24,
        )
    ],
)
def random_surfaces(t):
    """Random G-buffers with holes, the sun on both sides of surfaces."""
    for size in ((6, 9), (9, 4)):
        given = case(t, *size)
        given[0]["depth"][t.rng.random(size) < 0.2] = np.inf
        right = t.reference.light_surfaces(*given)
        t.close("layer", lit_layer(t, *given), right)
