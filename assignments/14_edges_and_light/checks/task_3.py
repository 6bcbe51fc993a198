"""Task 14.3, public checks."""

import numpy as np
from photograd_course.grading import Array, checks_for
from photograd_course.grading.adjoint_gate import random_cotangent

from .common import EXACT, GATE, differences, stroke_slopes

check = checks_for(calls=("stroke_backward",))

RADIUS = np.sqrt(1 / np.pi)


def chord_of(offset):
    """Length of an edge in a round pixel, at this distance from its center."""
    return 2 * np.sqrt(np.maximum(RADIUS**2 - np.square(offset), 0))


@check(
    "14.3.straight",
    points=3,
    tolerance=EXACT,
    hint="equations (12) to (14): two edges, each as long as its chord in the round pixel",
    sole="single pixels of a straight stroke, by hand",
)
def a_straight_stroke(t):
    """One pixel of a level stroke: the chords of its two edges, and how the curve shares them."""
    y = 6.5 + float(t.rng.uniform(-0.3, 0.3))
    curve = np.array([[1.5, y], [8.5, y], [15.5, y]])
    for row, column, width in ((6, 8, 0.6), (6, 5, 0.2), (7, 10, 1.4)):
        d_alpha = np.zeros((13, 17))
        d_alpha[row, column] = 1.0
        d_curve, d_width = stroke_slopes(t, curve, width, d_alpha)
        away = row + 0.5 - y
        near, beyond = (chord_of(width / 2 + sign * abs(away)) for sign in (-1, 1))
        t.close("d_width of one pixel", d_width, (near + beyond) / 2, reveal=True)
        u = (column + 0.5 - 1.5) / 14
        shares = np.array([(1 - u) ** 2, 2 * u * (1 - u), u * u])
        push = np.sign(away) * (near - beyond)
        t.close("y of d_curve of one pixel", d_curve[:, 1], shares * push, reveal=True)
        t.require(
            bool(np.abs(d_curve[:, 0]).max() < 1e-9),
            "moving a level stroke along itself changes no pixel above it",
        )


@check(
    "14.3.differences",
    points=4,
    tolerance=GATE,
    hint="the nearest point moves as well, but that does not change the distance: equation (13)",
    sole="the definition: the given `stroke_image`",
)
def the_gradient_agrees_with_differences(t):
    """A bold stroke, and one so thin that both edges are in one pixel; `stroke_image` is given."""
    for low, high in ((1.2, 3.0), (0.2, 0.5)):
        curve = np.array([[3.0, 3], [11, 2], [9, 12]]) + t.rng.uniform(-1, 1, (3, 2))
        width, d_alpha = float(t.rng.uniform(low, high)), random_cotangent(t.rng, (13, 15))

        def loss(x, d_alpha=d_alpha):
            spec = Array((13, 15))
            shown = t.call("stroke_image", x[:6].reshape(3, 2), float(x[6]), 13, 15, returns=spec)
            return float(np.sum(shown * d_alpha))

        expected = differences(loss, np.append(curve, width))
        d_curve, d_width = stroke_slopes(t, curve, width, d_alpha)
        t.close("d_curve", d_curve, expected[:6].reshape(3, 2))
        t.close("d_width", d_width, expected[6])
        d_curve, d_width = stroke_slopes(t, curve, width, 0 * d_alpha)
        t.require(not d_curve.any() and d_width == 0, "not zero although d_alpha is zero")
