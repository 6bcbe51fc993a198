"""Task 10.4, hidden checks."""

from photograd_course.grading import Array, Subject, hidden_check

from ..common import FAITHFUL, same_voxels
from ..task_4 import pruned, some_shares, voxels_in


def shared(t, n):
    """Arguments of `prune_and_dilate`, for n voxels."""
    most = t.rng.uniform(0.1, 0.9, n)
    side = 4 if n < 64 else 12
    return side, voxels_in(t, side, n), *some_shares(t, most), 0.5, 1


@hidden_check(
    "10.4.hidden",
    points=2,
    calls=("prune_and_dilate",),
    sole="the same mistakes at unseen voxels",
    battery=[
        Subject("prune_and_dilate", shared, lambda _: Array((None, 3), "i8"), tolerance=FAITHFUL)
    ],
)
def random_voxels_are_pruned_and_grow(t):
    """Random voxels with random shares are pruned and grow as they should."""
    for n, count, steps in ((8, 100, 1), (4, 10, 2), (16, 50, 0), (2, 3, 1), (8, 20, 3)):
        voxels = voxels_in(t, n, count)
        most = t.rng.uniform(0.1, 0.9, count)
        most[1::5] = most[-1] = 0.0
        row, share = some_shares(t, most)
        right = t.reference.prune_and_dilate(n, voxels, row, share, 0.5, steps)
        got = pruned(t, n, voxels, row, share, 0.5, steps)
        same_voxels(t, f"{steps} steps", n, got, right)
