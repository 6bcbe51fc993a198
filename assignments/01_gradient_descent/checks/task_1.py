"""Task 01.1, public checks."""

import math

import numpy as np
from photograd_course.grading import Tolerance, checks_for

from .common import derivative, rotated_bowl

check = checks_for(calls=("numeric_derivative",))

DIFFERENCE = Tolerance(1e-11, "right answers differ by at most 1.3e-14, wrong ones by 0.15 or more")


@check(
    "01.1.quadratic",
    points=4,
    tolerance=DIFFERENCE,
    sole="what students can run; hidden checks find its mistakes as well",
    hint="Move one coordinate at a time, both ways, and come back: Eq. (3).",
)
def central_differences_are_exact_for_quadratics(t):
    """For a quadratic in four variables the result is the gradient, however long the step."""
    _, slope_of, _ = rotated_bowl(t.rng, t.rng.uniform(0.5, 4.0, 4))
    b = t.rng.uniform(-2.0, 2.0, 4)
    for eps in (0.5, 0.01):
        x = t.rng.uniform(-2.0, 2.0, 4)
        got = derivative(t, lambda y: float(0.5 * y @ slope_of(y) + b @ y), x, eps)
        t.close(f"gradient with eps = {eps}", got, slope_of(x) + b)


@check(
    "01.1.order",
    points=4,
    sole="the order is what the handout is about; a wrong order fails a hidden check, too",
    hint="Halve eps: the error should fall to a quarter, Eq. (4).",
)
def the_error_falls_with_the_square_of_the_step(t):
    """Error against eps has slope 1.9 to 2.1 on logarithmic axes, for exp and for sin."""
    steps = np.geomspace(1e-1, 1e-3, 7)
    for f, df, name in ((math.exp, math.exp, "exp"), (math.sin, math.cos, "sin")):
        x = float(t.rng.uniform(0.3, 1.0))
        point, of_arrays = np.array([x]), lambda y, f=f: f(float(y[0]))
        found = [derivative(t, of_arrays, point, float(eps))[0] for eps in steps]
        errors = np.abs(np.array(found) - df(x))
        t.require(
            bool((errors > 0.0).all()), f"{name}: with these steps no formula of order 2 is exact"
        )
        slope = float(np.polyfit(np.log(steps), np.log(errors), 1)[0])
        t.require(1.9 <= slope <= 2.1, f"{name}: the slope is {slope:.2f}, expected 1.9 to 2.1")
