"""Task 15.3, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, checks_for
from photograd_course.grading.adjoint_gate import (
    agrees_with_finite_differences,
    random_cotangent,
    require_zero_for_zero,
)

from .common import EXACT, GATE

check = checks_for(calls=("screen_alpha",), tolerance=EXACT)


def taken(t, m, s, o, pixels):
    """The values of `screen_alpha`."""
    shape = (len(m), len(pixels))
    return t.call("adapters.screen_alpha", m, s, o, pixels, returns=Array(shape))


def taken_back(t, m, s, o, pixels, g):
    """Result of the `back` of `screen_alpha`."""
    parts = Items(
        Array(m.shape),
        Array(s.shape),
        Array(o.shape),
        Array(m.shape),
        names=("d_mean2d", "d_cov2d", "d_opacity_logits", "absgrad"),
    )
    return t.call("adapters.screen_alpha_back", m, s, o, pixels, g, returns=parts)


def wide_splats(rng, n, p):
    """Splats that all pixels see, neither clamped nor dropped; (mean2d, cov2d, logits, pixels)."""
    s = rng.uniform(8.0, 14.0, (n, 3))
    s[:, 1] = rng.uniform(-4.0, 4.0, n)
    return rng.uniform(0.0, 4.0, (n, 2)), s, rng.uniform(0.0, 2.0, n), rng.uniform(0.0, 4.0, (p, 2))


@check(
    "15.3.round",
    points=2,
    hint="handout, equations (14) to (16), for a round splat",
    sole="small enough to work out by hand",
)
def a_round_splat(t):
    """In its middle alpha is the opacity, at a known distance half of it, and LOW_PASS counts."""
    logits = t.rng.uniform(-1.0, 1.0, 3)
    m, wide = t.rng.uniform(0.0, 9.0, (3, 2)), t.rng.uniform(0.0, 4.0, 3)
    s = np.stack([wide, 0 * wide, wide], axis=1)
    phi, o = t.rng.uniform(0.0, 6.0, 3), 1 / (1 + np.exp(-logits))
    far = np.sqrt(2 * np.log(2) * (wide + 0.3))
    there = m + far[:, None] * np.stack([np.cos(phi), np.sin(phi)], axis=1)
    t.close("alpha in the middle", np.diag(taken(t, m, s, logits, m)), o, reveal=True)
    t.close("alpha at half", np.diag(taken(t, m, s, logits, there)), o / 2, reveal=True)


@check(
    "15.3.ellipse",
    points=2,
    hint="handout, equations (14) and (15): the inverse swaps xx and yy; the term of Q_xy "
    "stands outside of the 1/2; or the two offsets have different signs",
    sole="says whether the conic belongs to the covariance",
)
def on_an_ellipse_alpha_is_the_same(t):
    """On the ellipse of k standard deviations, alpha is the opacity times exp(-k^2 / 2)."""
    m, s, logits, _ = wide_splats(t.rng, 1, 1)
    full = s[0, [0, 1, 1, 2]].reshape(2, 2) + 0.3 * np.eye(2)
    phi, k = np.linspace(0.1, 6.0, 9), t.rng.uniform(0.5, 2.5)
    ring = m + k * np.stack([np.cos(phi), np.sin(phi)], axis=1) @ np.linalg.cholesky(full).T
    expected = np.exp(-(k**2) / 2) / (1 + np.exp(-logits[0]))
    t.close("alpha", taken(t, m, s, logits, ring), np.full((1, 9), expected), reveal=True)


@check(
    "15.3.cuts",
    points=2,
    adjoints=("screen_alpha",),
    hint="handout, equation (16): below ALPHA_MIN nothing, never above ALPHA_MAX; both are flat",
    sole="names the cut-off, and whether its derivative is 0",
)
def cut_offs(t):
    """What is below 1 / 255 is exactly 0, what is above 0.999 is clamped, and neither moves."""
    m, s = t.rng.uniform(0.0, 9.0, (1, 2)), np.array([[4.0, 0.0, 4.0]])
    for logit, alpha, expected in (
        (0.0, 0.0037, 0.0),
        (0.0, 0.0042, 0.0042),
        (9.0, 0.9993, 0.999),
        (9.0, 0.9985, 0.9985),
    ):
        o = 1 / (1 + np.exp(-logit))
        pixel = m + np.array([np.sqrt(2 * 4.3 * np.log(o / alpha)), 0.0])
        got = taken(t, m, s, np.array([logit]), pixel)
        t.close(f"alpha where o exp(-rho) = {alpha}", got, [[expected]], reveal=True)
        d_m, d_s, d_o, absgrad = taken_back(t, m, s, np.array([logit]), pixel, np.ones((1, 1)))
        for name, d in (
            ("mean2d", d_m),
            ("cov2d", d_s),
            ("opacity_logits", d_o),
            ("absgrad", absgrad),
        ):
            moves = bool(d.any())
            t.require(
                moves == (alpha == expected),
                f"d_{name} where o exp(-rho) = {alpha}: must {'not ' * (alpha == expected)}be 0",
            )


@check(
    "15.3.differences",
    points=4,
    adjoints=("screen_alpha",),
    tolerance=GATE,
    hint="handout, section 3: derivatives of Q or of the covariance, each with its own count of "
    "xy; the opacity is a function of the logit",
    sole="the derivative itself, without the reference",
)
def alpha_agrees_with_differences(t):
    """Moving a splat, its covariance or its logit moves alpha as your back says."""
    m, s, o, pixels = wide_splats(t.rng, 4, 6)
    m[1] += 90.0  # not seen at all
    o[2], pixels[0] = 9.0, m[2] + 0.02  # clamped in one pixel
    g = random_cotangent(t.rng, (4, 6))
    d_m, d_s, d_o, _ = taken_back(t, m, s, o, pixels, g)

    def forward(point):
        return taken(t, point["mean2d"], point["cov2d"], point["opacity_logits"], pixels)

    found = {"opacity_logits": d_o, "mean2d": d_m, "cov2d": d_s}
    agrees_with_finite_differences(
        t, found, forward, {"mean2d": m, "cov2d": s, "opacity_logits": o}, g, GATE
    )
    names = ("mean2d", "cov2d", "opacity_logits", "absgrad")
    require_zero_for_zero(t, dict(zip(names, taken_back(t, m, s, o, pixels, 0 * g), strict=True)))


@check(
    "15.3.absgrad",
    points=2,
    adjoints=("screen_alpha",),
    hint="handout, equation (17): absolute values first, then the sum over pixels",
    sole="tests absgrad only",
)
def absgrad_does_not_cancel(t):
    """absgrad is the sum over pixels of the size of what each alone adds to d_mean2d."""
    m, s, o, pixels = wide_splats(t.rng, 3, 5)
    g = random_cotangent(t.rng, (3, 5))
    d_m, _, _, absgrad = taken_back(t, m, s, o, pixels, g)
    alone = [taken_back(t, m, s, o, pixels[k : k + 1], g[:, k : k + 1])[0] for k in range(5)]
    t.close("the sum of single pixels", np.sum(alone, axis=0), d_m)
    t.close("absgrad", absgrad, np.sum(np.abs(alone), axis=0))
