"""Task 02.6, public checks."""

import numpy as np
from photograd_course.grading import Array, Number, Tolerance, asks, checks_for

from .common import away

check = checks_for(calls=("grad_check",))

REPORTED = Tolerance(
    2e-8, "differences, and so what is reported, are right to 1e-10; one-sided ones are off by 6e-7"
)
ACCEPTED = Tolerance(
    1e-7, "right gradients have an error of 1e-10, one-sided differences report 3e-6", floor=1.0
)
ONE_BY_ONE = "two sides, one coordinate at a time, and a new copy of x for each point"
COPIES = "often x itself is moved: move copies of it, a new one each time"
VERDICT = Number(finite=False)


def smooth(rng, n):
    """A function (value, gradient) of n numbers with all kinds of derivatives, and a point."""
    w, m = away(rng, 0.5, 2.0, n), away(rng, 0.3, 1.0, (n, n))

    def f(x):
        s = np.sin(m @ x)
        return float(w @ s), m.T @ (w * np.cos(m @ x))

    return f, rng.uniform(0.3, 1.5, n)


@check("02.6.accepts", points=2)
def right_gradients_are_accepted(t):
    """Right gradients of smooth functions have an error close to 0, and x stays as it is."""
    for n in (1, 4, 7):
        f, x = smooth(t.rng, n)
        asked = []

        def counted(x, f=f, asked=asked):
            asked.append(np.array(x))
            return f(asked[-1])

        watched = asks(counted, Array((n,), finite=False), name="f")
        errors = t.call("adapters.checked_twice", watched, x, returns=Array((2,), finite=False))
        # Where x has changed, the second call begins elsewhere.
        calls = len(asked) // 2
        same = np.array_equal(asked[:calls], asked[calls:])
        t.require(same, "grad_check asks for other points when it is called again", hint=COPIES)
        entries = "1 entry" if n == 1 else f"{n} entries"
        t.close(
            f"error of a right gradient of {entries}",
            errors[0],
            0.0,
            ACCEPTED,
            reveal=True,
            hint=ONE_BY_ONE,
        )
        t.require(calls <= 2 * n + 1, f"{calls} calls of f, {2 * n + 1} are enough")


@check("02.6.rejects", points=3, tolerance=REPORTED)
def wrong_gradients_are_measured(t):
    """The error of a wrong gradient is reported as Eq. (16) has it."""
    f, x = smooth(t.rng, 5)
    right = f(x)[1]
    wrong = {
        "twice as large": lambda g: 2 * g,
        "of the wrong sign": lambda g: -g,
        "reversed": lambda g: g[::-1].copy(),
        "without its last entry": lambda g: g * np.array([1.0, 1.0, 1.0, 1.0, 0.0]),
        "zero": lambda g: 0 * g,
    }
    reported, expected = [], []
    for spoil in wrong.values():

        def spoiled(x, spoil=spoil):
            value, gradient = f(np.asarray(x))
            return value, spoil(gradient)

        reported.append(t.call("adapters.checked", spoiled, x, returns=VERDICT))
        scale = max(np.linalg.norm(spoil(right)), np.linalg.norm(right))
        expected.append(np.linalg.norm(spoil(right) - right) / scale)
    # All together: mistakes that agree in one of the errors, such as 1, differ in another.
    t.close(f"errors of gradients that are {', '.join(wrong)}", reported, expected, reveal=True)


@check(
    "02.6.large",
    points=1,
    sole="Eq. (15) where students can see it; the hidden check measures the steps",
)
def large_coordinates_move_further(t):
    """Right gradients at coordinates of 1e8 have an error close to 0: steps follow Eq. (15)."""
    f, x = smooth(t.rng, 3)
    size = 1e8

    def stretched(at):
        value, gradient = f(np.asarray(at) / size)
        return value, gradient / size

    found = t.call("adapters.checked", stretched, x * size, returns=VERDICT)
    where = ", ".join(f"{number:.1e}" for number in x * size)
    t.close(
        f"error of a right gradient at x = ({where})",
        found,
        0.0,
        ACCEPTED,
        reveal=True,
        hint="the step of Eq. (15) grows with the coordinate",
    )


@check("02.6.not_finite", points=1)
def not_a_number_is_refused(t):
    """What is not finite gives infinity, and a constant's gradient of zero the error 0."""
    f, x = smooth(t.rng, 3)
    finite = "ask whether all numbers are finite before you compare"
    for bad in (np.nan, np.inf):
        found = t.call(
            "adapters.checked",
            lambda x, bad=bad: (f(np.asarray(x))[0], np.array([bad, 0.0, 0.0])),
            x,
            returns=VERDICT,
        )
        t.require(found == np.inf, f"{bad} in the gradient does not give infinity", hint=finite)
    found = t.call("adapters.checked", lambda _: (np.nan, np.ones(3)), x, returns=VERDICT)
    t.require(found == np.inf, "a value that is not a number does not give infinity", hint=finite)
    found = t.call("adapters.checked", lambda _: (1.0, np.zeros(3)), x, returns=VERDICT)
    t.require(
        found == 0.0,
        "a constant's gradient of zero does not give 0",
        hint="with both lengths zero there is nothing to divide by",
    )
