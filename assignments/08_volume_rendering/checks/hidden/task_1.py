"""Task 08.1, hidden checks."""

from photograd_course.grading import Subject, hidden_check

from ..common import EXACT, random_rays, seen


@hidden_check(
    "08.1.hidden",
    points=2,
    calls=("composite",),
    tolerance=EXACT,
    sole="the same mistakes at unseen values",
    battery=[
        Subject("composite", random_rays, lambda n: seen(n, 3), rows=(0, 1, 2)),
        Subject(
            "composite",
            lambda t, n: random_rays(t, 2, n, 1, 0.1),
            lambda _: seen(2, 1),
            sizes=(1, 2),
        ),
    ],
)
def random_rays_are_composited(t):
    """Pixels and T_end are right for random rays, of one step and of many."""
    for rays, steps, channels in ((4, 1, 2), (1, 40, 3), (7, 9, 1)):
        given = random_rays(t, rays, steps, channels)
        pixel, T_end = t.call("composite", *given, returns=seen(rays, channels))
        right = t.reference.composite(*given)
        t.close("pixel", pixel, right[0])
        t.close("T_end", T_end, right[1])
