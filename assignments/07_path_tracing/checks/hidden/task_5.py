"""Task 07.5, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, hidden_check

from ..common import EXACT, cube, require_mean, scene_of, ways
from ..task_5 import TASK_5, rays_inside, traced
from .common import mixed_room


@hidden_check(
    "07.5.hidden",
    points=3,
    calls=("trace_paths",),
    needs=TASK_5,
    sole="glossy primitives, shadows, and paths that leave the room",
    battery=[
        Subject(
            "adapters.traced",
            lambda t, n: (
                mixed_room(t),
                np.tile([0.1, 0.2, 0.3], (n, 1)),
                ways(t.rng, n, -1),
                3,
                7,
            ),
            lambda n: Array((n, 3)),
            tolerance=EXACT,
            has_right=False,
        )
    ],
)
def paths_of_a_room(t):
    """An open room with walls of different emission and a glossy ball: the mean of the solution."""
    walls = [
        (
            *face[:3],
            {
                "emission": t.rng.uniform(0.3, 2, 3),
                "base_color": t.rng.permutation([0.4, 0.6, 0.9]),
            },
        )
        for face in cube()[:5]
    ]
    glossy = {"base_color": t.rng.uniform(0.5, 0.9, 3), "metalness": 0.7, "roughness": 0.4}
    scene = scene_of(walls, [((0.3, -0.4, 0.1), 0.4, glossy)])
    n, times = 1000, 3
    origins, directions = rays_inside(t, n)
    origins = np.tile([-0.4, -0.2, 0.3], (n, 1))
    theirs = t.reference.trace_paths(
        scene, np.tile(origins, (times, 1)), np.tile(directions, (times, 1)), 4, t.rng
    )
    # The variance over rays is larger than that of two estimates of one ray: test differences.
    right = theirs.reshape(times, n, 3).mean(axis=0)
    require_mean(
        t,
        "depth 4, less the solution's, plus 1",
        lambda: 1 + traced(t, scene, origins, directions, 4) - right,
        np.ones(3),
    )
