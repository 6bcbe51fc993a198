"""Task 10.3, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, hidden_check

from ..common import FAITHFUL
from ..task_3 import crowd, free_table, insert, require_sound, some_voxels


def inserted(t, n):
    """Arguments of `voxel_hash_insert`, for n voxels."""
    return free_table(16), some_voxels(t, n), t.rng.permutation(n)


@hidden_check(
    "10.3.hidden",
    points=1,
    calls=("voxel_hash_insert",),
    sole="the same mistakes at unseen voxels",
    battery=[
        Subject(
            "voxel_hash_insert",
            inserted,
            lambda _: Array((16, 4), "i8"),
            tolerance=FAITHFUL,
            has_right=False,
        )
    ],
)
def tables_of_random_voxels(t):
    """Tables of random voxels are sound, filled at once or bit by bit."""
    for count, slots in ((200, 401), (60, 61)):
        voxels = np.concatenate([crowd(t, 5, slots, slots - 1), some_voxels(t, count - 5)])
        rows, table, cut = t.rng.permutation(count - 1) + 1, free_table(slots), count // 3
        rows = np.append(0, rows)
        for part in (slice(0, cut), slice(cut, cut), slice(cut, count)):
            table = insert(t, table, voxels[part], rows[part])
        require_sound(t, table, voxels, rows)
