"""Task 11.3, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, Tolerance, checks_for
from photograd_course.grading.adjoint_gate import (
    agrees_with_finite_differences,
    is_the_transpose,
    random_cotangent,
    require_zero_for_zero,
)
from photograd_course.grading.generators import unit_vectors

from .common import EXACT

check = checks_for(calls=("sh_color_adjoint",), needs=("sh_basis",), tolerance=EXACT)

SMOOTH = Tolerance(
    1e-6, "central differences leave 4e-10, the nearest wrong one (start_of_ones) 0.026"
)


def colors(rng, n, degree, channels):
    """Coefficients, vectors that are not unit vectors, and a cotangent."""
    v = unit_vectors(rng, n) * rng.uniform(0.5, 2.0, (n, 1))
    shape = (n, (degree + 1) ** 2, channels)
    return rng.uniform(-1.0, 1.0, shape), v, random_cotangent(rng, (n, channels))


def adjoint(t, c, v, g):
    """`sh_color_adjoint` of the submission."""
    parts = Items(Array(c.shape), Array(v.shape), names=("d_coefficients", "d_v"))
    return t.call("sh_color_adjoint", c, v, g, returns=parts)


@check(
    "11.3.coefficients",
    points=4,
    hint="handout, equation (11): colors are linear in the coefficients",
    sole="tests the coefficients only",
)
def the_adjoint_by_coefficients(t):
    """<colors of C, g> = <C, d_coefficients> for any C: the transpose."""
    for degree, channels in ((2, 3), (0, 1), (4, 2)):
        c, v, g = colors(t.rng, 5, degree, channels)
        d_c, _ = adjoint(t, c, v, g)
        for _ in range(3):
            x = t.rng.uniform(-1.0, 1.0, c.shape)
            forth = t.call("sh_color", x, v, returns=Array(g.shape))
            is_the_transpose(t, "<C, d_coefficients>", x, forth, g, d_c)


@check(
    "11.3.vectors",
    points=5,
    tolerance=SMOOTH,
    hint="handout, equations (12) to (14)",
    sole="the derivative itself, without the reference",
)
def the_adjoint_by_vectors(t):
    """A small change of a vector changes your colors by as much as your d_v says."""
    for degree, channels in ((1, 1), (2, 3), (4, 2)):
        c, v, g = colors(t.rng, 3, degree, channels)
        _, d_v = adjoint(t, c, v, g)

        def forward(point, c=c, shape=g.shape):
            return t.call("sh_color", c, point["v"], returns=Array(shape))

        agrees_with_finite_differences(t, {"v": d_v}, forward, {"v": v}, g, SMOOTH)


@check(
    "11.3.length",
    points=2,
    hint="handout, equation (14): a longer v alone changes no color",
    sole="names what the step from v to d leaves out",
)
def length_does_not_matter(t):
    """Along v nothing changes: v . d_v = 0; at twice the length d_v is half as long."""
    c, v, g = colors(t.rng, 6, 3, 2)
    d_c, d_v = adjoint(t, c, v, g)
    along = np.sum(d_v * v, axis=1)
    size = np.linalg.norm(d_v, axis=1) * np.linalg.norm(v, axis=1)
    floor = max(float(np.linalg.norm(size)), 1e-12)
    t.close(
        "v . d_v",
        along,
        0 * along,
        Tolerance(EXACT.relative, EXACT.evidence, floor=floor),
        reveal=True,
    )
    twice_c, twice = adjoint(t, c, 2 * v, g)
    t.close("d_v at 2 v", twice, d_v / 2)
    t.close("d_coefficients at 2 v", twice_c, d_c)
    nothing = adjoint(t, c, v, 0 * g)
    require_zero_for_zero(t, {"coefficients": nothing[0], "v": nothing[1]})
