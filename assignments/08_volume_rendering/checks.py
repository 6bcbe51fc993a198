"""Checks of assignment 08."""

from __future__ import annotations

import math

import numpy as np
from photograd_course.grading import Array, Items, Subject, Tolerance, check
from photograd_course.grading.adjoint_gate import (
    require_cheap,
    require_gradients,
    require_zero_for_zero,
)

# Evidence: worst of the solution and four alternatives over several seeds, against the nearest of
# all named wrong solutions.
EXACT = Tolerance(
    1e-12, "right ones differ by at most 8e-15, the nearest wrong one (product_of_rests) by 8e-11"
)
SUMS = Tolerance(
    1e-10, "right ones differ by at most 8e-15, the nearest wrong one (T_end_forgotten) by 3e-5"
)
# The same for what must be 0, in units of the box.
BOXES = Tolerance(EXACT.relative, EXACT.evidence, floor=1.0)
GATE = Tolerance(
    1e-6, "differences leave 1e-10, the nearest wrong one (adjoint_inclusive) 1.7e-4 in thin air"
)
ORDER = Tolerance(
    0.02, "right ones have order 2 to 8e-4, the nearest wrong one (riemann) is off by 0.5"
)
# A forward pass in whole arrays and an adjoint that walks the steps in a loop, as the handout has
# it, stand 5 to 8 to one, what goes through the pipe included; one that walks all later steps for
# each step, 100 to one or more.
RAY_COST = 30.0
DIGITS = "for tiny x, 1 - exp(-x) keeps only the digits of x that 1 + x has: see np.expm1"


def seen(rays, channels):
    """What `composite` returns."""
    return Items(Array((rays, channels)), Array((rays,)), names=("pixel", "T_end"))


def slopes_of(shape, channels):
    """What `composite_adjoint` returns for sigma of this shape."""
    parts = (Array(shape), Array((*shape, channels)), Array((channels,)))
    return Items(*parts, names=("d_sigma", "d_color", "d_background"))


def random_rays(t, rays=3, steps=6, channels=3, thick=1.5):
    """Rays whose steps all differ, not one of them opaque: sigma, color, dt, background."""
    sigma = t.rng.uniform(0.1, thick, (rays, steps)) * 4.0
    color = t.rng.uniform(0.0, 1.0, (rays, steps, channels))
    dt = t.rng.uniform(0.1, 0.3, (rays, steps))
    return sigma, color, dt, t.rng.uniform(0.2, 1.0, channels)


# 08.1 ---------------------------------------------------------------------------------------------


@check(
    "08.1.constant",
    task="08.1",
    points=3,
    calls=("composite",),
    tolerance=EXACT,
    hint="handout, equation (4): the opacity of a step of constant extinction is exact",
    sole="the closed form of one medium, at any number of steps",
)
def one_medium_in_closed_form(t):
    """One medium of length L: c (1 - exp(-sigma L)) + exp(-sigma L) b, at any number of steps."""
    sigma, length = t.rng.uniform(0.5, 2.0), t.rng.uniform(0.5, 1.5)
    color, background = t.rng.uniform(0.0, 1.0, (2, 3))
    through = math.exp(-sigma * length)
    for n in (7, 1, 2, 100):  # 1 or 2 steps first would hide which T the end takes
        pixel, T_end = t.call(
            "composite",
            np.full((1, n), sigma),
            np.tile(color, (1, n, 1)),
            np.full((1, n), length / n),
            background,
            returns=seen(1, 3),
        )
        t.close(
            f"pixel, {n} steps", pixel[0], color * (1 - through) + through * background, reveal=True
        )
        t.close(f"T_end, {n} steps", T_end[0], through, reveal=True)


@check(
    "08.1.slabs",
    task="08.1",
    points=3,
    calls=("composite",),
    tolerance=EXACT,
    hint="handout, equations (5) to (7): what lies before a step dims it, itself excluded",
    sole="says who stands before whom",
)
def two_slabs_in_closed_form(t):
    """Two media, one behind the other: the nearer hides the farther, never the reverse."""
    sigma, length = t.rng.uniform(0.5, 2.0, (2, 2)), t.rng.uniform(0.5, 1.5, (2, 2))
    color, background = t.rng.uniform(0.0, 1.0, (2, 2, 3)), t.rng.uniform(0.0, 1.0, 3)
    half = 3
    pixel, T_end = t.call(
        "composite",
        np.repeat(sigma, half, axis=1),
        np.repeat(color, half, axis=1),
        np.repeat(length, half, axis=1) / half,
        background,
        returns=seen(2, 3),
    )
    one, two = np.exp(-sigma * length).T[:, :, None]
    right = (1 - one) * color[:, 0] + one * ((1 - two) * color[:, 1] + two * background)
    t.close("pixel", pixel, right, reveal=True)
    t.close("T_end", T_end, (one * two)[:, 0], reveal=True)


