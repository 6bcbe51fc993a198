"""Task 15.1, hidden checks."""

from photograd_course.grading import Array, Items, Subject, hidden_check
from photograd_course.grading.adjoint_gate import random_cotangent

from ..common import EXACT, spread
from ..task_1 import spread_back
from .common import derivatives, values


def turned_shapes(t, n):
    """Arguments of `covariance`."""
    return 3 * t.rng.normal(size=(n, 4)), t.rng.uniform(-2.0, 1.0, (n, 3))


@hidden_check(
    "15.1.hidden",
    points=3,
    calls=("covariance",),
    adjoints=("covariance",),
    tolerance=EXACT,
    sole="the same mistakes at unseen values",
    battery=[
        Subject(
            "adapters.covariance",
            turned_shapes,
            lambda n: Array((n, 3, 3)),
            right=values("covariance"),
            rows=(0, 1),
        ),
        Subject(
            "adapters.covariance_back",
            lambda t, n: (*turned_shapes(t, n), t.rng.normal(size=(n, 3, 3))),
            lambda n: Items(Array((n, 4)), Array((n, 3))),
            right=derivatives("covariance"),
            rows=(0, 1, 2),
        ),
    ],
)
def random_shapes(t):
    """Values and both derivatives are right for random Gaussians."""
    q, s = 3 * t.rng.normal(size=(9, 4)), t.rng.uniform(-2.0, 1.0, (9, 3))
    g = random_cotangent(t.rng, (9, 3, 3))
    cov, pullback = t.reference.covariance(q, s)
    t.close("cov", spread(t, q, s), cov)
    got = spread_back(t, q, s, g)
    for name, mine, theirs in zip(("d_quats", "d_log_scales"), got, pullback(g), strict=True):
        t.close(name, mine, theirs)
