"""Task 08.2, hidden checks."""

from photograd_course.grading import Subject, checks_for
from photograd_course.grading.adjoint_gate import require_cheap

from ..common import random_rays, seen
from ..task_2 import slopes_of
from .common import SUMS

check = checks_for(
    calls=("composite_adjoint",), needs=("composite",), tolerance=SUMS, visibility="hidden"
)

# A forward pass in whole arrays and an adjoint that walks the steps in a loop, as the handout has
# it, stand 5 to 8 to one, what goes through the pipe included; one that walks all later steps for
# each step, 100 to one or more.
RAY_COST = 30.0


def moved(t, n):
    """Arguments of `composite_adjoint` for n rays of 6 steps."""
    return *random_rays(t, n), t.rng.uniform(-1, 1, (n, 3)), t.rng.uniform(-1, 1, n)


@check(
    "08.2.hidden",
    points=4,
    sole="the same mistakes at unseen values",
    battery=[Subject("composite_adjoint", moved, lambda n: slopes_of((n, 6), 3))],
)
def adjoints_of_random_rays(t):
    """All derivatives are right for random rays, of one step and of many."""
    for rays, steps, channels in ((4, 1, 2), (1, 40, 3), (7, 9, 1)):
        given = random_rays(t, rays, steps, channels, thick=min(1.5, 6 / steps))
        d = t.rng.uniform(-1, 1, (rays, channels)), t.rng.uniform(-1, 1, rays)
        got = t.call("composite_adjoint", *given, *d, returns=slopes_of((rays, steps), channels))
        right = t.reference.composite_adjoint(*given, *d)
        for name, mine, yours in zip(("sigma", "color", "background"), right, got, strict=True):
            t.close(f"d_{name}", yours, mine)


@check("08.2.cost", points=2)
def the_adjoint_of_a_ray_is_cheap(t):
    """For rays of 160 steps the adjoint is right, and costs a few forward calls."""
    given = random_rays(t, 80, 160, 3, thick=0.1)
    d = t.rng.uniform(-1, 1, (80, 3)), t.rng.uniform(-1, 1, 80)
    answer = slopes_of((80, 160), 3)
    got = t.call("composite_adjoint", *given, *d, returns=answer)
    for yours, mine in zip(got, t.reference.composite_adjoint(*given, *d), strict=True):
        t.close("derivatives", yours, mine)
    require_cheap(
        t, ("composite", given, seen(80, 3)), ("composite_adjoint", (*given, *d), answer), RAY_COST
    )