@check(
    "08.1.weights",
    task="08.1",
    points=3,
    calls=("composite",),
    tolerance=EXACT,
    hint="handout, equation (9): every bit of light is accounted for",
    sole="no closed form of the color is needed for this one",
)
def nothing_is_lost(t):
    """In white media before white the pixel is white; before black, it is 1 - T_end."""
    for scale in (1e-3, 1.0, 1e2, 1e4):
        sigma = scale * t.rng.uniform(0.0, 1.0, (4, 9))
        dt, white = t.rng.uniform(0.1, 0.5, (4, 9)), np.ones((4, 9, 1))
        pixel, _ = t.call("composite", sigma, white, dt, np.ones(1), returns=seen(4, 1))
        t.close(f"white before white, sigma about {scale:g}", pixel[:, 0], np.ones(4), reveal=True)
        pixel, T_end = t.call("composite", sigma, white, dt, np.zeros(1), returns=seen(4, 1))
        t.close("weights and T_end", pixel[:, 0] + T_end, np.ones(4), reveal=True)


@check(
    "08.1.split",
    task="08.1",
    points=2,
    calls=("composite",),
    tolerance=EXACT,
    hint="a step that is cut in two has the same optical depth in all",
    sole="needs no right answer: only that the cutting does not matter",
)
def cutting_a_step_changes_nothing(t):
    """A step cut in two, a step of length 0, a step of extinction 0: the pixel stays."""
    sigma, color, dt, background = random_rays(t)
    whole = t.call("composite", sigma, color, dt, background, returns=seen(3, 3))
    for k in (0, 3, 5):
        share = t.rng.uniform(0.2, 0.8)
        parts = np.repeat(dt, [2 if j == k else 1 for j in range(6)], axis=1)
        parts[:, k] *= share
        parts[:, k + 1] *= 1 - share
        order = np.insert(np.arange(6), k, k)
        cut = t.call(
            "composite", sigma[:, order], color[:, order], parts, background, returns=seen(3, 3)
        )
        t.close(f"pixel, step {k} cut in two", cut[0], whole[0])
        t.close("T_end", cut[1], whole[1])
    for values in (sigma, dt):
        gap = [np.insert(v, 2, 0.0 if v is values else 0.7, axis=1) for v in (sigma, dt)]
        empty = t.call(
            "composite",
            gap[0],
            np.insert(color, 2, 5.0, axis=1),
            gap[1],
            background,
            returns=seen(3, 3),
        )
        t.close("pixel with an empty step", empty[0], whole[0])


@check(
    "08.1.extremes",
    task="08.1",
    points=2,
    calls=("composite",),
    tolerance=EXACT,
    hint="mend the checks above first; if they pass: handout, end of section 1",
    sole="all digits, from thin air to a wall",
)
def thin_air_and_walls(t):
    """Air so thin that it can hardly be seen, and a wall that hides what is behind it."""
    color = t.rng.uniform(0.2, 1.0, (1, 4, 2))
    dt = t.rng.uniform(0.5, 1.0, (1, 4))
    thin = t.rng.uniform(1.0, 3.0, (1, 4)) * 1e-8
    pixel, _ = t.call("composite", thin, color, dt, np.zeros(2), returns=seen(1, 2))
    # To first order s, to second what stands before and half of itself; the third is below 1e-23.
    s = thin * dt
    before = np.cumsum(s) - s
    second = s * (before + s / 2)
    # Of 1 - exp(-s) only digits are lost that 1 + s cannot hold: is that what came?
    rounded = np.einsum("rs,rsc->rc", (1 - np.exp(-s)) * (1 - before), color)
    lost = np.allclose(pixel, rounded, rtol=1e-13, atol=0.0)
    t.close(
        "pixel of thin air",
        pixel,
        np.einsum("rs,rsc->rc", s - second, color),
        reveal=True,
        hint=DIGITS if lost else "",
    )
    wall = np.array([[0.3, 2000.0, 0.5, 1.0]])
    pixel, _ = t.call("composite", wall, color, dt, np.full(2, 9.0), returns=seen(1, 2))
    nearer = math.exp(-0.3 * dt[0, 0])
    t.close(
        "pixel of a wall", pixel[0], (1 - nearer) * color[0, 0] + nearer * color[0, 1], reveal=True
    )


