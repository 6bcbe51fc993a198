"""Task 08.1, public checks."""

import math

import numpy as np
from photograd_course.grading import Tolerance, checks_for

from .common import EXACT, random_rays, seen

check = checks_for(calls=("composite",), tolerance=EXACT)

ORDER = Tolerance(
    0.02, "right ones have order 2 to 8e-4, the nearest wrong one (riemann) is off by 0.5"
)
DIGITS = "for tiny x, 1 - exp(-x) keeps only the digits of x that 1 + x has: see np.expm1"


@check(
    "08.1.constant",
    points=3,
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
    points=3,
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
    points=3,
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
    points=2,
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
    points=2,
    hint="handout, end of section 1",
    sole="all digits, from a thin medium to a wall",
)
def thin_air_and_walls(t):
    """A very thin medium, and an opaque wall that occludes everything behind it."""
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
        "pixel of a thin medium",
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
    points=2,
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
