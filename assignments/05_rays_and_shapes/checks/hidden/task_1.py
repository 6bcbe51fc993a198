"""Task 05.1, hidden checks."""

import numpy as np
from photograd_course.grading import Subject, hidden_check
from photograd_course.grading.generators import unit_vectors

from ..common import EXACT, distances, lengths, same_hits, sphere
from ..task_1 import hit, rays_onto, rays_within


def struck(t, n):
    """Arguments of `hit_sphere`: n rays near a sphere."""
    return t.rng.uniform(-6, 6, (n, 3)), unit_vectors(t.rng, n) * lengths(t, n), *sphere(t)


@hidden_check(
    "05.1.hidden",
    points=2,
    calls=("hit_sphere",),
    tolerance=EXACT,
    sole="the same mistakes at unseen spheres",
    battery=[Subject("hit_sphere", struck, distances, rows=(0, 1))],
)
def spheres_at_random(t):
    """Random rays and random spheres, of all kinds at once."""
    for _ in range(4):
        center, radius = sphere(t)
        outside, within = rays_onto(t, 12, center, radius), rays_within(t, 12, center, radius)
        origins = np.concatenate([outside[0], within[0], t.rng.uniform(-6, 6, (30, 3))])
        directions = np.concatenate(
            [outside[1], within[1], unit_vectors(t.rng, 30) * lengths(t, 30)]
        )
        right = t.reference.hit_sphere(origins, directions, center, radius)
        same_hits(t, hit(t, origins, directions, center, radius), right)
