"""Task 14.6, public checks."""

import numpy as np
from photograd_course.grading import Array, checks_for
from photograd_course.grading.adjoint_gate import random_cotangent, require_cheap

from .common import EXACT, GATE, differences

check = checks_for(calls=("landing_backward",))


def moved(t, heights, d_points):
    return t.call("landing_backward", heights, d_points, returns=Array(heights.shape))


def bumpy(t, cells, size=0.02):
    """A random smooth surface with slopes of some 0.3."""
    x, y = np.meshgrid(*[np.arange(cells + 1) / cells] * 2)
    heights = size * t.rng.uniform(-1, 1, (cells + 1, cells + 1)) / cells
    for _ in range(4):
        a, b, phase = t.rng.uniform(2, 5, 3)
        heights += size * np.sin(a * x + b * y + phase)
    return heights


@check(
    "14.6.flat",
    points=3,
    tolerance=EXACT,
    hint="a flat lens does not turn the light; a small slope turns it by (eta - 1) times the slope",
    sole="a flat lens, by hand",
)
def a_flat_lens(t):
    """A flat lens: a point moves by (eta - 1) times the distance times the change of the slope."""
    cells, level = 4, float(t.rng.uniform(0.1, 0.3))
    heights = np.full((5, 5), level)
    d_points = t.rng.uniform(-1, 1, (cells, cells, 2))
    got = moved(t, heights, d_points.reshape(-1, 2))
    right = np.zeros((5, 5))
    for row in range(cells):
        for column in range(cells):
            x, y = 0.5 * (1 - level) * d_points[row, column] * cells / 2
            right[row : row + 2, column : column + 2] += [[-x - y, x - y], [y - x, x + y]]
    t.close("d_heights", got, right, reveal=True)
    alone = np.zeros((16, 2))
    alone[5] = t.rng.uniform(0.5, 1, 2)
    got = moved(t, bumpy(t, cells), alone)
    places = {(int(i), int(j)) for i, j in np.argwhere(got)}
    t.require(
        places == {(1, 1), (1, 2), (2, 1), (2, 2)},
        "a ray through the cell (row 1, column 1) depends on the four corners of this cell alone",
    )


@check(
    "14.6.differences",
    points=4,
    tolerance=GATE,
    hint="a height is in the level and in both slopes of up to four cells: sum over all uses",
    sole="the definition: the given `landing_points`",
)
def the_gradient_agrees_with_differences(t):
    """A bumpy lens, against finite differences of the given `landing_points`."""
    for size in (0.02, 0.05):
        heights, d_points = bumpy(t, 5, size), random_cotangent(t.rng, (25, 2))

        def loss(surface, d_points=d_points):
            spec = Array((25, 2))
            return float(np.sum(d_points * t.call("landing_points", surface, returns=spec)))

        t.close("d_heights", moved(t, heights, d_points), differences(loss, heights))
        t.require(not moved(t, heights, 0 * d_points).any(), "not zero although d_points is zero")


@check(
    "14.6.cost",
    points=1,
    hint="one pass over the cells gives all derivatives",
    sole="finite differences would take two passes per height",
)
def the_gradient_is_cheap(t):
    """A lens of 64 x 64 cells: the gradient costs at most 20 times as much as the points."""
    heights, d_points = bumpy(t, 64), random_cotangent(t.rng, (4096, 2))
    t.require(bool(moved(t, heights, d_points).any()), "the gradient is zero everywhere")
    require_cheap(
        t,
        ("landing_points", (heights,), Array((4096, 2))),
        ("landing_backward", (heights, d_points), Array((65, 65))),
    )
