"""Task 08.5, hidden checks."""

from photograd_course.grading import Array, Subject, hidden_check
from photograd_course.grading.adjoint_gate import require_cheap

from ..common import EXACT
from .common import placed


@hidden_check(
    "08.5.hidden",
    points=2,
    calls=("trilinear_adjoint",),
    tolerance=EXACT,
    needs=("trilinear",),
    sole="the same mistakes at unseen points",
    battery=[
        Subject(
            "trilinear_adjoint",
            lambda t, n: ((3, 1, 4), placed(t, n)[1], t.rng.uniform(-1, 1, (n, 2))),
            lambda _: Array((3, 1, 4, 2)),
        )
    ],
)
def the_adjoint_at_random_points(t):
    """The adjoint is right at random points, one voxel wide grids included, and cheap."""
    for shape in ((6, 3, 4), (1, 5, 2), (1, 1, 1), (40, 30, 20)):
        u, g = t.rng.uniform(-0.5, 1.5, (90, 3)), t.rng.uniform(-1.0, 1.0, (90, 2))
        got = t.call("trilinear_adjoint", shape, u, g, returns=Array((*shape, 2)))
        t.close("d_grid", got, t.reference.trilinear_adjoint(shape, u, g))
    shape = (14, 12, 13)
    grid, u = t.rng.uniform(0.0, 1.0, (*shape, 1)), t.rng.uniform(0.0, 1.0, (2000, 3))
    g = t.rng.uniform(-1.0, 1.0, (2000, 1))
    require_cheap(
        t,
        ("trilinear", (grid, u), Array((2000, 1))),
        ("trilinear_adjoint", (shape, u, g), Array((*shape, 1))),
    )
