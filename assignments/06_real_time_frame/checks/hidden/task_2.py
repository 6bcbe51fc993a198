"""Task 06.2, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, hidden_check
from photograd_course.grading.generators import unit_vectors

from ..common import FAITHFUL, pose_of
from ..task_2 import placed, tested


def unseen(t, count, size=12):
    """points, normals, depth, focal, pose, bias."""
    pose, focal = pose_of(t.rng), t.rng.uniform(8.0, 14.0)
    depth = t.rng.uniform(2.0, 4.0, (size, size))
    u, v = t.rng.uniform(-3.0, size + 3.0, (2, count))
    points = placed(pose, focal, size, u, v, t.rng.uniform(2.0, 4.0, count))
    return points, unit_vectors(t.rng, count), depth, focal, pose, t.rng.uniform(0.1, 0.4)


@hidden_check(
    "06.2.hidden",
    points=2,
    calls=("shadow_test",),
    tolerance=FAITHFUL,
    sole="the same mistakes at unseen points",
    battery=[Subject("shadow_test", unseen, lambda n: Array((n,)), rows=(0, 1), sizes=(1, 7))],
)
def random_points_before_random_maps(t):
    """Random points with random normals and biases, inside of the map and beyond."""
    for size in (12, 5, 150):
        given = unseen(t, 300, size)
        right = t.reference.shadow_test(*given)
        t.require(0 < np.mean(right == 1) < 1, "the test case is not informative")
        t.close("part of the light", tested(t, *given), right)
