"""Task 09.5, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, checks_for

from ..common import EARLIER, EXACT, random_views
from ..task_5 import sign_map
from .common import photographed, two_balls

check = checks_for(calls=("gradient_sign_map",), needs=EARLIER, visibility="hidden")


@check(
    "09.5.hidden",
    points=2,
    sole="the same mistakes at unseen volumes",
    battery=[
        Subject(
            "gradient_sign_map",
            lambda t, n: (t.rng.uniform(0.0, 1.0, (n, 2, 3, 4)), random_views(t)),
            lambda n: Array((n, 2, 3)),
            tolerance=EXACT,
        )
    ],
)
def signs_of_random_volumes(t):
    """The map is right for random volumes and photographs."""
    for count, shape in ((3, (4, 3, 5)), (1, (2, 6, 1))):
        views, grid = random_views(t, count, 5, 4), t.rng.uniform(0.0, 1.0, (*shape, 4))
        wrong = int(np.sum(sign_map(t, grid, views) != t.reference.gradient_sign_map(grid, views)))
        t.require(wrong == 0, f"{wrong} of {grid[..., 3].size} voxels have the wrong sign")


@check("09.5.scene", points=3, sole="what the handout's pictures claim, on an unseen scene")
def inside_more_and_outside_less(t):
    """From fog, the map is -1 inside what was photographed, 1 where only background is seen."""
    scene = two_balls(t, 12, 0.7)
    views = photographed(t, scene, 6, 10)
    fog = t.reference.fog((12, 12, 12))
    signs = sign_map(t, fog, views)
    chosen = np.arange(views["pictures"][..., 0].size)
    origins, directions, truth = t.reference.ray_batch(views, chosen)
    asked = (views["low"], views["high"], origins, directions, 16, np.zeros(3))
    # A voxel touched by some ray, and by no ray that meets anything.
    meets = np.abs(truth - views["background"]).max(axis=1) > 1e-3
    white = np.ones((12, 12, 12, 4))

    def touched(rays):
        d_pixel = rays[:, None] * np.ones(3)
        return t.reference.render_adjoint(white, *asked, d_pixel)[0][..., 0] > 1e-9

    outside = touched(np.ones(len(meets))) & ~touched(meets.astype(float))
    inside = scene[..., 3] > 5
    t.require(bool(outside.sum() > 20 and inside.sum() > 20), "not telling")
    for name, where, sign in (("inside", inside, -1), ("outside", outside, 1)):
        share = float(np.mean(signs[where] == sign))
        t.require(share > 0.95, f"{name}: {share:.0%} of the voxels have the sign {sign}")
