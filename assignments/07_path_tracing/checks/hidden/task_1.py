"""Task 07.1, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, hidden_check

from ..common import EXACT, ways
from ..task_1 import density
from .common import mixed_room


def pointed(t, n):
    """Arguments of `light_pdf`, for the hits of n rays in a room."""
    scene, directions = mixed_room(t), ways(t.rng, n, -1)
    hit = t.reference.closest_hit(scene, np.tile([0.1, 0.2, 0.3], (n, 1)), directions)
    return scene, hit["primitive"], directions, hit["t"]


@hidden_check(
    "07.1.hidden",
    points=2,
    calls=("light_pdf",),
    tolerance=EXACT,
    sole="unseen rooms",
    battery=[Subject("light_pdf", pointed, lambda n: Array((n,)), rows=(1, 2, 3))],
)
def densities_in_a_room(t):
    """Hits of random rays in a room, compared with the solution."""
    scene = mixed_room(t)
    directions = ways(t.rng, 200, -1)
    there = t.reference.closest_hit(scene, np.tile([0.1, 0.2, 0.3], (200, 1)), directions)
    right = t.reference.light_pdf(scene, there["primitive"], directions, there["t"])
    t.close("density", density(t, scene, there["primitive"], directions, there["t"]), right)
