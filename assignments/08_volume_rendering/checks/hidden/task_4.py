"""Task 08.4, hidden checks."""

from photograd_course.grading import Array, Subject, hidden_check

from ..common import EXACT
from .common import placed


@hidden_check(
    "08.4.hidden",
    points=2,
    calls=("trilinear",),
    tolerance=EXACT,
    sole="the same mistakes at unseen points",
    battery=[Subject("trilinear", placed, lambda n: Array((n, 2)), rows=(1,))],
)
def samples_at_random_points(t):
    """Samples are right at random points of random grids, one voxel wide ones included."""
    for shape in ((6, 3, 4, 2), (1, 5, 2, 1), (1, 1, 1, 3), (40, 30, 20, 2), (2, 3, 2, 60)):
        grid, u = t.rng.uniform(-1.0, 1.0, shape), t.rng.uniform(-0.5, 1.5, (90, 3))
        got = t.call("trilinear", grid, u, returns=Array((90, shape[3])))
        t.close("samples", got, t.reference.trilinear(grid, u))
