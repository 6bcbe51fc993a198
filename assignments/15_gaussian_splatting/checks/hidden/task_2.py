"""Task 15.2, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Subject, hidden_check
from photograd_course.grading.adjoint_gate import random_cotangent

from ..common import EXACT, ahead, in_world, some_camera
from ..task_2 import folded, outside, seen, seen_back, shapes


def projected(t, n):
    """Arguments of `project`."""
    camera = some_camera(t.rng)
    return in_world(camera, ahead(t.rng, n)), shapes(t.rng, n), camera


def backprojected(t, n):
    """Arguments of the `back` of `project`, after those of `project`."""
    return *projected(t, n), t.rng.normal(size=(n, 2)), t.rng.normal(size=(n, 3))


def folded_pair(pair):
    """(d_means, d_cov), the second as right ones have it in common."""
    return [pair[0], folded(pair[1])]


@hidden_check(
    "15.2.hidden",
    points=3,
    calls=("project",),
    adjoints=("project",),
    tolerance=EXACT,
    sole="the same mistakes at unseen values",
    battery=[
        Subject(
            "adapters.project",
            projected,
            lambda n: Items(Array((n, 2)), Array((n, 3)), Array((n,))),
            right=lambda ref, *args: ref.project(*args)[:3],
            rows=(0, 1),
        ),
        Subject(
            "adapters.project_back",
            backprojected,
            lambda n: Items(Array((n, 3)), Array((n, 3, 3))),
            right=lambda ref, *args: folded_pair(ref.project(*args[:3])[3](*args[3:])),
            common=lambda _t, _args, pair: folded_pair(pair),
            rows=(0, 1, 3, 4),
        ),
    ],
)
def random_projections(t):
    """Values and both derivatives are right, inside of the limits and outside."""
    camera = some_camera(t.rng)
    side = np.concatenate([t.rng.uniform(-0.4, 0.4, (4, 2)), outside(t.rng, camera, 1.5)])
    z = t.rng.uniform(0.5, 4.0, (12, 1))
    means = in_world(camera, np.concatenate([side * z, z], axis=1))
    cov, g = shapes(t.rng, 12), random_cotangent(t.rng, (12, 5))
    *right, pullback = t.reference.project(means, cov, camera)
    for name, mine, theirs in zip(
        ("mean2d", "cov2d", "depth"), seen(t, means, cov, camera), right, strict=True
    ):
        t.close(name, mine, theirs)
    d_means, d_cov = seen_back(t, means, cov, camera, g)
    right = pullback(g[:, :2], g[:, 2:])
    t.close("d_means", d_means, right[0])
    t.close("d_cov", folded(d_cov), folded(right[1]))
