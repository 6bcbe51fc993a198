"""Task 03.2, hidden checks."""

from photograd_course.grading import Array, Subject, checks_for
from photograd_course.grading.adjoint_gate import require_cheap

from ..common import EXACT, scatter
from .common import measured

check = checks_for(calls=("bilinear_sample_adjoint",), tolerance=EXACT, visibility="hidden")


@check(
    "03.2.hidden",
    points=4,
    sole="the same mistakes at unseen points",
    battery=[
        Subject(
            "bilinear_sample_adjoint",
            lambda t, n: ((3, 5), *measured(t, n)[1:]),
            lambda _: Array((3, 5, 2)),
        )
    ],
)
def the_adjoint_at_random_places(t):
    """The adjoint is right at random points, one texel wide textures included."""
    for shape in ((6, 3), (1, 9), (7, 1), (1, 1), (16, 11), (90, 70)):
        uv, g = t.rng.uniform(-0.5, 1.5, (150, 2)), t.rng.uniform(-1.0, 1.0, (150, 2))
        right = t.reference.bilinear_sample_adjoint(shape, uv, g)
        t.close("d_T", scatter(t, shape, uv, g), right)


@check("03.2.cost", points=2, needs=("bilinear_sample",))
def the_adjoint_is_cheap(t):
    """With 2,208 texels the adjoint is right, and costs a few forward calls."""
    uv, g = t.rng.uniform(0.0, 1.0, (3000, 2)), t.rng.uniform(-1.0, 1.0, (3000, 1))
    T, shape = t.rng.uniform(0.0, 1.0, (46, 48, 1)), (46, 48)
    right = t.reference.bilinear_sample_adjoint(shape, uv, g)
    t.close("d_T", scatter(t, shape, uv, g), right)
    require_cheap(
        t,
        ("bilinear_sample", (T, uv), Array((3000, 1))),
        ("bilinear_sample_adjoint", (shape, uv, g), Array((46, 48, 1))),
    )
