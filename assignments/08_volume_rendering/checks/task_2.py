"""Task 08.2, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, Tolerance, checks_for
from photograd_course.grading.adjoint_gate import (
    agrees_with_finite_differences,
    is_the_transpose,
    require_zero_for_zero,
)

from .common import EXACT, GATE, random_rays, seen

check = checks_for(calls=("composite_adjoint",), needs=("composite",), tolerance=GATE)


def slopes_of(shape, channels):
    """Result of `composite_adjoint` for sigma of this shape."""
    parts = (Array(shape), Array((*shape, channels)), Array((channels,)))
    return Items(*parts, names=("d_sigma", "d_color", "d_background"))


def against_differences(t, sigma, color, dt, background, groups=("sigma", "color", "background")):
    """`composite_adjoint` against finite differences of your own `composite`, each group alone."""
    rays, channels = len(sigma), color.shape[2]
    point = {"sigma": sigma, "color": color, "background": background}
    d_pixel, d_T_end = t.rng.uniform(-1, 1, (rays, channels)), t.rng.uniform(-1, 1, rays)
    got = t.call(
        "composite_adjoint",
        sigma,
        color,
        dt,
        background,
        d_pixel,
        d_T_end,
        returns=slopes_of(sigma.shape, channels),
    )
    got = dict(zip(("sigma", "color", "background"), got, strict=True))

    def forward(p):
        pixel, T_end = t.call(
            "composite", p["sigma"], p["color"], dt, p["background"], returns=seen(rays, channels)
        )
        return np.concatenate([pixel.ravel(), T_end])

    d_output = np.concatenate([d_pixel.ravel(), d_T_end])
    agrees_with_finite_differences(t, {k: got[k] for k in groups}, forward, point, d_output, GATE)


@check(
    "08.2.differences",
    points=6,
    hint="handout, section 2: first d_color and d_background, then the two parts of d_sigma; "
    "order of results: d_sigma, d_color, d_background",
    sole="the gradient itself, without the reference",
)
def agrees_with_differences(t):
    """A small change of one number changes your pixels and T_end as your adjoint says."""
    against_differences(t, *random_rays(t))


@check(
    "08.2.background",
    points=2,
    hint="the background is the last that a step hides; T_end belongs to the pixel's total",
    sole="nearly empty rays: what is behind everything decides",
)
def nearly_empty_rays(t):
    """In a thin medium nearly all of the pixel is background, and adding extinction hides it."""
    sigma, color, dt, background = random_rays(t)
    against_differences(t, 0.01 * sigma, color, dt, 2 * background, ("sigma", "background"))
    d_pixel, d_T_end = t.rng.uniform(0.5, 1, (2, 2)), t.rng.uniform(-3, -2, 2)
    # Everything is white: whatever the extinction, the pixel stays.
    white = [np.ones((2, 5, 2)), np.full((2, 5), 0.2), np.ones(2)]
    d_sigma, _, _ = t.call(
        "composite_adjoint",
        t.rng.uniform(0.1, 1, (2, 5)),
        *white,
        d_pixel,
        np.zeros(2),
        returns=slopes_of((2, 5), 2),
    )
    size = float(np.linalg.norm(d_pixel))
    t.close(
        "d_sigma where all is white",
        d_sigma,
        np.zeros((2, 5)),
        Tolerance(1e-12, EXACT.evidence, floor=size),
    )
    sigma = t.rng.uniform(0.1, 1, (2, 5))
    d_sigma, _, _ = t.call(
        "composite_adjoint", sigma, *white, 0 * d_pixel, d_T_end, returns=slopes_of((2, 5), 2)
    )
    through = np.exp(-0.2 * sigma.sum(axis=1))
    t.close(
        "d_sigma of T_end alone",
        d_sigma,
        np.tile((-0.2 * d_T_end * through)[:, None], 5),
        EXACT,
        reveal=True,
    )


@check(
    "08.2.linear",
    points=3,
    tolerance=EXACT,
    hint="the pixel is linear in colors and background: their derivatives are its weights",
    sole="the definition of an adjoint, to the last digits",
)
def is_the_transpose_in_the_colors(t):
    """<pixel, g> = <color, d_color> + <background, d_background>, summed over rays."""
    sigma, color, dt, background = random_rays(t)
    g, none = t.rng.uniform(-1, 1, (3, 3)), np.zeros(3)
    back = t.call(
        "composite_adjoint", sigma, color, dt, background, g, none, returns=slopes_of((3, 6), 3)
    )
    for _ in range(3):
        colors, behind = t.rng.uniform(-1, 1, (3, 6, 3)), t.rng.uniform(-1, 1, 3)
        pixel, _ = t.call("composite", sigma, colors, dt, behind, returns=seen(3, 3))
        is_the_transpose(
            t,
            "<color, d_color> + <background, d_background>",
            (colors, behind),
            pixel,
            g,
            (back[1], back[2]),
        )
    total = np.zeros(3)
    for r in range(3):
        one = slice(r, r + 1)
        alone = t.call(
            "composite_adjoint",
            sigma[one],
            color[one],
            dt[one],
            background,
            g[one],
            none[one],
            returns=slopes_of((1, 6), 3),
        )
        t.close("d_sigma of a ray alone", alone[0], back[0][one])
        total += alone[2]
    t.close("d_background of all rays", back[2], total)
    zero = t.call(
        "composite_adjoint", sigma, color, dt, background, 0 * g, none, returns=slopes_of((3, 6), 3)
    )
    require_zero_for_zero(t, dict(zip(("sigma", "color", "background"), zero, strict=True)))


@check(
    "08.2.units",
    points=2,
    tolerance=EXACT,
    hint="sigma enters as sigma * dt only: what does the chain rule add in the backward pass?",
    sole="asks for the step length alone, which neither sign nor direction shows",
)
def centimeters_instead_of_meters(t):
    """In centimeters dt is 100 times as large, sigma a 100th, and d_sigma 100 times as large."""
    sigma, color, dt, background = random_rays(t)
    g, h = t.rng.uniform(-1, 1, (3, 3)), t.rng.uniform(-1, 1, 3)
    meters = t.call(
        "composite_adjoint", sigma, color, dt, background, g, h, returns=slopes_of((3, 6), 3)
    )
    centimeters = t.call(
        "composite_adjoint",
        sigma / 100,
        color,
        100 * dt,
        background,
        g,
        h,
        returns=slopes_of((3, 6), 3),
    )
    t.close("d_sigma by centimeters", centimeters[0], 100 * meters[0])
    t.close("d_color by centimeters", centimeters[1], meters[1])


@check(
    "08.2.walls",
    points=2,
    hint="behind a wall T is 0, which cannot be divided by, and in a thin medium 1 - exp(-x) loses "
    "digits",
    sole="finite numbers where a formula divides 0 by 0",
)
def walls_and_thin_air(t):
    """Steps of optical depth 50 and 2000, and of 1e-8: finite, and as finite differences say."""
    sigma, color, dt, background = random_rays(t, rays=2)
    sigma[0, 3] = 50.0 / dt[0, 3]
    sigma[1, 3] = 2000.0 / dt[1, 3]
    against_differences(t, sigma, color, dt, background, ("sigma", "color"))
    thin = t.rng.uniform(1.0, 2.0, (2, 4)) * 1e-8
    against_differences(t, thin, color[:, :4], np.ones((2, 4)), background, ("sigma",))
    faint, g = color[:, :4], t.rng.uniform(0.5, 1.0, (2, 3))
    given = (thin, faint, np.ones((2, 4)), np.zeros(3))
    _, d_color, _ = t.call(
        "composite_adjoint", *given, g, np.zeros(2), returns=slopes_of((2, 4), 3)
    )
    pixel, _ = t.call("composite", *given, returns=seen(2, 3))
    t.close("<color, d_color> in a thin medium", np.vdot(faint, d_color), np.vdot(pixel, g), EXACT)
