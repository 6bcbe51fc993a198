"""Task 12.1, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, checks_for

from .common import EXACT, GATE

check = checks_for(calls=("positional_encoding",), tolerance=EXACT)
ROOT = np.sqrt(0.5)


def encoded(t, x, bands):
    """`positional_encoding` of the submission."""
    both = Array((len(x), x.shape[1] * (2 * bands + 1)))
    parts = Items(both, both, names=("features", "derivatives"))
    return t.call("positional_encoding", x, bands, returns=parts)


@check(
    "12.1.values",
    points=3,
    hint="handout, equation (4): the point itself, then a sine and a cosine of each frequency",
    sole="small enough to work out by hand",
)
def known_features(t):
    """Features of known points: the order of columns, the factor pi, the number of bands."""
    x = np.array([[0.5], [0.25], [-1.0]])
    t.close("features without bands", encoded(t, x, 0)[0], x, reveal=True)
    # Columns: x, sine and cosine of a half turn, of a turn, of two turns per unit.
    table = np.array(
        [[0.5, 1, 0, 0, -1, 0, 1], [0.25, ROOT, ROOT, 1, 0, 0, -1], [-1.0, 0, -1, 0, 1, 0, 1]]
    )
    for bands in (1, 2, 3):
        features = encoded(t, x, bands)[0]
        t.close(f"features, L = {bands}", features, table[:, : 2 * bands + 1], reveal=True)
    two = encoded(t, np.array([[0.5, 0.25]]), 2)[0]
    t.close("features of (0.5, 0.25)", two, table[:2, :5].T.reshape(1, 10), reveal=True)


@check(
    "12.1.doubling",
    points=2,
    hint="handout, equation (4): bands double their frequency; the columns are sorted by band, "
    "then sines and cosines, then coordinates",
    sole="at points that no table has, for many bands",
)
def each_band_doubles_the_one_before(t):
    """sin 2a = 2 sin a cos a, cos 2a = 1 - 2 sin^2 a, from each band to the next."""
    x = t.rng.uniform(-1.0, 1.0, (5, 3))
    features = encoded(t, x, 6)[0][:, 3:].reshape(5, 6, 2, 3)
    s, c = features[:, :, 0], features[:, :, 1]
    t.close("sin^2 + cos^2", s**2 + c**2, np.ones(s.shape), reveal=True)
    t.close("sines of the next band", s[:, 1:], 2 * s[:, :-1] * c[:, :-1])
    t.close("cosines of the next band", c[:, 1:], 1 - 2 * s[:, :-1] ** 2)


@check(
    "12.1.derivatives",
    points=3,
    tolerance=GATE,
    adjoints=("positional_encoding",),
    hint="handout, equation (5): the chain rule; what is the derivative of the inside?",
    sole="the derivatives themselves, without the reference",
)
def derivatives_agree_with_differences(t):
    """Moving a coordinate moves its own features as your derivatives say, and no others."""
    for bands, dimensions in ((0, 2), (1, 1), (4, 3)):
        x = t.rng.uniform(-1.0, 1.0, (4, dimensions))
        derivatives = encoded(t, x, bands)[1]
        expected = np.zeros_like(derivatives)
        for axis in range(dimensions):
            step = 1e-5 * np.eye(dimensions)[axis]
            ends = [encoded(t, x + sign * step, bands)[0] for sign in (1, -1)]
            expected += (ends[0] - ends[1]) / 2e-5
        for band in range(bands + 1):
            # Each band apart: the last is the largest, and would hide the others.
            first = dimensions * max(2 * band - 1, 0)
            columns = slice(first, dimensions * (2 * band + 1))
            name = f"band {band - 1}" if band else "the coordinates"
            t.close(f"derivatives, {name}", derivatives[:, columns], expected[:, columns])
