"""Task 01.2, public checks."""

import numpy as np
from photograd_course.grading import checks_for

from .common import EXACT, parabola, walk

check = checks_for(calls=("gd_1d",))


@check(
    "01.2.rate",
    points=4,
    tolerance=EXACT,
    sole="what students can run; hidden checks find its mistakes as well",
    hint="Each step multiplies the distance to the minimum by the same factor, Eq. (6).",
)
def a_parabola_contracts_by_one_factor(t):
    """On a parabola the distance to the minimum is multiplied by 1 - tau lambda in each step."""
    curvature, center = float(t.rng.uniform(0.5, 3.0)), float(t.rng.uniform(-2.0, 2.0))
    for reach in (0.3, 1.6):
        x0, n = center + float(t.rng.uniform(0.5, 0.9)), 12
        f, df = parabola(curvature, center)
        x, loss, wrong = t.call("gd_1d", f, df, x0, reach / curvature, n, returns=walk(n))
        distance = (x0 - center) * (1.0 - reach) ** np.arange(n + 1)
        t.close("the points", x, center + distance)
        t.close("the values", loss, 0.5 * curvature * (np.asarray(x) - center) ** 2)
        t.require(not wrong, "the flag is True for a run that converges")


@check(
    "01.2.verdict",
    points=3,
    sole="what students can run; hidden checks find its mistakes as well",
    hint="The flag compares the last value with the first, Eq. (8).",
)
def the_verdict_changes_at_the_bound(t):
    """Just below tau = 2 / lambda the run converges, just above it diverges and says so."""
    curvature, center = float(t.rng.uniform(0.5, 3.0)), float(t.rng.uniform(3.0, 5.0))

    f, df = parabola(curvature, center)

    def go(reach, x0, n=30):
        return t.call("gd_1d", f, df, x0, reach / curvature, n, returns=walk(n))

    for x0 in (center - 0.5, center + 0.5):
        x, _, wrong = go(1.99, x0)
        t.require(abs(x[-1] - center) < 0.45, "below the bound the run must converge")
        t.require(not wrong, "below the bound the flag must be False")
        x, _, wrong = go(2.01, x0)
        t.require(abs(x[-1] - center) > 0.55, "above the bound the run must diverge")
        t.require(wrong, "above the bound the flag must be True")
    _, _, wrong = go(0.5, center)
    t.require(not wrong, "a run that starts in the minimum and stays has not gone wrong")
    _, _, wrong = go(2.1, center + 0.5, 1)
    t.require(wrong, "a single step that leads higher has gone wrong")
    # Two half parabolas, the left one steeper: down from 0.5 to -0.1, then up again to 0.38.
    _, _, wrong = t.call(
        "gd_1d",
        lambda y: y * y if y > 0.0 else 4.0 * y * y,
        lambda y: 2.0 * y if y > 0.0 else 8.0 * y,
        0.5,
        0.6,
        2,
        returns=walk(2),
    )
    t.require(not wrong, "the run ends lower than it began, so the flag should be False")
