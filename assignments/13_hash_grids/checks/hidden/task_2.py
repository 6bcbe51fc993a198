"""Task 13.2, hidden checks."""

from photograd_course.grading import Array, Subject, hidden_check

from ..common import FAITHFUL, whole
from ..task_2 import indexed


def some_corners(t, n):
    """Arguments of `hash_index`, for n corners."""
    return t.rng.integers(0, 100, (n, 3)), 99, 3000


@hidden_check(
    "13.2.hidden",
    points=2,
    calls=("hash_index",),
    sole="the same mistakes at unseen corners",
    battery=[
        Subject(
            "hash_index",
            some_corners,
            lambda n: Array((n,), "i8"),
            sizes=(0, 1, 2, 7),
            rows=(0,),
            tolerance=FAITHFUL,
        )
    ],
)
def rows_of_random_corners(t):
    """Rows of random corners, dense and hashed, with numbers of rows of all kinds."""
    for D in (2, 3):
        for resolution, rows in ((9, 1000), (9, 999), (9, 99), (2**20, 2**22), (700, 31337)):
            corners = t.rng.integers(0, resolution + 1, (50, D))
            right = t.reference.hash_index(corners, resolution, rows)
            got = indexed(t, corners, resolution, rows)
            whole(t, f"rows, resolution {resolution}, {rows} rows", got, right)
