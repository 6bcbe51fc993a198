"""Task 03.1, public checks."""

import numpy as np
from photograd_course.grading import checks_for

from .common import EXACT, centers, sample

check = checks_for(calls=("bilinear_sample",), tolerance=EXACT)


@check(
    "03.1.centers",
    points=2,
    hint="handout, equation (3): which u belongs to column 0?",
    sole="says that the coordinates are right, whatever the weights",
)
def a_center_gives_its_texel(t):
    """At the center of a texel, the sample is that texel."""
    T = t.rng.uniform(-1.0, 1.0, (3, 5, 2))
    t.close("samples", sample(t, T, centers((3, 5))), T.reshape(15, 2), reveal=True)


@check(
    "03.1.ramp",
    points=3,
    hint="handout, equation (6): which texel belongs to which weight?",
    sole="says that the weights are right, on a picture one can draw",
)
def a_ramp_stays_a_ramp(t):
    """A texture that is linear to the right and downward is sampled without error."""
    shape = (4, 7)
    across, down = t.rng.uniform(1.0, 2.0, 2) * np.array([1.0, -2.0])
    T = (centers(shape) @ [across, down]).reshape(*shape, 1)
    uv = t.rng.uniform([0.5 / 7, 0.5 / 4], [1 - 0.5 / 7, 1 - 0.5 / 4], (60, 2))
    t.close("samples", sample(t, T, uv)[:, 0], uv @ [across, down], reveal=True)


@check(
    "03.1.product",
    points=2,
    hint="handout, equation (6): four products of weights, and the texel of each",
    sole="what separates four weights from three",
)
def a_product_stays_a_product(t):
    """The texture u v is sampled without error: the surface between four texels is twisted."""
    shape = (5, 3)
    T = np.prod(centers(shape), axis=1).reshape(*shape, 1)
    uv = t.rng.uniform([0.5 / 3, 0.5 / 5], [1 - 0.5 / 3, 1 - 0.5 / 5], (60, 2))
    t.close("samples", sample(t, T, uv)[:, 0], np.prod(uv, axis=1), reveal=True)


@check(
    "03.1.constant",
    points=2,
    hint="the four weights sum to 1 everywhere, at the border too",
    sole="a constant sees nothing but the sum of the weights",
)
def a_constant_stays_constant(t):
    """A constant texture gives its constant everywhere."""
    value = t.rng.uniform(1.0, 2.0, 3)
    uv = t.rng.uniform(0.0, 1.0, (80, 2))
    T = np.tile(value, (2, 6, 1))
    t.close("samples", sample(t, T, uv), np.tile(value, (80, 1)), reveal=True)


@check(
    "03.1.edge",
    points=3,
    hint="handout, equation (4): clamp the coordinate, then split it",
    sole="says that only the border is wrong",
)
def the_border_holds(t):
    """Beyond the outermost centers, and beyond the texture, the value at the border holds."""
    shape = (3, 4)
    T = t.rng.uniform(-1.0, 1.0, (*shape, 2))
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    t.close("corners", sample(t, T, corners), T[::2, ::3].reshape(4, 2), reveal=True)
    uv = t.rng.uniform(-0.5, 1.5, (80, 2))
    inside = np.clip(uv, [0.5 / 4, 0.5 / 3], [1 - 0.5 / 4, 1 - 0.5 / 3])
    t.close("samples", sample(t, T, uv), sample(t, T, inside))
