"""Task 09.2, public checks."""

import numpy as np
from photograd_course.grading import checks_for

from .common import EXACT, batch, random_views

check = checks_for(calls=("ray_batch",), tolerance=EXACT)


def unit(v):
    """Rows of length 1."""
    return v / np.maximum(np.linalg.norm(v, axis=1, keepdims=True), 1e-300)


@check(
    "09.2.middle",
    points=3,
    hint="handout, section 2: the pose's columns are right, down, forward, and the place",
    sole="names the part of the pose that is misread",
)
def the_middle_pixel_looks_forward(t):
    """With odd H and W the middle ray starts at the camera and follows its forward axis."""
    views = random_views(t, 3, 5, 7)
    poses = views["world_from_camera"]
    poses[:, :3, 3] += t.rng.normal(size=(3, 3))  # or o would lie along the forward axis
    middle = np.array([k * 35 + 2 * 7 + 3 for k in (2, 0, 1)])
    origins, directions, _ = t.call("ray_batch", views, middle, returns=batch(3))
    t.close("origins", origins, poses[[2, 0, 1], :3, 3], reveal=True)
    t.close("directions, made unit vectors", unit(directions), poses[[2, 0, 1], :3, 2], reveal=True)


@check(
    "09.2.projected",
    points=4,
    hint="handout, equations (4) to (6): what projects to the center of that pixel?",
    sole="needs no formula for a ray: only that it is seen where it should be",
)
def points_of_a_ray_are_seen_in_its_pixel(t):
    """A point on a ray projects to the center of the pixel, in pictures of any shape."""
    for rows, columns in ((3, 5), (6, 4)):
        views = random_views(t, 2, rows, columns)
        chosen = t.rng.permutation(2 * rows * columns)[:9]
        origins, directions, _ = t.call("ray_batch", views, chosen, returns=batch(9))
        view, row, column = np.unravel_index(chosen, (2, rows, columns))
        point = origins + t.rng.uniform(1.0, 3.0, (9, 1)) * directions
        pose = views["world_from_camera"][view]
        seen = np.einsum("rji,rj->ri", pose[:, :3, :3], point - pose[:, :3, 3])
        t.require(bool((seen[:, 2] > 0).all()), "a ray goes backward: forward is +z")
        places = views["focal"] * seen[:, :2] / seen[:, 2:] + [columns / 2, rows / 2]
        t.close(
            "where points are seen (column, row)",
            places,
            np.stack([column + 0.5, row + 0.5], axis=1),
            reveal=True,
        )


@check(
    "09.2.truth",
    points=2,
    hint="pixels are counted as they lie in memory: picture by picture, row by row",
    sole="tests the colors only",
)
def colors_belong_to_the_chosen_pixels(t):
    """The colors are those of the chosen pixels, in that order, repeated ones too."""
    views = random_views(t, 3, 2, 4)
    chosen = np.array([23, 0, 5, 8, 5, 16, 19])
    _, _, truth = t.call("ray_batch", views, chosen, returns=batch(7))
    t.close("truth", truth, views["pictures"].reshape(-1, 3)[chosen], reveal=True)
