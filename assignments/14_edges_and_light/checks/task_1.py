"""Task 14.1, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, checks_for

from .common import EXACT, GATE, covered

check = checks_for(calls=("edge_coverage",), adjoints=("edge_coverage",))


def away_from_kinks(t, n):
    """Random edges through the pixel, none through a corner of it."""
    angle, offset = t.rng.uniform(-4, 4, 20 * n), t.rng.uniform(-0.8, 0.8, 20 * n)
    x, y = np.abs(np.cos(angle)), np.abs(np.sin(angle))
    far = np.abs(offset)
    good = (np.minimum(x, y) > 0.05) & (far < (x + y) / 2 - 0.01)
    good &= np.abs(far - np.abs(x - y) / 2) > 0.01
    return angle[good][:n], offset[good][:n]


@check(
    "14.1.values",
    points=2,
    tolerance=EXACT,
    hint="section 1: upright and level edges first, then those that cut off a corner",
    sole="numbers that can be worked out by hand",
)
def known_edges(t):
    """Upright and level edges, edges at 45 degrees, edges that miss the pixel."""
    s = float(t.rng.uniform(0.1, 0.4))
    angle = np.array([0, 0, np.pi / 2, np.pi, -np.pi / 2])
    got = covered(t, angle, np.array([s, -s, s, s, -s]))
    upright = "an upright or level edge covers offset + 1/2, and its length in the pixel is 1"
    area = 0.5 + s * np.array([1, -1, 1, 1, -1])
    t.close("area", got["area"], area, reveal=True, hint=upright)
    t.close("d_offset", got["d_offset"], np.ones(5), reveal=True, hint=upright)
    t.require(
        bool(np.abs(got["d_angle"]).max() < 1e-12),
        "an upright or level edge turns about its middle: d_angle is 0",
    )
    got = covered(t, np.array([np.pi / 4, -3 * np.pi / 4]), np.array([s, s]))
    rest = np.sqrt(0.5) - s
    cut = "at 45 degrees the edge cuts off a corner, a right triangle; its hypotenuse is the edge"
    area = np.full(2, 1 - rest**2)
    t.close("area at 45 degrees", got["area"], area, reveal=True, hint=cut)
    t.close("d_offset at 45 degrees", got["d_offset"], np.full(2, 2 * rest), reveal=True, hint=cut)
    got = covered(t, np.array([0.0, 0, 1, 1, 2]), np.array([0.51, -0.6, 0.7, -2, 30]))
    beside = "an edge beyond the last corner misses the pixel: it covers all of it or nothing"
    area = np.array([1.0, 0, 1, 0, 1])
    t.close("area of edges beside the pixel", got["area"], area, hint=beside)
    for name in ("d_offset", "d_angle"):
        what = f"{name} of edges beside the pixel must be 0"
        t.require(not got[name].any(), what, hint=beside)


@check(
    "14.1.differences",
    points=3,
    tolerance=GATE,
    hint="equations (4) and (6): the length of the edge in the pixel, and its first moment",
    sole="the definition: your own area",
)
def derivatives_agree_with_differences(t):
    """Both derivatives, against finite differences of your own area."""
    angle, offset = away_from_kinks(t, 60)
    got, step = covered(t, angle, offset), 1e-5
    for name, moved in (("d_offset", (0, step)), ("d_angle", (step, 0))):
        ends = [
            covered(t, angle + sign * moved[0], offset + sign * moved[1])["area"]
            for sign in (1, -1)
        ]
        t.close(name, got[name], (ends[0] - ends[1]) / (2 * step))


@check(
    "14.1.areas",
    points=2,
    tolerance=EXACT,
    hint="the inner and the outer side fill the pixel; pixels of a square fill the square",
    sole="areas add up",
)
def areas_add_up(t):
    """Both sides of an edge sum to 1, and the pixels of a square to the area of the square."""
    angle, offset = away_from_kinks(t, 40)
    one = covered(t, angle, offset)
    other = covered(t, angle + np.pi, -offset)
    t.close("area of both sides", one["area"] + other["area"], np.ones(40), reveal=True)
    t.close("d_offset of the other side", other["d_offset"], one["d_offset"])
    t.close("d_angle of the other side", other["d_angle"], -one["d_angle"])
    for size in (3, 6):
        a, s = angle[size], offset[size]
        large = t.call("half_plane_image", a, size * s, size, size, returns=_pictures(size))[0]
        t.close(f"sum of {size} x {size} pixels", large.sum() / size**2, one["area"][size])


def _pictures(size):
    return Items(*[Array((size, size))] * 3)