@check(
    "08.1.order",
    task="08.1",
    points=2,
    calls=("composite",),
    tolerance=ORDER,
    hint="an error that only halves, or stays, when steps are halved betrays a wrong weight",
    sole="what a wrong weight does to a medium that is not constant",
)
def halving_the_steps_quarters_the_error(t):
    """A Gaussian blob whose color changes with depth: the error falls with the square of dt."""
    middle, width = t.rng.uniform(0.3, 0.5), t.rng.uniform(0.25, 0.35)
    peak = t.rng.uniform(2.0, 3.0)

    def tau(x):
        erf = np.array([math.erf((each - middle) / width) for each in np.atleast_1d(x)])
        return peak * width * math.sqrt(math.pi) / 2 * (erf + math.erf(middle / width))

    end = float(tau(1.0)[0])
    # Colors 1 and exp(-tau), for which the integral is known.
    right = np.array([1 - math.exp(-end), (1 - math.exp(-2 * end)) / 2])
    errors = []
    for n in (32, 64, 128):
        x = (np.arange(n) + 0.5) / n
        sigma = peak * np.exp(-(((x - middle) / width) ** 2))
        color = np.stack([np.ones(n), np.exp(-tau(x))], axis=1)
        pixel, _ = t.call(
            "composite",
            sigma[None],
            color[None],
            np.full((1, n), 1 / n),
            np.zeros(2),
            returns=seen(1, 2),
        )
        errors.append(np.abs(pixel[0] - right))
    orders = np.log2(np.array(errors[:-1]) / np.maximum(errors[1:], 1e-300))
    t.close("order of convergence", orders, np.full((2, 2), 2.0), reveal=True)


# 08.2 ---------------------------------------------------------------------------------------------


def against_differences(t, sigma, color, dt, background, groups=("sigma", "color", "background")):
    """`composite_adjoint` against differences of your own `composite`, each group alone."""
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
    require_gradients(t, {k: got[k] for k in groups}, forward, point, d_output, GATE)


@check(
    "08.2.differences",
    task="08.2",
    points=6,
    calls=("composite_adjoint",),
    needs=("composite",),
    tolerance=GATE,
    hint="handout, section 2: first d_color and d_background, then the two parts of d_sigma; "
    "order of results: d_sigma, d_color, d_background",
    sole="the gradient itself, without the reference",
)
def agrees_with_differences(t):
    """Moving one number a little moves your pixels and T_end as your adjoint says."""
    against_differences(t, *random_rays(t))


@check(
    "08.2.background",
    task="08.2",
    points=2,
    calls=("composite_adjoint",),
    needs=("composite",),
    tolerance=GATE,
    hint="the background is the last that a step hides; T_end belongs to the pixel's total",
    sole="nearly empty rays: what is behind everything decides",
)
def nearly_empty_rays(t):
    """In thin air nearly all of the pixel is background, and adding extinction hides it."""
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
    task="08.2",
    points=3,
    calls=("composite_adjoint",),
    needs=("composite",),
    tolerance=EXACT,
    hint="the pixel is linear in colors and background: their derivatives are its weights",
    sole="the definition of an adjoint, to the last digits",
)
def is_the_transpose_in_the_colors(t):
    """<pixel, g> = <color, d_color> + <background, d_background>, and rays add up."""
    sigma, color, dt, background = random_rays(t)
    g, none = t.rng.uniform(-1, 1, (3, 3)), np.zeros(3)
    back = t.call(
        "composite_adjoint", sigma, color, dt, background, g, none, returns=slopes_of((3, 6), 3)
    )
    for _ in range(3):
        colors, behind = t.rng.uniform(-1, 1, (3, 6, 3)), t.rng.uniform(-1, 1, 3)
        pixel, _ = t.call("composite", sigma, colors, dt, behind, returns=seen(3, 3))
        size = float(np.linalg.norm(pixel) * np.linalg.norm(g))
        t.close(
            "<color, d_color> + <background, d_background>",
            np.vdot(colors, back[1]) + np.vdot(behind, back[2]),
            np.vdot(pixel, g),
            Tolerance(EXACT.relative, EXACT.evidence, floor=size),
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
    task="08.2",
    points=2,
    calls=("composite_adjoint",),
    needs=("composite",),
    tolerance=EXACT,
    hint="sigma enters as sigma * dt only: what does the chain rule add on the way back?",
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
    task="08.2",
    points=2,
    calls=("composite_adjoint",),
    needs=("composite",),
    tolerance=GATE,
    hint="mend 08.2.differences first; if it passes: behind a wall T is 0, which cannot be "
    "divided by, and in thin air 1 - exp(-x) loses digits",
    sole="finite numbers where a formula divides 0 by 0",
)
def walls_and_thin_air(t):
    """Steps of optical depth 50 and 2000, and of 1e-8: finite, and as differences say."""
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
    t.close("<color, d_color> in thin air", np.vdot(faint, d_color), np.vdot(pixel, g), EXACT)


