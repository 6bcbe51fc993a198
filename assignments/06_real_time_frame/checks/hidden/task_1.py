"""Task 06.1, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Subject, hidden_check

from ..common import EXACT, FAITHFUL, snapped
from ..task_1 import drawn


def soup(t, count, height=14, width=17):
    """Random triangles (count, 3, 3), some of them beyond the border, level or without area."""
    flat = np.stack(
        [
            snapped(t.rng, -4, width + 4, (count, 3), 4),
            snapped(t.rng, -4, height + 4, (count, 3), 4),
        ],
        axis=2,
    )
    flat[::5, 2] = flat[::5, 1]
    flat[1::2, :2, 1] = np.floor(flat[1::2, :1, 1]) + 0.5  # level edges through centers
    return np.concatenate([flat, t.rng.uniform(1.0, 9.0, (count, 3, 1))], axis=2)


def spec_of(n):
    del n
    return Items(Array((14, 17), "i8"), Array((14, 17, 3)), Array((14, 17), finite=False))


@hidden_check(
    "06.1.hidden",
    points=3,
    calls=("rasterize",),
    tolerance=EXACT,
    sole="the same mistakes in unseen triangles",
    battery=[Subject("rasterize", lambda t, n: (soup(t, n), 14, 17), spec_of, sizes=(0, 1, 30))],
)
def triangles_at_random(t):
    """Many random triangles, among them some without area and some beyond the border."""
    for height, width in ((20, 31), (31, 20), (90, 120)):
        corners = soup(t, 60, height, width)
        face, weights, depth = drawn(t, corners, height, width)
        right = t.reference.rasterize(corners, height, width)
        t.close("face", face, right[0], FAITHFUL)
        t.close("weights", weights, right[1])
        seen = right[0] >= 0
        t.close("depth", depth[seen], right[2][seen])
        t.require(bool(np.isinf(depth[~seen]).all()), "depth is infinite where nothing is seen")
