"""Task 01.3, public checks."""

import numpy as np
from photograd_course.grading import checks_for

from .common import EXACT, rotated_bowl, walk

check = checks_for(calls=("gd_nd",))


@check(
    "01.3.rates",
    points=4,
    tolerance=EXACT,
    hint="Take the gradient once, at the old point, and move all coordinates with it.",
    sole="what students can run; hidden checks find its mistakes as well",
)
def each_eigenvector_has_a_factor_of_its_own(t):
    """On a quadratic the part along each eigenvector is multiplied by 1 - tau lambda_i."""
    curvatures = t.rng.uniform([0.2, 1.0, 2.0], [0.6, 1.5, 3.0])
    f, grad, vectors = rotated_bowl(t.rng, curvatures)
    start, tau, n = t.rng.uniform(1.0, 2.0, 3), 1.7 / float(curvatures[2]), 15
    x, loss, wrong = t.call("gd_nd", f, grad, vectors @ start, tau, n, returns=walk(n, 3))
    parts = start * (1.0 - tau * curvatures) ** np.arange(n + 1)[:, None]
    t.close("the points", x, parts @ vectors.T)
    t.close("the values", loss, 0.5 * parts**2 @ curvatures)
    t.require(not wrong, "the flag is True for a run that converges")


@check("01.3.stability", points=4, hint="The flag compares the last value with the first, Eq. (8).")
def the_largest_curvature_decides(t):
    """The flag changes at tau = 2 / lambda_max, and looks at the last and the first value."""
    curvatures = np.array([0.1, 1.0, 4.0])
    f, grad, vectors = rotated_bowl(t.rng, curvatures)
    start = vectors @ t.rng.choice([-1.0, 1.0], 3)
    for reach, fate in ((1.99, False), (2.01, True)):
        x, loss, wrong = t.call("gd_nd", f, grad, start, reach / 4.0, 200, returns=walk(200, 3))
        steep = np.abs(np.asarray(x) @ vectors[:, 2])
        at, way = f"at tau = {reach} / lambda_max", "grow" if fate else "shrink"
        t.require(
            (steep[-1] > steep[0]) == fate,
            f"{at} the distance along the steepest direction should {way} over the run, "
            f"yours goes from {steep[0]:.3g} to {steep[-1]:.3g}",
        )
        t.require(wrong == fate, f"{at} the flag should be {fate}, yours is {not fate}")
        t.require(
            (loss[-1] > loss[0]) == fate,
            f"{at} the values should {way} over the run, "
            f"yours go from {loss[0]:.3g} to {loss[-1]:.3g}",
        )
    # It has begun to rise, but has not come back to where it began.
    start = vectors @ np.array([1.0, 1.0, 1e-3])
    _, _, wrong = t.call("gd_nd", f, grad, start, 2.1 / 4.0, 40, returns=walk(40, 3))
    t.require(not wrong, "the run ends lower than it began, so the flag should be False")
    _, _, wrong = t.call("gd_nd", f, grad, np.zeros(3), 0.1, 2, returns=walk(2, 3))
    t.require(not wrong, "a run that starts in the minimum and stays has not gone wrong")
    _, _, wrong = t.call("gd_nd", f, grad, vectors[:, 2], 2.1 / 4.0, 1, returns=walk(1, 3))
    t.require(wrong, "a single step that leads higher has gone wrong")