# 08.3 ---------------------------------------------------------------------------------------------


def spans(rays):
    """What `ray_box` returns."""
    return Items(Array((rays,)), Array((rays,)), names=("t_near", "t_far"))


def random_box(t):
    """Two opposite corners of a box that is no cube and not at the origin."""
    low = t.rng.uniform(-2.0, -0.5, 3)
    return low, low + t.rng.uniform(0.5, 3.0, 3)


def on_face(points, low, high):
    """How far points are from the surface of the box, as a share of its size."""
    size = high - low
    outside = np.maximum(np.maximum(low - points, points - high) / size, 0.0).max(axis=1)
    nearest = np.minimum(np.abs(points - low), np.abs(points - high)) / size
    return np.maximum(outside, nearest.min(axis=1))


@check(
    "08.3.axes",
    task="08.3",
    points=2,
    calls=("ray_box",),
    tolerance=EXACT,
    hint="handout, equations (13) and (14): smaller and larger of two crossings, on each axis",
    sole="three rays that can be checked with a ruler",
)
def along_the_axes(t):
    """Rays along the axes, forwards and backwards, enter and leave where a ruler says."""
    low, high = random_box(t)
    middle, gap = (low + high) / 2, t.rng.uniform(0.5, 2.0, 3)
    for sign in (1.0, -1.0):
        start = (low - gap) if sign > 0 else (high + gap)
        origins = np.where(np.eye(3) > 0, start, middle)
        near, far = t.call("ray_box", low, high, origins, sign * np.eye(3), returns=spans(3))
        t.close("t_near", near, gap, reveal=True)
        t.close("t_far", far, gap + high - low, reveal=True)


@check(
    "08.3.faces",
    task="08.3",
    points=2,
    calls=("ray_box",),
    tolerance=EXACT,
    hint="enter at the last of three entries, leave at the first of three exits",
    sole="any direction, without knowing the answer",
)
def ends_lie_on_the_surface(t):
    """Rays towards a point inside enter and leave on the surface, whatever their length."""
    low, high = random_box(t)
    inside = t.rng.uniform(low, high, (40, 3))
    direction = t.rng.normal(size=(40, 3))
    origins = inside - 9.0 * direction / np.linalg.norm(direction, axis=1)[:, None]
    length = t.rng.uniform(0.2, 3.0, (40, 1))
    aim = (inside - origins) * length
    near, far = t.call("ray_box", low, high, origins, aim, returns=spans(40))
    t.require(bool((near < far).all()), "rays through the box must have t_near < t_far")
    for name, at in (("t_near", near), ("t_far", far)):
        t.close(
            f"distance from the surface at {name}, in sizes of the box",
            on_face(origins + at[:, None] * aim, low, high),
            np.zeros(40),
            BOXES,
            reveal=True,
        )
    t.require(
        bool((near * length[:, 0] < 1).all() and (far * length[:, 0] > 0).all()),
        "the point aimed at must lie between t_near and t_far",
    )


