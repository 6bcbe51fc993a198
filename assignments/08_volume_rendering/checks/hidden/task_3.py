"""Task 08.3, hidden checks."""

from photograd_course.grading import Subject, hidden_check

from ..common import EXACT, random_box
from ..task_3 import spans


def cast(t, n):
    """Arguments of `ray_box`: n rays about a box, some of which hit."""
    return *random_box(t), t.rng.uniform(-2.0, 2.0, (n, 3)), t.rng.normal(size=(n, 3))


@hidden_check(
    "08.3.hidden",
    points=2,
    calls=("ray_box",),
    tolerance=EXACT,
    sole="the same mistakes at unseen rays",
    battery=[Subject("ray_box", cast, spans, rows=(2, 3))],
)
def random_rays_and_boxes(t):
    """Entry and exit are right for random rays, hits and misses, from outside and inside."""
    low, high = random_box(t)
    origins, directions = t.rng.uniform(-4.0, 4.0, (300, 3)), t.rng.normal(size=(300, 3))
    directions[::7, 1] = 0.0
    near, far = t.call("ray_box", low, high, origins, directions, returns=spans(300))
    right = t.reference.ray_box(low, high, origins, directions)
    t.close("t_near", near, right[0])
    t.close("t_far", far, right[1])
