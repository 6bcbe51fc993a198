"""Task 04.6, public checks."""

import numpy as np
from photograd_course.grading import Array, CheckFailed, Items, Tolerance, checks_for
from photograd_course.grading.adjoint_gate import (
    agrees_with_finite_differences,
    random_cotangent,
    require_zero_for_zero,
)
from photograd_course.grading.generators import upper_directions

from .common import EXACT, buried, material, shaded, viewer

check = checks_for(calls=("gltf_backward",), needs=("ggx_lobe", "gltf"), tolerance=EXACT)

SMOOTH = Tolerance(
    1e-6, "central differences leave 4e-9, the nearest wrong one (back_color_no_ramp) 0.0014"
)
PARAMETERS = ("base_color", "metalness", "roughness")
ADVICE = {
    "base_color": "equation (21): each channel alone; the factor of the base layer is that of "
    "(19), with 1 - F(0.04), that of the metal the derivative of (17) with respect to f0",
    "metalness": "equation (22): the derivative of (20) with respect to m, summed over channels",
    "roughness": "equations (23) to (25): summed over channels; D, S and alpha all depend on it",
}
NAMES = tuple(f"d_{name}" for name in PARAMETERS)


def slopes(t, wo, wi, color, m, r, g):
    """`gltf_backward` of the submission, by name."""
    n = len(wo)
    parts = Items(Array((n, 3)), Array((n,)), Array((n,)), names=NAMES)
    got = t.call("gltf_backward", wo, wi, color, m, r, g, returns=parts)
    return dict(zip(PARAMETERS, got, strict=True))


def near_mirrors(rng, n):
    """Pairs near the mirror direction, where the lobe is, and pairs anywhere."""
    wo = upper_directions(rng, n, 0.3)
    wi = wo * [-1, -1, 1] + rng.normal(size=(n, 3)) * 0.15
    wi[: n // 3] = upper_directions(rng, n // 3, 0.3)
    wi[:, 2] = np.abs(wi[:, 2])
    return wo, wi / np.linalg.norm(wi, axis=1, keepdims=True)


@check(
    "04.6.differences",
    points=5,
    tolerance=SMOOTH,
    hint="handout, section 6, equations (21) to (25)",
    sole="the derivative itself, without the reference",
)
def agrees_with_differences(t):
    """A small change of one parameter changes your f as your derivatives say."""
    wo, wi = near_mirrors(t.rng, 6)
    color, m, r = material(t.rng, 6)
    g = random_cotangent(t.rng, (6, 3))
    got = slopes(t, wo, wi, color, m, r, g)

    def forward(p):
        return shaded(t, wo, wi, *(p[name] for name in PARAMETERS))

    here = dict(zip(PARAMETERS, (color, m, r), strict=True))
    for name in PARAMETERS:
        try:
            agrees_with_finite_differences(t, {name: got[name]}, forward, here, g, SMOOTH)
        except CheckFailed as failure:
            failure.details["advice"] = ADVICE[name]
            raise


@check(
    "04.6.straight",
    points=2,
    hint="roughness^-4 has the derivative -4 roughness^-5; contributions of channels are summed",
    sole="the roughness alone, where it can be worked out by hand",
)
def the_peak_sinks(t):
    """Straight back the lobe is 1 / (4 pi roughness^4), and so is its derivative known."""
    up = viewer(1.0, 5)
    color, _, r = material(t.rng, 5)
    g = random_cotangent(t.rng, (5, 3))
    for m, F in ((np.zeros(5), np.full((5, 3), 0.04)), (np.ones(5), color)):
        got = slopes(t, up, up, color, m, r, g)
        right = -np.sum(g * F, axis=1) / (np.pi * r**5)
        t.close("d_roughness straight back", got["roughness"], right, reveal=True)


@check(
    "04.6.linear",
    points=3,
    hint="f is a constant plus something times the base color; and linear in the metalness",
    sole="all digits, where differences have nine",
)
def color_and_metalness_are_linear(t):
    """f is linear in color and in metalness: any step, not only a small one, fits."""
    wo, wi = near_mirrors(t.rng, 20)
    color, m, r = material(t.rng, 20)
    g = random_cotangent(t.rng, (20, 3))
    got = slopes(t, wo, wi, color, m, r, g)
    here, step = shaded(t, wo, wi, color, m, r), t.rng.uniform(-0.5, 0.5, (20, 3))
    there = shaded(t, wo, wi, color + step, m, r)
    right = (there - here) * g
    t.close("<step, d_base_color>", got["base_color"] * step, right, hint=ADVICE["base_color"])
    step = t.rng.uniform(0.2, 0.5, 20)
    there = shaded(t, wo, wi, color, m + step, r)
    mine, right = got["metalness"] * step, np.sum((there - here) * g, axis=1)
    t.close("step times d_metalness", mine, right, hint=ADVICE["metalness"])


@check(
    "04.6.zero",
    points=2,
    hint="below the surface f is 0 whatever the parameters; rows do not know of each other",
    sole="what must not leak: below the surface, and from row to row",
)
def nothing_leaks(t):
    """No derivative below the surface or of no loss; each row minds its own."""
    wo, wi = buried(t.rng, 12)
    given = material(t.rng, 12)
    g = random_cotangent(t.rng, (12, 3))
    for name, values in slopes(t, wo, wi, *given, g).items():
        t.require(not values.any(), f"d_{name} must be exactly 0 below the surface")
    wo, wi = near_mirrors(t.rng, 12)
    require_zero_for_zero(t, slopes(t, wo, wi, *given, 0 * g))
    order = t.rng.permutation(12)
    whole = slopes(t, wo, wi, *given, g)
    moved = slopes(t, wo[order], wi[order], *(each[order] for each in given), g[order])
    for name, values in whole.items():
        t.close(f"d_{name} in another order", moved[name], values[order])
