"""Task 08.6, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, checks_for
from photograd_course.grading.adjoint_gate import agrees_with_finite_differences

from .common import EXACT, GATE, random_box

EARLIER = ("composite", "composite_adjoint", "ray_box", "trilinear", "trilinear_adjoint")

check = checks_for(calls=("render_adjoint",), needs=EARLIER)


def random_view(t, rays=5, shape=(3, 2, 4)):
    """Rays into a random volume, the last a miss: grid, low, high, origins, directions."""
    low, high = random_box(t)
    inside = t.rng.uniform(low, high, (rays, 3))
    direction = t.rng.normal(size=(rays, 3))
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    origins = inside - t.rng.uniform(5.0, 9.0, (rays, 1)) * direction
    direction[-1] *= -1
    grid = t.rng.uniform(0.2, 1.0, (*shape, 4))
    return grid, low, high, origins, direction * t.rng.uniform(0.3, 2.0, (rays, 1))


def slopes_of_view(shape):
    """Result of `render_adjoint`."""
    return Items(Array((*shape, 4)), Array((3,)), names=("d_grid", "d_background"))


@check(
    "08.6.differences",
    points=4,
    tolerance=GATE,
    hint="walk render_rays backward, line by line: what does each line's adjoint need?",
    sole="the gradient of the image, without the reference",
)
def the_picture_agrees_with_differences(t):
    """A small change of one voxel changes the image as your adjoint says."""
    grid, low, high, origins, directions = random_view(t)
    background, d_pixel = t.rng.uniform(0.0, 1.0, 3), t.rng.uniform(-1.0, 1.0, (5, 3))
    view = (low, high, origins, directions, 6)
    got = t.call(
        "render_adjoint", grid, *view, background, d_pixel, returns=slopes_of_view((3, 2, 4))
    )

    def forward(p):
        color_first = np.concatenate([p["color"], p["sigma"][..., None]], axis=3)
        return t.call("render_rays", color_first, *view, p["background"], returns=Array((5, 3)))

    point = {"sigma": grid[..., 3], "color": grid[..., :3], "background": background}
    slopes = {"sigma": got[0][..., 3], "color": got[0][..., :3], "background": got[1]}
    agrees_with_finite_differences(t, slopes, forward, point, d_pixel, GATE)


@check(
    "08.6.rays",
    points=3,
    tolerance=EXACT,
    hint="a ray that misses sees the background alone; derivatives of all rays are summed",
    sole="which voxels and which rays: no derivative is needed for that",
)
def rays_add_up_and_misses_see_the_background(t):
    """Sums over rays; a miss affects the background only; untouched voxels get zero."""
    grid, low, high, origins, directions = random_view(t, shape=(4, 5, 3))
    background, d_pixel = t.rng.uniform(0.0, 1.0, 3), t.rng.uniform(-1.0, 1.0, (5, 3))
    back = t.call(
        "render_adjoint",
        grid,
        low,
        high,
        origins,
        directions,
        7,
        background,
        d_pixel,
        returns=slopes_of_view((4, 5, 3)),
    )
    total = [np.zeros((4, 5, 3, 4)), np.zeros(3)]
    for r in range(5):
        one = slice(r, r + 1)
        alone = t.call(
            "render_adjoint",
            grid,
            low,
            high,
            origins[one],
            directions[one],
            7,
            background,
            d_pixel[one],
            returns=slopes_of_view((4, 5, 3)),
        )
        total = [whole + part for whole, part in zip(total, alone, strict=True)]
    t.close("d_grid of all rays", back[0], total[0])
    t.close("d_background of all rays", back[1], total[1])
    t.require(not alone[0].any(), "the last ray misses the box: its d_grid must be 0")
    t.close("d_background of a ray that misses", alone[1], d_pixel[-1], reveal=True)
    # Straight through the first layer of voxels: the last layer is not touched.
    middle = low + (high - low) * np.array([-1.0, 0.5, 0.1])
    back = t.call(
        "render_adjoint",
        grid,
        low,
        high,
        middle[None],
        np.array([[1.0, 0.0, 0.0]]),
        7,
        background,
        d_pixel[:1],
        returns=slopes_of_view((4, 5, 3)),
    )
    t.require(not back[0][:, :, 1:].any(), "voxels that no sample touches must get 0")
    t.require(bool(back[0][:, :, 0].any()), "d_grid is zero although a ray passes")
