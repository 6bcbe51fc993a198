"""Task 13.5, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Subject, hidden_check

from ..common import EXACT
from ..task_5 import NAMES, some_rows, stepped


def moving(t, n):
    """Arguments of `adam_rows`, for n rows."""
    shape = (n, 2)
    d = t.rng.uniform(-1.0, 1.0, shape) * (t.rng.random((n, 1)) < 0.7)
    moments = t.rng.uniform(-0.1, 0.1, shape), t.rng.uniform(0.1, 0.2, shape)
    return t.rng.uniform(-1.0, 1.0, shape), d, *moments, 4, 0.05


@hidden_check(
    "13.5.hidden",
    points=2,
    calls=("adam_rows",),
    tolerance=EXACT,
    sole="the same mistakes at unseen values",
    battery=[
        Subject("adam_rows", moving, lambda n: Items(*3 * [Array((n, 2))]), rows=(0, 1, 2, 3))
    ],
)
def steps_of_random_rows(t):
    """Steps with other rows each time, the last a late one, end where they should."""
    mine = theirs = t.rng.uniform(-1.0, 1.0, (40, 3)), np.zeros((40, 3)), np.zeros((40, 3))
    for k in (*range(1, 11), 5000):
        d, rate = 10.0 ** -min(k, 11) * some_rows(t, 40, 3, 0.3), 0.1 / k
        mine = stepped(t, mine[0], d, *mine[1:], k, rate)
        theirs = t.reference.adam_rows(theirs[0], d, *theirs[1:], k, rate)
        for name, got, right in zip(NAMES, mine, theirs, strict=True):
            t.close(f"{name} after step {k}", got, right)
