"""Task 10.2, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, hidden_check

from ..common import FAITHFUL, blocks
from ..task_2 import counting_leaf, rays_within, same_samples, skipped


def skipping(t, n):
    """Arguments of `skip_empty`, for n rays."""
    return counting_leaf(blocks(t, 8, 0.9), []), *rays_within(t, 8, n, 20), 20


@hidden_check(
    "10.2.hidden",
    points=6,
    calls=("skip_empty",),
    sole="the same mistakes on unseen rays",
    battery=[
        Subject(
            "skip_empty",
            skipping,
            lambda n: Array((n, 20), "bool"),
            rows=(1, 2),
            large=100,
            tolerance=FAITHFUL,
        )
    ],
)
def samples_of_random_rays(t):
    """Random rays through random trees: the samples, and the length of the rays in full cells."""
    for n, rays, count, still in ((16, 12, 70, 0), (8, 6, 30, 1), (2, 5, 12, 0), (16, 2, 3, 2)):
        full = blocks(t, n, 0.9)
        first, stride = rays_within(t, n, rays, count, still)
        got, _ = skipped(t, full, first, stride, count)
        right = t.reference.skip_empty(counting_leaf(full, []), first, stride, count)
        same_samples(t, got, right)
    n, count, fine = 16, 60, 10
    full = np.zeros((n, n, n), bool)
    full[3:9, 4:12, 5:11] = full[12:14, 1:4, 8:15] = True
    first, stride = rays_within(t, n, 24, count)
    got, _ = skipped(t, full, first, stride, count)
    k = (np.arange(count * fine) + 0.5) / fine - 0.5
    between = first[:, None] + k[:, None] * stride[:, None]
    cell = np.clip(np.floor(between), 0, n - 1).astype(np.int64)
    length = np.linalg.norm(stride, axis=1)
    occupied = float(length @ full[tuple(np.moveaxis(cell, 2, 0))].sum(axis=1)) / fine
    covered = float(length @ got.sum(axis=1))
    said = f"samples over {covered:.1f} cells, {occupied:.1f} are full"
    t.require(0 < occupied / 1.3 <= covered <= 1.3 * occupied, said)
