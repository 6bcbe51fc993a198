"""Task 02.6, hidden checks."""

import numpy as np
from photograd_course.grading import Subject, Tolerance, hidden_check

from ..common import EXACT, STEP
from ..task_6 import VERDICT, smooth

STEPS = Tolerance(1e-3, "x + h is rounded: 1e-11 of h; a step half or twice as long is off by 0.5")


SMALL = 1e-6  # the error of a gradient that is accepted


def wrong_somewhere(t, n):
    """Arguments of `grad_check`, for n numbers, with one wrong entry of the gradient."""
    f, x = smooth(t.rng, n)
    entry = int(t.rng.integers(n))

    def g(at):
        value, gradient = f(at)
        gradient[entry] *= 1.5
        return value, gradient

    return g, x


def asked_for(make, is_right):
    """The battery of `grad_check`, for functions whose gradients are right, or are not."""
    return Subject(
        "adapters.checked",
        make,
        lambda _: VERDICT,
        right=lambda *_: is_right,
        common=lambda _t, _args, error: 0.0 <= error <= SMALL,
        tolerance=EXACT,
        large=300,
    )


@hidden_check(
    "02.6.scale",
    points=1,
    calls=("grad_check",),
    sole="the steps themselves, and gradients of 1e-9",
    battery=[
        asked_for(lambda t, n: smooth(t.rng, n), is_right=True),
        asked_for(wrong_somewhere, is_right=False),
    ],
)
def large_and_small_numbers(t):
    """Coordinates of 1e8 and gradients of 1e-9 are judged like others; steps follow Eq. (15)."""
    f, x = smooth(t.rng, 3)
    x[2] = 0.0
    moves = []

    def stretched(size, height, factor):
        def g(at):
            at = np.asarray(at)
            moves.append(np.abs(at - x * size))
            value, gradient = f(at / size)
            return height * value, factor * height * gradient / size

        return g

    for size, height in ((np.array([1e8, 1.0, 1.0]), 1.0), (np.ones(3), 1e-9)):
        moves.clear()
        found = t.call("adapters.checked", stretched(size, height, 1.0), x * size, returns=VERDICT)
        where = f"x of {size[0]:g}, f of {height:g}"
        t.require(0.0 <= found <= SMALL, f"right, but refused: {where}")
        steps = STEP * np.maximum(1.0, np.abs(x * size))
        t.close("the steps of Eq. (15)", np.max(moves, 0) / steps, np.ones(3), STEPS)
        found = t.call("adapters.checked", stretched(size, height, 1.1), x * size, returns=VERDICT)
        t.require(not 0.0 <= found <= SMALL, f"wrong, but accepted: {where}")
