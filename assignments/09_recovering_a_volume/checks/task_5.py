"""Task 09.5, public checks."""

import numpy as np
from photograd_course.grading import Array, Number, checks_for

from .common import EARLIER, batch, looking, random_views, views_of

check = checks_for(calls=("gradient_sign_map",), needs=EARLIER)


def sign_map(t, grid, views):
    """`gradient_sign_map` of the submission."""
    shape = grid.shape[:3]
    signs = t.call("gradient_sign_map", grid, views, returns=Array(shape))
    t.require(bool(np.isin(signs, (-1.0, 0.0, 1.0)).all()), "only -1, 0 and 1 may occur")
    return signs


SHARE = "handout, equation (12): compare with the largest derivative before you take signs"


@check(
    "09.5.differences",
    points=3,
    hint="handout, equations (11) and (12): all pixels of all photographs",
    sole="the signs themselves, without the reference",
)
def signs_agree_with_differences(t):
    """More extinction in one voxel alone raises your loss where the map says 1, lowers it at -1."""
    views = random_views(t, 3, 4, 5)
    grid = t.rng.uniform(0.2, 1.0, (3, 2, 3, 4))
    change = np.zeros((3, 2, 3))
    for index in np.ndindex(change.shape):
        for way in (1, -1):
            moved = grid.copy()
            moved[(*index, 3)] += way * 1e-4
            change[index] += way * t.call("adapters.loss_of_views", moved, views, returns=Number())
    clear = np.abs(change) > 1e-3 * np.abs(change).max()
    t.require(bool((change[clear] > 0).any() and (change[clear] < 0).any()), "not telling")
    signs = sign_map(t, grid, views)
    right = np.sign(change)
    t.require(
        not np.array_equal(signs[clear], -right[clear]),
        "all signs are turned round",
        hint="-1 is where descent adds: it goes against the derivative",
    )
    wrong = [tuple(map(int, at)) for at in np.argwhere(clear & (signs != right))]
    told = f"{len(wrong)} of {int(clear.sum())} voxels have the wrong sign"
    if wrong:
        told += f"; at {wrong[0]} yours is {signs[wrong[0]]:g}, expected {right[wrong[0]]:g}"
    t.require(not wrong, told)
    origins, directions, truth = t.call("ray_batch", views, np.arange(60), returns=batch(60))
    seen = t.call(
        "render_rays",
        grid,
        views["low"],
        views["high"],
        origins,
        directions,
        16,
        views["background"],
        returns=Array((60, 3)),
    )
    views["pictures"] = (seen + 1e-6 * (truth - seen)).reshape(3, 4, 5, 3)
    same = np.array_equal(signs, sign_map(t, grid, views))
    t.require(
        same,
        "the signs have changed when all errors became a millionth of what they were",
        hint=SHARE,
    )


@check("09.5.silent", points=2, hint=SHARE, sole="where nothing is known")
def no_sign_where_nothing_is_known(t):
    """Voxels that no ray passes, and voxels behind a wall, get 0."""
    camera = looking(np.array([0.0, 0.0, 9.0]))
    # In the second case everything should be brighter: no derivative is positive.
    cases = (0.2, (0.9, 0.8, 0.7), 0.3, 0.6), (0.7, (0.3, 0.2, 0.1), 0.9, 1.0)
    for fog, paint, low, high in cases:
        grid = np.full((5, 5, 5, 4), fog)
        grid[..., 3] = 0.2
        grid[:, :, 3] = (*paint, 100.0)  # a wall, with fog before and behind it
        pictures = t.rng.uniform(low, high, (1, 4, 4, 3))
        views = views_of(pictures, camera[None], np.zeros(3), focal=60.0)
        signs = sign_map(t, grid, views)
        t.require(bool((signs[1:4, 1:4, 3:] != 0).any()), "the wall is seen, and has no sign")
        t.require(
            not signs[0].any() and not signs[:, 4].any(), "a voxel that no ray passes has a sign"
        )
        t.require(not signs[:, :, :2].any(), "a voxel that lies hidden behind the wall has a sign")
