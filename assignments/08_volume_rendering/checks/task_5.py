"""Task 08.5, public checks."""

import numpy as np
from photograd_course.grading import Array, checks_for
from photograd_course.grading.adjoint_gate import is_the_transpose, matrix_of, require_zero_for_zero
from photograd_course.grading.generators import cell_centers

from .common import EXACT, between_centers

check = checks_for(calls=("trilinear_adjoint",), tolerance=EXACT)


@check(
    "08.5.single",
    points=2,
    hint="g times the weight that the voxel had in the sample",
    sole="tests one sample, without the forward function",
)
def one_sample_is_spread_around_its_place(t):
    """What one sample scatters sums to g, and is balanced around the sample's point."""
    shape = (4, 2, 5)
    for _ in range(5):
        u, g = between_centers(t, shape, 1), t.rng.uniform(0.5, 2.0, (1, 1))
        got = t.call("trilinear_adjoint", shape, u, g, returns=Array((*shape, 1))).ravel()
        t.close("sum over all voxels", got.sum(), g[0, 0], reveal=True)
        t.close("balance (x, y, z)", got @ cell_centers(shape) / g[0, 0], u[0], reveal=True)
        t.require(
            bool((got >= 0).all()) and np.count_nonzero(got) <= 8,
            "a positive g must reach at most eight voxels, none negatively",
        )


@check(
    "08.5.transpose",
    points=3,
    needs=("trilinear",),
    hint="the weights of the forward pass, from sample to voxel; are repeated points summed?",
    sole="the definition of an adjoint",
)
def the_adjoint_is_the_transpose(t):
    """<S x, g> = <x, S* g> for any grid x and any g, also where points repeat."""
    for shape in ((3, 2, 4), (1, 5, 2)):
        u = t.rng.uniform(-0.1, 1.1, (15, 3))
        u = np.concatenate([u, u[:5]])
        x, g = t.rng.uniform(-1.0, 1.0, (*shape, 2)), t.rng.uniform(-1.0, 1.0, (20, 2))
        back = t.call("trilinear_adjoint", shape, u, g, returns=Array((*shape, 2)))
        forth = t.call("trilinear", x, u, returns=Array((20, 2)))
        is_the_transpose(t, "<x, S* g>", x, forth, g, back)
        t.close("S* g", back.reshape(-1, 2), matrix_of(t, "trilinear", shape, u).T @ g)
    nothing = t.call("trilinear_adjoint", shape, u, 0 * g, returns=Array((*shape, 2)))
    require_zero_for_zero(t, {"grid": nothing})


@check(
    "08.5.repeated",
    points=2,
    hint="d_grid[i, j, k] += values adds once where an index occurs twice",
    sole="names the mistake of a scatter that forgets",
)
def repeated_places_add_up(t):
    """A point sampled ten times scatters the sum of its ten numbers."""
    shape = (3, 4, 2)
    u, g = t.rng.uniform(0.0, 1.0, (3, 3)), t.rng.uniform(0.5, 1.5, (30, 2))
    many = t.call("trilinear_adjoint", shape, np.tile(u, (10, 1)), g, returns=Array((3, 4, 2, 2)))
    total = np.zeros((3, 4, 2, 2))
    for k in range(3):
        total += t.call(
            "trilinear_adjoint",
            shape,
            u[k : k + 1],
            g[k::3].sum(axis=0)[None],
            returns=Array((3, 4, 2, 2)),
        )
    t.close("d_grid", many, total)
