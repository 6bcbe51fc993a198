"""Task 15.4, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Subject, hidden_check
from photograd_course.grading.adjoint_gate import random_cotangent

from ..common import EXACT
from ..task_4 import blended, blended_back, layers
from .common import derivatives, values


def thin_layers(t, n):
    """n layers in three pixels, of which some light of the background is left."""
    alpha, *rest = layers(t.rng, n, 3)
    return alpha * min(1.0, 20.0 / n), *rest


@hidden_check(
    "15.4.hidden",
    points=3,
    calls=("composite_splats",),
    adjoints=("composite_splats",),
    tolerance=EXACT,
    sole="the same mistakes at unseen values",
    battery=[
        Subject(
            "adapters.composite_splats",
            thin_layers,
            lambda _: Array((3, 3)),
            right=values("composite_splats"),
            sizes=(1, 2, 40),
        ),
        Subject(
            "adapters.composite_splats_back",
            lambda t, n: (*thin_layers(t, n), t.rng.normal(size=(3, 3))),
            lambda n: Items(Array((n, 3)), Array((n, 3)), Array((3,))),
            right=derivatives("composite_splats"),
            sizes=(1, 2, 40),
        ),
    ],
)
def random_layers(t):
    """Values and derivatives are right for many layers."""
    a, c, z, b = layers(t.rng, 20, 300)
    z = np.floor(z)  # seven depths
    g = random_cotangent(t.rng, (300, 3))
    right, pullback = t.reference.composite_splats(a, c, z, b)
    t.close("shown", blended(t, a, c, z, b), right)
    got = blended_back(t, a, c, z, b, g)
    names = ("d_alpha", "d_colors", "d_background")
    for name, mine, theirs in zip(names, got, pullback(g), strict=True):
        t.close(name, mine, theirs)
