"""Task 09.2, hidden checks."""

from photograd_course.grading import Subject, hidden_check
from photograd_course.grading.generators import random_rotation

from ..common import EXACT, batch, random_views
from ..task_2 import unit


@hidden_check(
    "09.2.hidden",
    points=3,
    calls=("ray_batch",),
    tolerance=EXACT,
    sole="the same mistakes at unseen cameras",
    battery=[
        Subject(
            "ray_batch",
            lambda t, n: (random_views(t), t.rng.integers(0, 24, n)),
            batch,
            rows=(1,),
            common=lambda _t, _args, got: [got[0], unit(got[1]), got[2]],
        )
    ],
)
def rays_of_random_cameras(t):
    """Rays and colors are right for random cameras and pixels."""
    for count, rows, columns in ((4, 3, 6), (1, 7, 2), (2, 1, 1)):
        views = random_views(t, count, rows, columns)
        views["world_from_camera"][:, :3, :3] = [random_rotation(t.rng) for _ in range(count)]
        chosen = t.rng.integers(0, count * rows * columns, 11)
        got = t.call("ray_batch", views, chosen, returns=batch(11))
        right = t.reference.ray_batch(views, chosen)
        t.close("origins", got[0], right[0])
        t.close("directions, made unit vectors", unit(got[1]), unit(right[1]))
        t.close("truth", got[2], right[2])
