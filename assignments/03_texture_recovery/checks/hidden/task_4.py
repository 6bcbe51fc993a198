"""Task 03.4, hidden checks."""

from photograd_course.grading import Number, Subject, hidden_check

from ..common import CHAINED
from .common import sampled


@hidden_check(
    "03.4.hidden",
    points=3,
    calls=("largest_curvature",),
    needs=("bilinear_sample", "bilinear_sample_adjoint", "loss_and_grad"),
    tolerance=CHAINED,
    sole="the same mistakes at unseen points",
    battery=[
        Subject(
            "largest_curvature",
            lambda t, n: ((3, 5), sampled(t, 40)[1], n),
            lambda _: Number(),
            sizes=(0, 1, 7),
            large=100,
        )
    ],
)
def the_estimate_at_random_places(t):
    """The estimate is right after any number of iterations."""
    for shape, n in (((4, 6), 0), ((5, 2), 1), ((3, 9), 7)):
        uv = t.rng.uniform(0.0, 1.0, (80, 2))
        got = t.call("largest_curvature", shape, uv, n, returns=Number())
        t.close(f"after {n} iterations", got, t.reference.largest_curvature(shape, uv, n))
