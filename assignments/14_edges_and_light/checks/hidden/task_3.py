"""Task 14.3, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Number, Subject, checks_for
from photograd_course.grading.adjoint_gate import random_cotangent

from ..common import EXACT, stroke_slopes

check = checks_for(calls=("stroke_backward",), visibility="hidden")


def stroke(t, n):
    """Arguments of `stroke_backward`, for a picture of n + 5 rows."""
    curve = np.array([[1.0, 1], [8, 0], [9, 7]]) + t.rng.uniform(-1, 1, (3, 2))
    return curve, float(t.rng.uniform(0.5, 3)), random_cotangent(t.rng, (n + 5, 11))


@check(
    "14.3.hidden",
    points=2,
    tolerance=EXACT,
    sole="unseen strokes",
    battery=[
        Subject("stroke_backward", stroke, lambda _: Items(Array((3, 2)), Number()), large=150)
    ],
)
def unseen_strokes(t):
    """Random strokes, compared with the solution."""
    for n in (3, 10, 0):
        given = stroke(t, n)
        if n == 0:  # a center lies on the curve, at its start
            given[0][0] = 1.5, 2.5
        right = t.reference.stroke_backward(*given)
        got = stroke_slopes(t, *given)
        t.close("d_curve", got[0], right[0])
        t.close("d_width", got[1], right[1])


@check("14.3.recover", points=2, sole="the application: how bold a stroke is")
def a_stroke_is_recovered(t):
    """The width within 1 %, and each control point within 0.2 pixels."""
    curve = np.array([[3.0, 4], [9, 1], [13, 12]]) + t.rng.uniform(-1, 1, (3, 2))
    width = float(t.rng.uniform(1.5, 3))
    picture = t.reference.stroke_image(curve, width, 16, 16)
    start = curve + t.rng.uniform(-1, 1, (3, 2))
    parts = Items(Array((3, 2)), Number(), names=("curve", "width"))
    got = t.call("recover_stroke", picture, start, 2.0, 90, returns=parts)
    error = abs(got[1] / width - 1)
    t.require(error < 0.01, f"the width is off by {100 * error:.1f} %")
    ends = [float(np.hypot(*(each - curve).T).max()) for each in (got[0], got[0][::-1])]
    t.require(min(ends) < 0.2, f"a control point is off by {min(ends):.2f} pixels")
