"""Task 08.4, public checks."""

import numpy as np
from photograd_course.grading import Array, checks_for
from photograd_course.grading.generators import cell_centers

from .common import EXACT, between_centers

check = checks_for(calls=("trilinear",), tolerance=EXACT)


@check(
    "08.4.centers",
    points=2,
    hint="handout, equation (16): which u belongs to the first voxel?",
    sole="says that coordinates and axes are right, whatever the weights",
)
def a_center_gives_its_voxel(t):
    """At the center of a voxel the sample is that voxel."""
    grid = t.rng.uniform(-1.0, 1.0, (2, 5, 3, 2))
    got = t.call("trilinear", grid, cell_centers((2, 5, 3)), returns=Array((30, 2)))
    t.close("samples", got, grid.reshape(30, 2), reveal=True)


@check(
    "08.4.products",
    points=2,
    hint="handout, equation (18): eight corners, each with a product of three weights",
    sole="what separates eight weights from fewer",
)
def products_stay_products(t):
    """Grids that hold x, y, z and their products are sampled without error."""
    shape = (4, 3, 6)
    factor = t.rng.uniform(1.0, 2.0, 3)

    def fields(u):
        x, y, z = (u * factor).T
        return np.stack([x, y, z, x * y, y * z, z * x, x * y * z], axis=1)

    u = between_centers(t, shape, 50)
    grid = fields(cell_centers(shape)).reshape(*shape, 7)
    got = t.call("trilinear", grid, u, returns=Array((50, 7)))
    t.close("samples", got, fields(u), reveal=True)


@check(
    "08.4.edge",
    points=2,
    hint="handout, equation (17): clamp the coordinate, then split it",
    sole="says that only the border is wrong",
)
def the_border_holds(t):
    """Beyond the outermost centers, and beyond the box, the value at the border is repeated."""
    shape = (3, 2, 4)
    grid = t.rng.uniform(-1.0, 1.0, (*shape, 2))
    corners = np.array(list(np.ndindex(2, 2, 2)), np.float64)
    got = t.call("trilinear", grid, corners, returns=Array((8, 2)))
    t.close("corners", got, grid[::2, :, ::3].reshape(8, 2), reveal=True)
    u, rim = t.rng.uniform(-0.5, 1.5, (60, 3)), 0.5 / np.array(shape)
    got = t.call("trilinear", grid, u, returns=Array((60, 2)))
    same = t.call("trilinear", grid, np.clip(u, rim, 1 - rim), returns=Array((60, 2)))
    t.close("samples", got, same)
