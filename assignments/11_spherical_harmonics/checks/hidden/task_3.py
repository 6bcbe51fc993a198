"""Task 11.3, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Subject, Tolerance, checks_for
from photograd_course.grading.adjoint_gate import require_cheap

from ..common import EXACT
from ..task_3 import adjoint, colors

check = checks_for(
    calls=("sh_color_adjoint",), needs=("sh_basis",), tolerance=EXACT, visibility="hidden"
)


@check(
    "11.3.hidden",
    points=5,
    sole="the same mistakes at unseen values",
    battery=[
        Subject(
            "sh_color_adjoint",
            lambda t, n: colors(t.rng, n, 3, 2),
            lambda n: Items(Array((n, 16, 2)), Array((n, 3))),
            rows=(0, 1, 2),
        )
    ],
)
def the_adjoint_at_random_values(t):
    """Both parts of the adjoint are right at random values, for each degree."""
    for degree, channels in ((0, 2), (1, 1), (2, 3), (3, 2), (4, 1)):
        c, v, g = colors(t.rng, 8, degree, channels)
        d_c, d_v = adjoint(t, c, v, g)
        right = t.reference.sh_color_adjoint(c, v, g)
        t.close(f"d_coefficients, degree {degree}", d_c, right[0])
        size = float(np.linalg.norm(c) * np.linalg.norm(g))
        t.close(
            f"d_v, degree {degree}",
            d_v,
            right[1],
            Tolerance(EXACT.relative, EXACT.evidence, floor=size / 100),
        )


@check("11.3.cost", points=2)
def the_adjoint_is_cheap(t):
    """For 60 colors of degree 4 the adjoint is right, and costs a few forward calls."""
    c, v, g = colors(t.rng, 60, 4, 3)
    d_c, d_v = adjoint(t, c, v, g)
    right = t.reference.sh_color_adjoint(c, v, g)
    t.close("d_coefficients", d_c, right[0])
    t.close("d_v", d_v, right[1])
    parts = Items(Array(c.shape), Array(v.shape), names=("d_coefficients", "d_v"))
    require_cheap(t, ("sh_color", (c, v), Array(g.shape)), ("sh_color_adjoint", (c, v, g), parts))
