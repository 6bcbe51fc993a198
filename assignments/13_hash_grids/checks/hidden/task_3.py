"""Task 13.3, hidden checks."""

from photograd_course.grading import Array, Subject, hidden_check

from ..common import EXACT, layout, table_for
from ..task_3 import EARLIER, encoded


def encoding(t, n):
    """Arguments of `encode`, for n points."""
    levels = layout([2, 4, 9], 3, 64)
    return t.rng.uniform(-0.5, 1.5, (n, 3)), table_for(t, levels), levels


@hidden_check(
    "13.3.hidden",
    points=2,
    calls=("encode",),
    needs=EARLIER,
    tolerance=EXACT,
    sole="the same mistakes at unseen points",
    battery=[Subject("encode", encoding, lambda n: Array((n, 6)), sizes=(0, 1, 2, 7), rows=(0,))],
)
def features_of_random_points(t):
    """Features of random points, on dense and hashed levels."""
    for D, resolutions, features in (
        (2, [1, 5, 40], 3),
        (3, [4, 30], 2),
        (2, [1000, 7], 1),
        (2, [3] * 20, 9),
    ):
        levels = layout(resolutions, D, 100)
        table, points = table_for(t, levels, features), t.rng.uniform(-0.5, 1.5, (20, D))
        right = t.reference.encode(points, table, levels)
        t.close(f"features, D = {D}", encoded(t, points, table, levels), right)