@check(
    "08.3.inside",
    task="08.3",
    points=2,
    calls=("ray_box",),
    tolerance=EXACT,
    hint="a ray begins at t = 0: what lies before that is behind the camera",
    sole="asks about what lies behind the eye",
)
def starts_inside_or_behind(t):
    """From inside, a ray starts at 0; with the box behind it or beside it, it gets (0, 0)."""
    low, high = random_box(t)
    inside = t.rng.uniform(low, high, (12, 3))
    direction = t.rng.normal(size=(12, 3))
    near, far = t.call("ray_box", low, high, inside, direction, returns=spans(12))
    t.require(not near.any(), "from inside, t_near must be 0")
    t.close(
        "distance from the surface at t_far, in sizes of the box",
        on_face(inside + far[:, None] * direction, low, high),
        np.zeros(12),
        BOXES,
        reveal=True,
    )
    away = inside + 9.0 * direction / np.linalg.norm(direction, axis=1)[:, None]
    beside = direction - (direction @ np.ones(3) / 3)[:, None]  # never nears the far corner
    origins = np.concatenate([away, np.tile(high + 0.1, (12, 1))])
    near, far = t.call(
        "ray_box", low, high, origins, np.concatenate([direction, beside]), returns=spans(24)
    )
    t.require(not near.any() and not far.any(), "a ray that misses the box must get (0, 0)")


@check(
    "08.3.parallel",
    task="08.3",
    points=2,
    calls=("ray_box",),
    tolerance=EXACT,
    hint="a component of 0 never crosses its two planes: either it is between them (faces "
    "belong to the box) or it misses",
    sole="the case in which 0 is divided by 0",
)
def parallel_to_faces(t):
    """Directions with components of 0: between the faces, outside them, and within a face."""
    low, high = random_box(t)
    middle, size = (low + high) / 2, high - low
    x = np.array([1.0, 0.0, -0.0])
    start = middle - np.array([1.0, 0.0, 0.0]) * size
    origins = np.tile(start, (5, 1))
    origins[1, 1] = high[1] + 0.1  # outside the slab
    origins[2, 2] = low[2] - 0.1
    origins[3, 1] = low[1]  # within a face
    origins[4, 2] = high[2]
    near, far = t.call("ray_box", low, high, origins, np.tile(x, (5, 1)), returns=spans(5))
    hits = np.array([1.0, 0.0, 0.0, 1.0, 1.0])
    t.close("t_near", near, hits * 0.5 * size[0], reveal=True)
    t.close("t_far", far, hits * 1.5 * size[0], reveal=True)


# 08.4 ---------------------------------------------------------------------------------------------


def centers(shape):
    """Middle of every voxel of a grid (X, Y, Z), last axis fastest: (X Y Z, 3)."""
    parts = np.meshgrid(*((np.arange(n) + 0.5) / n for n in shape), indexing="ij")
    return np.stack([part.ravel() for part in parts], axis=1)


def sampling_matrix(t, shape, u):
    """Samples of all grids that hold a single 1, by your own forward function: (N, X Y Z)."""
    voxels = int(np.prod(shape))
    unit = np.eye(voxels).reshape(*shape, voxels)
    return t.call("trilinear", unit, u, returns=Array((len(u), voxels)))


def between_centers(t, shape, n):
    """Random places (n, 3) that no border touches."""
    rim = 0.5 / np.array(shape)
    return t.rng.uniform(rim, 1 - rim, (n, 3))


@check(
    "08.4.centers",
    task="08.4",
    points=2,
    calls=("trilinear",),
    tolerance=EXACT,
    hint="handout, equation (16): which u belongs to the first voxel?",
    sole="says that coordinates and axes are right, whatever the weights",
)
def a_center_gives_its_voxel(t):
    """In the middle of a voxel the sample is that voxel."""
    grid = t.rng.uniform(-1.0, 1.0, (2, 5, 3, 2))
    got = t.call("trilinear", grid, centers((2, 5, 3)), returns=Array((30, 2)))
    t.close("samples", got, grid.reshape(30, 2), reveal=True)


