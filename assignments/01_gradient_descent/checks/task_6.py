"""Task 01.6, public checks."""

import math

import numpy as np
from photograd_course.grading import CheckFailed, Number, checks_for

from .common import EXACT, rotated_bowl

check = checks_for(calls=("backtracking",))


class Patient:
    """A function that ends an endless search: it answers 2,000 times, where 1,100 suffice."""

    def __init__(self, f):
        self.f, self.count = f, 0

    def __call__(self, x):
        """The value at x."""
        self.count += 1
        if self.count > 2000:
            raise CheckFailed(
                "backtracking: the search does not end: f was called more than 2,000 times",
                {"advice": "does tau shrink in the loop, and does Eq. (22) contain tau?"},
            )
        return self.f(x)


@check(
    "01.6.armijo",
    points=4,
    tolerance=EXACT,
    hint="The right-hand side of Eq. (22) falls with tau, along the direction you were given.",
)
def the_step_is_the_first_that_keeps_its_promise(t):
    """The step size satisfies Armijo's rule, and the one tried before it does not."""
    found, right = [], []
    for _ in range(8):
        f, grad, _ = rotated_bowl(t.rng, t.rng.uniform(0.5, 20.0, 3))
        x = t.rng.uniform(-2.0, 2.0, 3)
        d = -grad(x) * t.rng.uniform(0.3, 1.0, 3) - 0.1 * grad(x)
        if float(grad(x) @ d) >= 0.0:
            continue
        c, shrink = float(t.rng.uniform(0.2, 0.45)), float(t.rng.uniform(0.6, 0.9))
        given = Patient(f), grad, x, d, 1.0, c, shrink
        found.append(float(t.call("backtracking", *given, returns=Number())))

        def keeps(tau, f=f, grad=grad, x=x, d=d, c=c):
            promised = tau * float(d @ grad(x))
            return f(d * tau + x) <= f(x) + c * promised

        right.append(next(shrink**k for k in range(500) if keeps(shrink**k)))
    t.require(sum(tau < 1.0 for tau in right) >= 4, "too few steps are rejected")
    # All at once, so that no two mistakes give the same answer.
    t.close("the step sizes", np.array(found), right, reveal=True)
    # f(1) = -1/4 is the bound itself, in binary numbers without rounding.
    tau = t.call(
        "backtracking",
        Patient(lambda y: float(0.75 * y[0] ** 2 - y[0])),
        lambda y: 1.5 * y - 1.0,
        np.zeros(1),
        np.ones(1),
        1.0,
        0.25,
        0.5,
        returns=Number(),
    )
    t.require(float(tau) == 1.0, "a value that equals the bound is good enough")


@check(
    "01.6.refuses",
    points=2,
    hint="Raise ValueError unless the slope along d is negative; NaN is not negative.",
)
def a_direction_uphill_is_refused(t):
    """A direction that is uphill, zero or NaN raises ValueError."""
    f, grad, vectors = rotated_bowl(t.rng, np.array([1.0, 3.0]))
    unknown, x = np.full(2, math.nan), vectors[:, 0]
    for case, slope_of, d in (
        ("d is uphill", grad, x),
        ("d is zero", grad, np.zeros(2)),
        ("the gradient is NaN", lambda _: unknown, np.ones(2)),
    ):
        asked = Patient(f)
        try:
            t.refuses("backtracking", asked, slope_of, x, d, error="ValueError")
        except CheckFailed as failure:
            raise CheckFailed(f"{case}: {failure.text}", failure.details) from failure
        t.require(asked.count < 10, f"{case}: look at the slope before you search")
