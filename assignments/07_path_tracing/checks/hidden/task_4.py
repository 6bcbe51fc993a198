"""Task 07.4, hidden checks."""

from photograd_course.grading import Array, Items, Subject, hidden_check

from ..common import EXACT
from ..task_4 import played


@hidden_check(
    "07.4.hidden",
    points=1,
    calls=("roulette",),
    tolerance=EXACT,
    sole="unseen paths",
    battery=[
        Subject(
            "roulette",
            lambda t, n: (t.rng.uniform(0, 1, (n, 3)), t.rng.random(n)),
            lambda n: Items(Array((n, 3)), Array((n,), "bool")),
            rows=(0, 1),
        )
    ],
)
def random_roulette(t):
    """Random paths."""
    beta, u = t.rng.uniform(0, 1.3, (200, 3)) * t.rng.uniform(0, 1, (200, 1)), t.rng.random(200)
    beta[:4], u[:4] = 0.02, [0.01, 0.019, 0.021, 0.03]
    right, goes = t.reference.roulette(beta, u)
    after, alive = played(t, beta, u)
    t.require(bool((alive == goes).all()), "the wrong paths continue")
    t.close("beta", after, right)
