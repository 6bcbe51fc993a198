"""Task 05.4, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Subject, hidden_check
from photograd_course.grading.generators import unit_vectors

from ..common import distances, same_hits, sphere
from ..task_4 import MARCHED, SLOPES, Surface, ball, both, marched, onto_ball, past_ball, wall


def approached(t, n):
    """Arguments of `march_sdf`: n rays that hit a ball."""
    center, radius = sphere(t)
    return Surface(ball(center, radius)), *onto_ball(t, n, center, radius)[:2], 50.0, 400


@hidden_check(
    "05.4.hidden",
    points=2,
    calls=("march_sdf",),
    tolerance=MARCHED,
    sole="the same mistakes at unseen scenes",
    battery=[
        Subject(
            "march_sdf",
            approached,
            lambda n: Items(distances(n), Array((n,))),
            large=100,
            rows=(1, 2),
            tolerance=SLOPES,
        )
    ],
)
def marches_at_random(t):
    """Random scenes: what is hit, the derivative, and how many points are tested."""
    for p_first in (True, False):
        center, radius = sphere(t)
        normal = unit_vectors(t.rng, 1)[0]
        scene = both(ball(center, radius), wall(normal, -6.0), p_first)
        origins, directions, _ = onto_ball(t, 15, center, radius)
        more = past_ball(t, 15, center, radius)
        inside = center + 0.5 * radius * unit_vectors(t.rng, 5)
        origins = np.concatenate([origins, more[0], inside])
        directions = np.concatenate([directions, more[1], unit_vectors(t.rng, 5)])
        for t_max, steps in ((30.0, 400), (6.0, 12)):
            service = Surface(scene)
            right, slopes = t.reference.march_sdf(service, origins, directions, t_max, steps)
            got, d_t, asked = marched(t, scene, origins, directions, t_max, steps)
            same_hits(t, got, right)
            grazing = np.abs(slopes) > 20  # where 1e-9 of t is much of a slope
            t.close("d_t", d_t[~grazing], slopes[~grazing])
            said = f"{asked} points were tested, {service.asked} are enough"
            t.require(asked <= 1.02 * service.asked, said)
