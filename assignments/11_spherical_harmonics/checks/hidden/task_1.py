"""Task 11.1, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, hidden_check
from photograd_course.grading.generators import unit_vectors

from ..common import EXACT, basis


@hidden_check(
    "11.1.hidden",
    points=4,
    calls=("sh_basis",),
    tolerance=EXACT,
    sole="the same mistakes at unseen directions",
    battery=[
        Subject(
            "sh_basis",
            lambda t, n: (unit_vectors(t.rng, n), 3),
            lambda n: Array((n, 16)),
            rows=(0,),
        )
    ],
)
def the_basis_at_random_directions(t):
    """All harmonics are right at random directions, at the poles too, for each degree."""
    for degree in range(5):
        d = np.concatenate([unit_vectors(t.rng, 15), [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]])
        t.close(f"degree {degree}", basis(t, d, degree), t.reference.sh_basis(d, degree))
