"""Task 03.2, public checks."""

import numpy as np
from photograd_course.grading import checks_for
from photograd_course.grading.adjoint_gate import is_the_transpose, matrix_of, require_zero_for_zero

from .common import EXACT, centers, sample, scatter

check = checks_for(calls=("bilinear_sample_adjoint",), tolerance=EXACT)


@check(
    "03.2.single",
    points=3,
    hint="handout, equation (7): g times the weight that the texel had",
    sole="tests one sample, without the forward function",
)
def one_sample_is_spread_around_its_place(t):
    """What one sample scatters sums to g, and is balanced around the sample's point."""
    shape = (4, 6)
    for _ in range(5):
        uv = t.rng.uniform([0.5 / 6, 0.5 / 4], [1 - 0.5 / 6, 1 - 0.5 / 4], (1, 2))
        g = t.rng.uniform(0.5, 2.0, (1, 1))
        d_T = scatter(t, shape, uv, g).ravel()
        t.close("sum over all texels", d_T.sum(), g[0, 0], reveal=True)
        t.close("balance (u, v)", d_T @ centers(shape) / g[0, 0], uv[0], reveal=True)
        t.require(
            bool((d_T >= 0).all()) and np.count_nonzero(d_T) <= 4,
            "a positive g must reach at most four texels, none negatively",
        )


@check(
    "03.2.transpose",
    points=5,
    needs=("bilinear_sample",),
    hint="handout, section 2: the same weights as in the forward pass, from sample to texel",
    sole="the definition of an adjoint",
)
def the_adjoint_is_the_transpose(t):
    """<S x, g> = <x, S* g> for any texture x and any g: on textures that are not square."""
    for shape in ((3, 7), (6, 2), (1, 5)):
        uv = t.rng.uniform(0.0, 1.0, (25, 2))
        x, g = t.rng.uniform(-1.0, 1.0, (*shape, 2)), t.rng.uniform(-1.0, 1.0, (25, 2))
        back = scatter(t, shape, uv, g)
        forth = sample(t, x, uv)
        is_the_transpose(t, "<x, S* g>", x, forth, g, back)
        matrix = matrix_of(t, "bilinear_sample", shape, uv)
        t.close("S* g", back.reshape(-1, 2), matrix.T @ g)
    require_zero_for_zero(t, {"T": scatter(t, shape, uv, 0 * g)})


@check(
    "03.2.repeated",
    points=4,
    hint="often: d_T[rows, columns] += values, which adds once where an index occurs twice",
    sole="names the mistake of a scatter that forgets",
)
def repeated_places_add_up(t):
    """A point measured ten times scatters the sum of its ten numbers."""
    shape = (5, 3)
    uv = t.rng.uniform(0.0, 1.0, (4, 2))
    g = t.rng.uniform(0.5, 1.5, (40, 2))
    many = scatter(t, shape, np.tile(uv, (10, 1)), g)
    total = np.zeros((5, 3, 2))
    for k in range(4):
        summed = g[k::4].sum(axis=0)[None]
        total += scatter(t, shape, uv[k : k + 1], summed)
    t.close("d_T", many, total)


@check(
    "03.2.edge",
    points=2,
    hint="clamp as in the forward pass (which of u, v with which side?); equal indices are summed",
    sole="says that only the border is wrong",
)
def a_corner_gets_it_all(t):
    """A sample in a corner of the texture, or beyond it, belongs to one texel alone."""
    shape, g = (3, 4), t.rng.uniform(0.5, 1.5, (4, 1))
    uv = np.array([[0.01, 0.02], [0.98, -0.2], [-3.0, 0.99], [1.0, 1.0]])
    expected = np.zeros((3, 4, 1))
    expected[::2, ::3] = g.reshape(2, 2, 1)
    t.close("d_T", scatter(t, shape, uv, g), expected, reveal=True)