@check(
    "08.4.products",
    task="08.4",
    points=2,
    calls=("trilinear",),
    tolerance=EXACT,
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
    grid = fields(centers(shape)).reshape(*shape, 7)
    got = t.call("trilinear", grid, u, returns=Array((50, 7)))
    t.close("samples", got, fields(u), reveal=True)


@check(
    "08.4.edge",
    task="08.4",
    points=2,
    calls=("trilinear",),
    tolerance=EXACT,
    hint="handout, equation (17): clamp the coordinate, then split it",
    sole="says that only the border is wrong",
)
def the_border_holds(t):
    """Beyond the outermost centers, and beyond the box, the value at the border holds."""
    shape = (3, 2, 4)
    grid = t.rng.uniform(-1.0, 1.0, (*shape, 2))
    corners = np.array(list(np.ndindex(2, 2, 2)), np.float64)
    got = t.call("trilinear", grid, corners, returns=Array((8, 2)))
    t.close("corners", got, grid[::2, :, ::3].reshape(8, 2), reveal=True)
    u, rim = t.rng.uniform(-0.5, 1.5, (60, 3)), 0.5 / np.array(shape)
    got = t.call("trilinear", grid, u, returns=Array((60, 2)))
    same = t.call("trilinear", grid, np.clip(u, rim, 1 - rim), returns=Array((60, 2)))
    t.close("samples", got, same)


# 08.5 ---------------------------------------------------------------------------------------------


@check(
    "08.5.single",
    task="08.5",
    points=2,
    calls=("trilinear_adjoint",),
    tolerance=EXACT,
    hint="g times the weight that the voxel had in the sample",
    sole="asks about one sample, without the forward function",
)
def one_sample_is_spread_around_its_place(t):
    """What one sample hands out sums to g, and is balanced around the sample's place."""
    shape = (4, 2, 5)
    for _ in range(5):
        u, g = between_centers(t, shape, 1), t.rng.uniform(0.5, 2.0, (1, 1))
        got = t.call("trilinear_adjoint", shape, u, g, returns=Array((*shape, 1))).ravel()
        t.close("sum over all voxels", got.sum(), g[0, 0], reveal=True)
        t.close("balance (x, y, z)", got @ centers(shape) / g[0, 0], u[0], reveal=True)
        t.require(
            bool((got >= 0).all()) and np.count_nonzero(got) <= 8,
            "a positive g must reach at most eight voxels, none negatively",
        )


@check(
    "08.5.transpose",
    task="08.5",
    points=3,
    calls=("trilinear_adjoint",),
    needs=("trilinear",),
    tolerance=EXACT,
    hint="the same weights as forwards, from sample to voxel; do repeated places add up?",
    sole="the definition of an adjoint",
)
def is_the_transpose(t):
    """<S x, g> = <x, S* g> for any grid x and any g, also where places repeat."""
    for shape in ((3, 2, 4), (1, 5, 2)):
        u = t.rng.uniform(-0.1, 1.1, (15, 3))
        u = np.concatenate([u, u[:5]])
        x, g = t.rng.uniform(-1.0, 1.0, (*shape, 2)), t.rng.uniform(-1.0, 1.0, (20, 2))
        back = t.call("trilinear_adjoint", shape, u, g, returns=Array((*shape, 2)))
        forth = t.call("trilinear", x, u, returns=Array((20, 2)))
        size = float(np.linalg.norm(forth) * np.linalg.norm(g))
        t.close(
            "<x, S* g>",
            np.vdot(x, back),
            np.vdot(forth, g),
            Tolerance(EXACT.relative, EXACT.evidence, floor=size),
        )
        t.close("S* g", back.reshape(-1, 2), sampling_matrix(t, shape, u).T @ g)
    nothing = t.call("trilinear_adjoint", shape, u, 0 * g, returns=Array((*shape, 2)))
    require_zero_for_zero(t, {"grid": nothing})


@check(
    "08.5.repeated",
    task="08.5",
    points=2,
    calls=("trilinear_adjoint",),
    tolerance=EXACT,
    hint="d_grid[i, j, k] += values adds once where an index occurs twice",
    sole="names the mistake of a scatter that forgets",
)
def repeated_places_add_up(t):
    """A place sampled ten times hands out the sum of its ten numbers."""
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


# 08.6 ---------------------------------------------------------------------------------------------

EARLIER = ("composite", "composite_adjoint", "ray_box", "trilinear", "trilinear_adjoint")


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
    """What `render_adjoint` returns."""
    return Items(Array((*shape, 4)), Array((3,)), names=("d_grid", "d_background"))


@check(
    "08.6.differences",
    task="08.6",
    points=4,
    calls=("render_adjoint",),
    needs=EARLIER,
    tolerance=GATE,
    hint="walk render_rays backwards, line by line: what does each line's adjoint need?",
    sole="the gradient of the picture, without the reference",
)
def the_picture_agrees_with_differences(t):
    """Moving one voxel a little moves the picture as your adjoint says."""
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
    require_gradients(t, slopes, forward, point, d_pixel, GATE)


@check(
    "08.6.rays",
    task="08.6",
    points=3,
    calls=("render_adjoint",),
    needs=EARLIER,
    tolerance=EXACT,
    hint="a ray that misses sees the background alone; derivatives of all rays add up",
    sole="which voxels and which rays: no derivative is needed for that",
)
def rays_add_up_and_misses_see_the_background(t):
    """Rays add up; one that misses moves the background alone; untouched voxels get nothing."""
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


# >>> hidden
def cast(t, n):
    """What `ray_box` takes: n rays about a box, some of which hit."""
    return *random_box(t), t.rng.uniform(-2.0, 2.0, (n, 3)), t.rng.normal(size=(n, 3))


def placed(t, n):
    """A grid, and n places."""
    return t.rng.uniform(-1.0, 1.0, (3, 1, 4, 2)), t.rng.uniform(-0.1, 1.1, (n, 3))


def moved(t, n):
    """What `composite_adjoint` takes for n rays of 6 steps."""
    return *random_rays(t, n), t.rng.uniform(-1, 1, (n, 3)), t.rng.uniform(-1, 1, n)


def pictured(t, n):
    """What `render_adjoint` takes for n rays of 5 steps."""
    background, d_pixel = t.rng.uniform(0.0, 1.0, 3), t.rng.uniform(-1.0, 1.0, (n, 3))
    return *random_view(t, n, (4, 3, 5)), 5, background, d_pixel


@check(
    "08.1.hidden",
    task="08.1",
    points=2,
    calls=("composite",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at values that are not known beforehand",
    battery=[
        Subject("composite", random_rays, lambda n: seen(n, 3), rows=(0, 1, 2)),
        Subject(
            "composite",
            lambda t, n: random_rays(t, 2, n, 1, 0.1),
            lambda _: seen(2, 1),
            sizes=(1, 300),
        ),
    ],
)
def random_rays_are_composited(t):
    """Pixels and T_end are right for random rays, of one step and of many."""
    for rays, steps, channels in ((4, 1, 2), (1, 40, 3), (7, 9, 1)):
        given = random_rays(t, rays, steps, channels)
        pixel, T_end = t.call("composite", *given, returns=seen(rays, channels))
        right = t.reference.composite(*given)
        t.close("pixel", pixel, right[0])
        t.close("T_end", T_end, right[1])


@check(
    "08.2.hidden",
    task="08.2",
    points=4,
    calls=("composite_adjoint",),
    needs=("composite",),
    visibility="hidden",
    tolerance=SUMS,
    sole="the same mistakes at values that are not known beforehand",
    battery=[Subject("composite_adjoint", moved, lambda n: slopes_of((n, 6), 3))],
)
def adjoints_of_random_rays(t):
    """All derivatives are right for random rays, of one step and of many."""
    for rays, steps, channels in ((4, 1, 2), (1, 40, 3), (7, 9, 1)):
        given = random_rays(t, rays, steps, channels, thick=min(1.5, 6 / steps))
        d = t.rng.uniform(-1, 1, (rays, channels)), t.rng.uniform(-1, 1, rays)
        got = t.call("composite_adjoint", *given, *d, returns=slopes_of((rays, steps), channels))
        right = t.reference.composite_adjoint(*given, *d)
        for name, mine, yours in zip(("sigma", "color", "background"), right, got, strict=True):
            t.close(f"d_{name}", yours, mine)


@check(
    "08.2.cost",
    task="08.2",
    points=2,
    calls=("composite_adjoint",),
    needs=("composite",),
    visibility="hidden",
    tolerance=SUMS,
)
def the_adjoint_of_a_ray_is_cheap(t):
    """For rays of 160 steps the adjoint is right, and costs a few forward calls."""
    given = random_rays(t, 80, 160, 3, thick=0.1)
    d = t.rng.uniform(-1, 1, (80, 3)), t.rng.uniform(-1, 1, 80)
    answer = slopes_of((80, 160), 3)
    got = t.call("composite_adjoint", *given, *d, returns=answer)
    for yours, mine in zip(got, t.reference.composite_adjoint(*given, *d), strict=True):
        t.close("derivatives", yours, mine)
    require_cheap(
        t, ("composite", given, seen(80, 3)), ("composite_adjoint", (*given, *d), answer), RAY_COST
    )


@check(
    "08.3.hidden",
    task="08.3",
    points=2,
    calls=("ray_box",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at rays that are not known beforehand",
    battery=[Subject("ray_box", cast, spans, rows=(2, 3))],
)
def random_rays_and_boxes(t):
    """Entry and exit are right for random rays, hits and misses, from outside and inside."""
    low, high = random_box(t)
    origins, directions = t.rng.uniform(-4.0, 4.0, (300, 3)), t.rng.normal(size=(300, 3))
    directions[::7, 1] = 0.0
    near, far = t.call("ray_box", low, high, origins, directions, returns=spans(300))
    right = t.reference.ray_box(low, high, origins, directions)
    t.close("t_near", near, right[0])
    t.close("t_far", far, right[1])


@check(
    "08.4.hidden",
    task="08.4",
    points=2,
    calls=("trilinear",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at places that are not known beforehand",
    battery=[Subject("trilinear", placed, lambda n: Array((n, 2)), rows=(1,))],
)
def samples_at_random_places(t):
    """Samples are right at random places of random grids, one voxel wide ones included."""
    for shape in ((6, 3, 4, 2), (1, 5, 2, 1), (1, 1, 1, 3)):
        grid, u = t.rng.uniform(-1.0, 1.0, shape), t.rng.uniform(-0.1, 1.1, (90, 3))
        got = t.call("trilinear", grid, u, returns=Array((90, shape[3])))
        t.close("samples", got, t.reference.trilinear(grid, u))


@check(
    "08.5.hidden",
    task="08.5",
    points=2,
    calls=("trilinear_adjoint",),
    visibility="hidden",
    tolerance=EXACT,
    needs=("trilinear",),
    sole="the same mistakes at places that are not known beforehand",
    battery=[
        Subject(
            "trilinear_adjoint",
            lambda t, n: ((3, 1, 4), placed(t, n)[1], t.rng.uniform(-1, 1, (n, 2))),
            lambda _: Array((3, 1, 4, 2)),
        )
    ],
)
def the_adjoint_at_random_places(t):
    """The adjoint is right at random places, one voxel wide grids included, and cheap."""
    for shape in ((6, 3, 4), (1, 5, 2), (1, 1, 1)):
        u, g = t.rng.uniform(-0.1, 1.1, (90, 3)), t.rng.uniform(-1.0, 1.0, (90, 2))
        got = t.call("trilinear_adjoint", shape, u, g, returns=Array((*shape, 2)))
        t.close("d_grid", got, t.reference.trilinear_adjoint(shape, u, g))
    shape = (14, 12, 13)
    grid, u = t.rng.uniform(0.0, 1.0, (*shape, 1)), t.rng.uniform(0.0, 1.0, (2000, 3))
    g = t.rng.uniform(-1.0, 1.0, (2000, 1))
    require_cheap(
        t,
        ("trilinear", (grid, u), Array((2000, 1))),
        ("trilinear_adjoint", (shape, u, g), Array((*shape, 1))),
    )


@check(
    "08.6.hidden",
    task="08.6",
    points=3,
    calls=("render_adjoint",),
    needs=EARLIER,
    visibility="hidden",
    tolerance=SUMS,
    sole="the same mistakes in views that are not known beforehand",
    battery=[Subject("render_adjoint", pictured, lambda _: slopes_of_view((4, 3, 5)))],
)
def the_picture_of_a_random_volume(t):
    """All derivatives are right for random volumes and rays, and cost a few pictures."""
    for rays, shape, n in ((9, (4, 3, 5), 8), (2, (1, 6, 2), 3)):
        view = random_view(t, rays, shape)
        background, d_pixel = t.rng.uniform(0.0, 1.0, 3), t.rng.uniform(-1.0, 1.0, (rays, 3))
        got = t.call("render_adjoint", *view, n, background, d_pixel, returns=slopes_of_view(shape))
        right = t.reference.render_adjoint(*view, n, background, d_pixel)
        t.close("d_grid", got[0], right[0])
        t.close("d_background", got[1], right[1])
    shape = (10, 8, 9)
    given = (*random_view(t, 60, shape), 24)
    background, d_pixel = t.rng.uniform(0.0, 1.0, 3), t.rng.uniform(-1.0, 1.0, (60, 3))
    require_cheap(
        t,
        ("render_rays", (*given, background), Array((60, 3))),
        ("render_adjoint", (*given, background, d_pixel), slopes_of_view(shape)),
    )


# <<< hidden
