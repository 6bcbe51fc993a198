"""Task 08.6, hidden checks."""

from photograd_course.grading import Array, Subject, hidden_check
from photograd_course.grading.adjoint_gate import require_cheap

from ..task_6 import EARLIER, random_view, slopes_of_view
from .common import SUMS


def pictured(t, n):
    """Arguments of `render_adjoint` for n rays of 5 steps."""
    background, d_pixel = t.rng.uniform(0.0, 1.0, 3), t.rng.uniform(-1.0, 1.0, (n, 3))
    return *random_view(t, n, (4, 3, 5)), 5, background, d_pixel


@hidden_check(
    "08.6.hidden",
    points=3,
    calls=("render_adjoint",),
    needs=EARLIER,
    tolerance=SUMS,
    sole="the same mistakes in unseen views",
    battery=[Subject("render_adjoint", pictured, lambda _: slopes_of_view((4, 3, 5)))],
)
def the_picture_of_a_random_volume(t):
    """All derivatives are right for random volumes and rays, and cost a few pictures."""
    for rays, shape, n in ((9, (4, 3, 5), 8), (2, (1, 6, 2), 3)):
        view = random_view(t, rays, shape)
        background, d_pixel = t.rng.uniform(0.0, 1.0, 3), t.rng.uniform(-1.0, 1.0, (rays, 3))
        got = t.call("render_adjoint", *view, n, background, d_pixel, returns=slopes_of_view(shape))
        right = t.reference.render_adjoint(*view, n, background, d_pixel)
        t.close("d_grid", got[0], right[0])
        t.close("d_background", got[1], right[1])
    shape = (10, 8, 9)
    given = (*random_view(t, 60, shape), 24)
    background, d_pixel = t.rng.uniform(0.0, 1.0, 3), t.rng.uniform(-1.0, 1.0, (60, 3))
    require_cheap(
        t,
        ("render_rays", (*given, background), Array((60, 3))),
        ("render_adjoint", (*given, background, d_pixel), slopes_of_view(shape)),
    )
