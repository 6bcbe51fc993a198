"""Task 07.2, public checks."""

import numpy as np
from photograd_course.grading import Array, checks_for

from .common import EXACT

check = checks_for(calls=("mis_weight",), tolerance=EXACT)


def weights_of(t, pdf, other):
    pdf, other = np.asarray(pdf, float), np.asarray(other, float)
    return t.call("mis_weight", pdf, other, returns=Array((len(pdf),)))


@check(
    "07.2.values",
    points=3,
    hint="equation (7): the squares of densities",
    sole="three numbers that can be worked out by hand",
)
def known_weights(t):
    """Three times the density: 0.9. Equal densities: one half."""
    s = float(t.rng.uniform(0.1, 10))
    got = weights_of(t, [3 * s, s, s, 2 * s], [s, 3 * s, s, s])
    t.close("weights of 3:1, 1:3, 1:1, 2:1", got, [0.9, 0.1, 0.5, 0.8], reveal=True)


@check(
    "07.2.sum",
    points=2,
    hint="the weights of the two strategies sum to 1",
    sole="no light is counted twice, and none is lost",
)
def weights_sum_to_one(t):
    """Over both strategies the weights sum to 1."""
    p, q = np.exp(t.rng.uniform(-7, 7, (2, 60)))
    t.close(
        "sum of both weights", weights_of(t, p, q) + weights_of(t, q, p), np.ones(60), reveal=True
    )


@check(
    "07.2.extremes",
    points=2,
    hint="divide by the larger of the two before you square",
    sole="densities of mirrors are unbounded, and some directions have density 0",
)
def weights_at_the_ends(t):
    """A density of 0, or of 1e200: 0, 1, or their ratio; never infinite."""
    s = float(t.rng.uniform(0.5, 1.0))
    got = weights_of(t, [0, 0, s, 1e200, 2e200 * s, 3e-200], [0, s, 0, 1, 1e200 * s, 1e-200])
    t.require(bool((got[:2] == 0).all()), "a sample of density 0 has weight 0, exactly")
    t.close("weights", got[2:], [1, 1, 0.8, 0.9], reveal=True)
