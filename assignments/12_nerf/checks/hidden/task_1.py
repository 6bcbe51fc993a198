"""Task 12.1, hidden checks."""

from photograd_course.grading import Array, Items, Subject, hidden_check

from ..common import EXACT
from ..task_1 import encoded

SCALES = {0: (1e-6, 100.0)}  # of points


@hidden_check(
    "12.1.hidden",
    points=2,
    calls=("positional_encoding",),
    adjoints=("positional_encoding",),
    tolerance=EXACT,
    sole="the same mistakes at unseen points",
    battery=[
        Subject(
            "positional_encoding",
            lambda t, n: (t.rng.uniform(-1.0, 1.0, (n, 3)), 4),
            lambda n: Items(Array((n, 27)), Array((n, 27))),
            sizes=(1, 9),
            rows=(0,),
            scales=SCALES,
        ),
        Subject(
            "positional_encoding",
            lambda t, n: (t.rng.uniform(-1.0, 1.0, (n, 1)), 3),
            lambda n: Items(Array((n, 7)), Array((n, 7))),
            rows=(0,),
            scales=SCALES,
        ),
    ],
)
def features_of_random_points(t):
    """Features and derivatives are right at random points."""
    for bands, dimensions in ((0, 3), (3, 2), (10, 1), (2, 60)):
        x = t.rng.uniform(-2.0, 2.0, (6, dimensions))
        got, right = encoded(t, x, bands), t.reference.positional_encoding(x, bands)
        t.close("features", got[0], right[0])
        t.close("derivatives", got[1], right[1])
