"""Task 07.2, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, hidden_check

from ..common import EXACT
from ..task_2 import weights_of


@hidden_check(
    "07.2.hidden",
    points=1,
    calls=("mis_weight",),
    tolerance=EXACT,
    sole="unseen densities",
    battery=[
        Subject(
            "mis_weight",
            lambda t, n: np.exp(t.rng.uniform(-3, 3, (2, n))),
            lambda n: Array((n,)),
            rows=(0, 1),
            special={0: (0.0, 1e200), 1: (0.0, 1e200)},
        )
    ],
)
def random_weights(t):
    """Random densities."""
    p, q = np.exp(t.rng.uniform(-3, 3, (2, 40)))
    t.close("weights", weights_of(t, p, q), 1 / (1 + (q / p) ** 2))
