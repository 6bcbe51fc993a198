"""Task 14.6, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, checks_for
from photograd_course.grading.adjoint_gate import random_cotangent

from ..common import EXACT
from ..task_6 import bumpy, moved

check = checks_for(calls=("landing_backward",), visibility="hidden")


def arguments(t, n):
    """Arguments of `landing_backward` for n x n cells."""
    return bumpy(t, n), random_cotangent(t.rng, (n * n, 2))


@check(
    "14.6.hidden",
    points=2,
    tolerance=EXACT,
    sole="unseen lenses",
    battery=[Subject("landing_backward", arguments, lambda n: Array((n + 1, n + 1)), large=32)],
)
def unseen_lenses(t):
    """Random lenses, compared with the solution."""
    for cells in (3, 20):
        given = arguments(t, cells)
        t.close("d_heights", moved(t, *given), t.reference.landing_backward(*given))


@check(
    "14.6.caustic", points=2, seconds=30, sole="the application: two letters, thrown on a screen"
)
def a_caustic_shows_the_letters(t):
    """Two unseen letters: the light on the screen correlates with them by 0.9 or more."""
    letters = "".join(chr(65 + int(each)) for each in t.rng.integers(26, size=2))
    target = t.reference.letters_image(letters, 24)
    heights = t.call("adapters.lens_found", target, 40, 30, returns=Array((41, 41)))
    shown = t.reference.splat(t.reference.landing_points(heights), 24)
    likeness = float(np.corrcoef(shown.ravel(), target.ravel())[0, 1])
    t.require(likeness >= 0.9, f"the correlation with the letters is {likeness:.2f}, below 0.9")
