"""Task 15.4, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, checks_for
from photograd_course.grading.adjoint_gate import (
    agrees_with_finite_differences,
    random_cotangent,
    require_zero_for_zero,
)

from .common import EXACT, GATE

check = checks_for(calls=("composite_splats",), tolerance=EXACT)


def blended(t, a, c, z, b):
    """The values of `composite_splats`."""
    return t.call("adapters.composite_splats", a, c, z, b, returns=Array((a.shape[1], 3)))


def blended_back(t, a, c, z, b, g):
    """Result of the `back` of `composite_splats`."""
    parts = Items(
        Array(a.shape), Array(c.shape), Array((3,)), names=("d_alpha", "d_colors", "d_background")
    )
    return t.call("adapters.composite_splats_back", a, c, z, b, g, returns=parts)


def layers(rng, n, p):
    """Splats in no order, here and there unseen; (alpha, colors, depth, background)."""
    a = rng.uniform(0.1, 0.9, (n, p))
    a[rng.random((n, p)) < 0.3] = 0.0
    return a, rng.uniform(0.0, 1.0, (n, 3)), 1.0 + rng.permutation(n) / 3, rng.uniform(0.0, 1.0, 3)


@check(
    "15.4.layers",
    points=2,
    hint="sort by depth, then call your composite of 08; is `photograd course check 08` green?",
    sole="small enough to work out by hand",
)
def known_layers(t):
    """Nothing shows the background; one splat mixes; of equal depth the first row is in front.

    Many rows of few depths: with three rows a sort that is not stable may look as if it were.
    """
    c, b = t.rng.uniform(0.0, 1.0, (3, 3)), t.rng.uniform(0.0, 1.0, 3)
    a = np.array([[0.0, 0.75, 0.5], [0.0, 0.0, 0.5], [0.0, 0.0, 0.2]])
    expected = [b, 0.75 * c[0] + 0.25 * b, 0.2 * c[2] + 0.4 * c[0] + 0.2 * c[1] + 0.2 * b]
    t.close("shown", blended(t, a, c, np.array([2.0, 2.0, 1.0]), b), expected, reveal=True)
    solid = np.array([[0.999], [0.5]])
    got = blended(t, solid, np.ones((2, 3)), np.array([1.0, 2.0]), np.ones(3))
    t.close("white before white", got, np.ones((1, 3)), reveal=True)
    nothing = blended(t, np.zeros((0, 2)), np.zeros((0, 3)), np.zeros(0), b)
    t.close("no splat at all", nothing, np.stack([b, b]), reveal=True)
    z, behind = np.arange(60) % 3 + 1.0, b
    a, c = t.rng.uniform(0.05, 0.15, (60, 1)), t.rng.uniform(0.0, 1.0, (60, 3))
    for k in (*range(59, 0, -3), *range(58, 0, -3), *range(57, -1, -3)):
        behind = a[k] * c[k] + (1 - a[k]) * behind
    t.close("60 rows at three depths", blended(t, a, c, z, b), behind[None], reveal=True)


@check(
    "15.4.order",
    points=3,
    adjoints=("composite_splats",),
    hint="sort by depth inside; back must undo the sorting",
    sole="needs no formula: the list's order means nothing",
)
def the_order_of_the_list_does_not_matter(t):
    """Splats in another order give the same pixels, and derivatives in that other order."""
    a, c, z, b = layers(t.rng, 7, 5)
    g, other = random_cotangent(t.rng, (5, 3)), t.rng.permutation(7)
    t.close("shown", blended(t, a[other], c[other], z[other], b), blended(t, a, c, z, b))
    d_a, d_c, d_b = blended_back(t, a, c, z, b, g)
    moved = blended_back(t, a[other], c[other], z[other], b, g)
    t.close("d_alpha", moved[0], d_a[other])
    t.close("d_colors", moved[1], d_c[other])
    t.close("d_background", moved[2], d_b)


@check(
    "15.4.differences",
    points=4,
    adjoints=("composite_splats",),
    tolerance=GATE,
    hint="handout, section 4: composite_adjoint gives d_sigma; from it d_alpha; colors are shared; "
    "a splat with alpha = 0 in a pixel has a derivative as well",
    sole="the derivative itself, without the reference",
)
def blending_agrees_with_differences(t):
    """Moving an alpha, a color or the background moves the pixels as your back says."""
    a, c, z, b = layers(t.rng, 6, 4)
    a[t.rng.integers(6), :2] = 0.999
    g = random_cotangent(t.rng, (4, 3))
    d_a, d_c, d_b = blended_back(t, a, c, z, b, g)

    def forward(point):
        return blended(t, point["alpha"], point["colors"], z, point["background"])

    found = {"background": d_b, "colors": d_c, "alpha": d_a}
    agrees_with_finite_differences(
        t, found, forward, {"alpha": a, "colors": c, "background": b}, g, GATE
    )
    none = blended_back(t, np.zeros((0, 4)), np.zeros((0, 3)), np.zeros(0), b, g)
    t.close("d_background, of no splat at all", none[2], g.sum(axis=0))
    names = ("alpha", "colors", "background")
    require_zero_for_zero(t, dict(zip(names, blended_back(t, a, c, z, b, 0 * g), strict=True)))
