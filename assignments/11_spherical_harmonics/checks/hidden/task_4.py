"""Task 11.4, hidden checks."""

from photograd_course.grading import Array, Subject, hidden_check
from photograd_course.grading.generators import random_rotation

from ..common import EXACT
from ..task_4 import rotated


@hidden_check(
    "11.4.hidden",
    points=3,
    calls=("sh_rotate",),
    needs=("sh_basis", "sh_project"),
    tolerance=EXACT,
    sole="the same mistakes at unseen rotations",
    battery=[
        Subject(
            "sh_rotate",
            lambda t, n: (t.rng.uniform(-1.0, 1.0, (9, n)), random_rotation(t.rng)),
            lambda n: Array((9, n)),
        )
    ],
)
def random_turns(t):
    """Random coefficients are rotated rightly, for each degree."""
    for degree in range(5):
        c, R = t.rng.uniform(-1.0, 1.0, ((degree + 1) ** 2, 2)), random_rotation(t.rng)
        t.close(f"degree {degree}", rotated(t, c, R), t.reference.sh_rotate(c, R))
