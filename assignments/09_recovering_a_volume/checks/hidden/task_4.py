"""Task 09.4, hidden checks."""

from photograd_course.grading import Number, Subject, hidden_check
from photograd_course.grading.adjoint_gate import require_cheap

from ..common import EXACT, loss_and_slope, rough

# One pass over a picture against total variation of as many numbers with its derivative: 20 to 40
# where whole arrays are used, 700 in loops over single numbers, 40,000 for differences.
TV_COST = 2500.0


@hidden_check(
    "09.4.hidden",
    points=4,
    calls=("tv_loss_adjoint",),
    needs=("psnr",),
    tolerance=EXACT,
    sole="the same mistakes at unseen volumes",
    battery=[
        Subject(
            "tv_loss_adjoint",
            lambda t, n: (t.rng.uniform(0.0, 1.0, (n, 2, 3, 4)), 0.1),
            lambda n: loss_and_slope((n, 2, 3, 4)),
        )
    ],
)
def the_roughness_of_random_volumes(t):
    """Total variation and its derivative are right for random volumes, and cheap."""
    for shape, eps in (
        ((4, 3, 5, 4), 0.1),
        ((1, 6, 2, 1), 0.01),
        ((1, 1, 1, 3), 0.5),
        ((40, 9, 12, 4), 0.1),
    ):
        grid = t.rng.uniform(0.0, 1.0, shape)
        got, right = rough(t, grid, eps), t.reference.tv_loss_adjoint(grid, eps)
        t.close("loss", got[0], right[0])
        t.close("d_grid", got[1], right[1])
    grid, other = t.rng.uniform(0.0, 1.0, (2, 8, 8, 8, 4))
    require_cheap(
        t,
        ("psnr", (grid, other), Number()),
        ("tv_loss_adjoint", (grid, 0.1), loss_and_slope(grid.shape)),
        TV_COST,
    )
