"""Task 06.4, hidden checks."""

from photograd_course.grading import Array, Subject, hidden_check

from ..common import FAITHFUL
from ..task_4 import bloomed


def unseen(t, n):
    """radiance, threshold, sigma, strength."""
    rest = t.rng.uniform([0.5, 0.5, 0.2], [1.5, 3.0, 1.0])
    return t.rng.uniform(0.0, 5.0, (n, n + 2, 3)), *(float(each) for each in rest)


@hidden_check(
    "06.4.hidden",
    points=2,
    calls=("bloom",),
    tolerance=FAITHFUL,
    sole="the same mistakes in unseen pictures",
    battery=[Subject("bloom", unseen, lambda n: Array((n, n + 2, 3)), sizes=(1, 2, 9), large=40)],
)
def random_pictures(t):
    """Random pictures, thresholds, widths and strengths."""
    for n in (6, 12, 17):
        given = unseen(t, n)
        t.close("radiance", bloomed(t, *given), t.reference.bloom(*given))
