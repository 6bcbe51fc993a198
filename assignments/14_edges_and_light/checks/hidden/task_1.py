"""Task 14.1, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Subject, Tolerance, checks_for

from ..common import covered

check = checks_for(calls=("edge_coverage",), visibility="hidden", adjoints=("edge_coverage",))

AREAS = Tolerance(1e-9, "right ones differ by 1e-15 of a pixel, wrong ones by 1e-3", floor=1.0)
FOUND = Tolerance(1e-6, "Gauss-Newton ends at 1e-14, with wrong derivatives at 1e-2 or more")


def edges(t, n):
    """Arguments of `edge_coverage`; every fourth edge is upright or level."""
    angle = t.rng.uniform(-7, 7, n)
    angle[::4] = np.round(angle[::4]) * np.pi / 2
    return angle, t.rng.uniform(-0.72, 0.72, n)


@check(
    "14.1.hidden",
    points=2,
    tolerance=AREAS,
    sole="unseen edges",
    battery=[Subject("edge_coverage", edges, lambda n: Items(*[Array((n,))] * 3), rows=(0, 1))],
)
def unseen_edges(t):
    """Random edges, compared with the solution."""
    angle, offset = edges(t, 300)
    right = t.reference.edge_coverage(angle, offset)
    for (name, got), expected in zip(covered(t, angle, offset).items(), right, strict=True):
        t.close(name, got, expected)


@check(
    "14.1.recover",
    points=2,
    tolerance=FOUND,
    sole="the application: an edge located far below a pixel",
)
def an_edge_is_recovered(t):
    """Angle and offset of an edge in a picture of 7 x 9 pixels, from three guesses."""
    for _ in range(3):
        angle, offset = float(t.rng.uniform(0.2, 1.2)), float(t.rng.uniform(-1.5, 1.5))
        picture = t.reference.half_plane_image(angle, offset, 7, 9)[0]
        start = angle + 0.4 * float(t.rng.choice([-1, 1])), offset + float(t.rng.uniform(-1, 1))
        got = t.call("recover_edge", picture, *start, 15, returns=Array((2,)))
        t.close("angle and offset", got, np.array([angle, offset]))
