"""Task 05.2, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Subject, hidden_check

from ..common import EXACT, distances, same_hits
from ..task_2 import aimed, inner_parts, outer_parts, triangles


def crossed(t, n):
    """Arguments of `hit_triangle`: n triangles, every other one missed."""
    parts = np.concatenate([inner_parts(t, n - n // 2), outer_parts(t, n // 2)])
    return aimed(t, n, parts, t.rng.uniform(-2, 5, n))


@hidden_check(
    "05.2.hidden",
    points=2,
    calls=("hit_triangle",),
    tolerance=EXACT,
    sole="the same mistakes at unseen triangles",
    battery=[
        Subject("hit_triangle", crossed, lambda n: Items(distances(n), Array((n, 2))), rows=(2,))
    ],
)
def triangles_at_random(t):
    """Random rays and triangles, hit and missed."""
    for _ in range(4):
        parts = np.concatenate([inner_parts(t, 20), outer_parts(t, 20)])
        ahead = t.rng.uniform(-2, 5, 40)
        given = aimed(t, 40, parts, ahead)
        right, expected = t.reference.hit_triangle(*given)
        got, weights = triangles(t, *given)
        same_hits(t, got, right)
        t.close("weights", weights, expected)
