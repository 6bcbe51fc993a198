"""What the figures of assignment 04 draw: directions, facets, cells of the hemisphere."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from photograd_course.build.kit_module import kit_module
from photograd_course.viz.handout import Array, note
from photograd_course.viz.style import BLUE, FRAME, GRAY, INK, ORANGE
from photograd_course.viz.style import RED as CRIMSON

FIGURE_1 = kit_module("04_reflectance", "figure_1")
LIGHTS = FIGURE_1.LIGHTS
unit = FIGURE_1.unit

TILT = np.radians(24)  # from which the hemisphere is seen


def toward(degrees: float) -> Array:
    """(x, z) of the direction that makes an angle with the normal, to the right of it."""
    return np.array([np.sin(np.radians(degrees)), np.cos(np.radians(degrees))])


def mirrored(w: Array, normal: Array) -> Array:
    """A direction reflected at a normal; both leave the surface."""
    return 2 * (w @ normal) * normal - w


def arrow(axes: Axes, start, end, label="", color=INK, place=1.1, **options) -> None:
    """An arrow, with a label at `place` times its length."""
    start, end = np.array(start, float), np.array(end, float)
    look = {"arrowstyle": "-|>", "color": color, "lw": 1.3, "shrinkA": 0, "shrinkB": 0, **options}
    axes.annotate("", end, start, arrowprops=look)
    if label:
        at = start + place * (end - start)
        axes.text(*at, label, color=color, ha="center", va="center")


def arc(axes: Axes, center, low: float, high: float, radius: float, label="", color=INK) -> None:
    """An arc between two angles with the normal, in degrees, with its label outside."""
    turn = np.array([toward(each) for each in np.linspace(low, high, 40)])
    axes.plot(*(np.array(center) + radius * turn).T, color=color, linewidth=0.9)
    if label:
        at = np.array(center) + (radius + 0.13) * toward((low + high) / 2)
        axes.text(*at, label, color=color, ha="center", va="center")


def bare(axes: Axes, x: tuple[float, float], y: tuple[float, float], title: str) -> None:
    """Equal units on both axes, and no frame."""
    axes.set(xlim=x, ylim=y, aspect="equal", title=title)
    axes.set_axis_off()


def on_screen(points: Array) -> Array:
    """(x, y) where points (N, 3) are drawn, seen from a little above."""
    points = np.asarray(points)
    return np.stack(
        [points[..., 0], points[..., 2] * np.cos(TILT) + points[..., 1] * np.sin(TILT)], axis=-1
    )


def at_angles(theta: Array, phi: Array) -> Array:
    """Unit vectors (..., 3) by angles in degrees."""
    theta, phi = np.broadcast_arrays(np.radians(theta), np.radians(phi))
    s = np.sin(theta)
    return np.stack([s * np.cos(phi), s * np.sin(phi), np.cos(theta)], axis=-1)


def draw_hemisphere(axes: Axes) -> None:
    """The unit hemisphere and the disc below it."""
    turn = np.linspace(0, 360, 121)
    for theta in (22.5, 45, 67.5):
        axes.plot(*on_screen(at_angles(theta, turn)).T, color=FRAME, linewidth=0.4)
    for phi in range(0, 360, 30):
        line = at_angles(np.linspace(0, 90, 40), phi)
        axes.plot(*on_screen(line).T, color=FRAME, linewidth=0.4)
    axes.fill(*on_screen(at_angles(90, turn)).T, color="#eceef0", zorder=0)
    axes.plot(*on_screen(at_angles(90, turn)).T, color=INK, linewidth=0.9)
    axes.plot(np.cos(np.radians(turn[:61])), np.sin(np.radians(turn[:61])), color=INK, lw=0.9)


def border_of(low: tuple[float, float], high: tuple[float, float], flat: bool = False) -> Array:
    """The border (M, 3) of a cell between two pairs of angles; flat: below it, on the disc."""
    s = np.linspace(0, 1, 15)
    (a, b), (c, d) = low, high
    sides = [(a + s * (c - a), b), (c, b + s * (d - b)), (c + s * (a - c), d), (a, d + s * (b - d))]
    border = np.concatenate([at_angles(*side) for side in sides])
    return border * [1, 1, 0] if flat else border


def profile(x: Array) -> Array:
    """A rough surface: straight facets between random heights."""
    knots = np.linspace(-1.2, 1.2, 12)
    return np.interp(x, knots, 0.4 * np.random.default_rng(11).uniform(-1, 0.3, 12))


def is_seen(x: Array, z: Array, w: Array) -> Array:
    """Which points of a profile nothing hides from a far viewer in the direction w = (x, z)."""
    lifted = z - x * w[1] / w[0]  # constant along w
    order = np.argsort(x)[:: 1 if w[0] < 0 else -1]  # from the side of the viewer
    highest = np.maximum.accumulate(lifted[order])
    seen = np.zeros(len(x), bool)
    seen[order] = lifted[order] >= highest - 1e-9
    return seen


def mirror(module, r):
    return lambda wo, wi: module.ggx_lobe(wo, wi, np.full(len(wo), r))[:, None]


def white(module, m, r):
    def f(wo, wi):
        n = len(wo)
        return module.gltf(wo, wi, np.ones((n, 3)), np.full(n, m), np.full(n, r))

    return f


def weights(module, wo, wi, r, pdf):
    lobe = module.ggx_lobe(wo, wi, np.full(len(wo), r))
    return np.where(pdf > 0, lobe * wi[:, 2] / np.where(pdf > 0, pdf, 1), 0)


def even(rng, n):
    z, phi = rng.random(n), 2 * np.pi * rng.random(n)
    s = np.sqrt(1 - z * z)
    return np.stack([s * np.cos(phi), s * np.sin(phi), z], axis=1)


def draw_light_at_an_angle(axes: Axes) -> None:
    """A beam that is 1 wide, and how much of the surface it covers."""
    w, across = toward(60), np.array([-0.5, np.sqrt(0.75)])
    ends = np.array([[-1.0, 0], [1.0, 0]])  # 1 / cos 60 degrees apart
    front = ends[1] + 0.45 * w + np.array([0 * across, across])
    axes.fill(*np.array([*ends, *front]).T, color="#fbe3cd", zorder=0)
    for start in np.linspace(*front, 5):
        arrow(axes, start + 0.75 * w, start, color=ORANGE, lw=1.0)
    axes.plot(*front.T, color=CRIMSON, linewidth=2)
    axes.text(*(front.mean(axis=0) - 0.15 * w), "1", color=CRIMSON, ha="center", va="center")
    axes.axhline(0, color=FRAME)
    axes.plot(*ends.T, color=BLUE, linewidth=4, solid_capstyle="butt")
    axes.text(0, -0.25, "1 / cos θ", color=BLUE, ha="center")
    arrow(axes, ends[0], ends[0] + [0, 1.1], "normal")
    arrow(axes, ends[0], ends[0] + 0.8 * w, "$w_i$", ORANGE, place=1.15)
    arc(axes, ends[0], 0, 60, 0.5, "θ")
    bare(axes, (-1.4, 2.4), (-0.5, 1.4), "light at an angle θ")


def draw_solid_angle(axes: Axes) -> None:
    """A cell of the hemisphere, and its shadow on the disc below."""
    draw_hemisphere(axes)
    low, high = (36, -75), (52, -48)
    cell, shadow = (on_screen(border_of(low, high, flat)) for flat in (False, True))
    for k in (0, 15, 30, 45):
        axes.plot(*np.array([cell[k], shadow[k]]).T, ":", color=INK, linewidth=0.8, zorder=4)
        axes.plot(*np.array([[0, 0], cell[k]]).T, color=ORANGE, linewidth=0.7, zorder=2)
    axes.fill(*cell.T, color=ORANGE, zorder=3)
    axes.fill(*shadow.T, color=BLUE, zorder=3)
    arrow(axes, [0, 0], [0, 1.15], "z", place=1.12)
    note(axes, "dω", tuple(cell.mean(axis=0)), (20, 6), color=ORANGE)
    note(axes, "cos θ dω", tuple(shadow.mean(axis=0)), (20, -4), color=BLUE)
    bare(axes, (-1.4, 1.4), (-0.5, 1.4), "a solid angle, and the disc below")


def draw_half_vector(axes: Axes) -> None:
    """A facet that reflects w_i into w_o."""
    _facet(axes, -12.5, INK)
    for degrees, name, color in ((60, "$w_o$", BLUE), (-35, "$w_i$", ORANGE), (12.5, "$w_h$", INK)):
        arrow(axes, [0, 0], toward(degrees), name, color, place=1.14)
    arc(axes, [0, 0], -35, 12.5, 0.42)
    arc(axes, [0, 0], 12.5, 60, 0.46)
    bare(axes, (-1.1, 1.2), (-0.5, 1.3), "half vector")


def draw_masking(axes: Axes, x: Array, z: Array, both: Array, one: Array) -> None:
    """A rough surface; which of its points viewer and light see, and which only one of them."""
    axes.fill_between(x, z, -0.5, color="#eceef0")
    axes.plot(x, z, color=INK, linewidth=1)
    axes.plot(x, np.where(both, z, np.nan), color=BLUE, linewidth=3.5)
    axes.plot(x, np.where(one, z, np.nan), color=ORANGE, linewidth=3.5)
    for degrees, at, name in ((55, 0.3, "viewer"), (-50, -0.3, "light")):
        start = np.array([at, 0.4])
        arrow(axes, start, start + 0.75 * toward(degrees), name, place=1.18)
    bare(axes, (-1.2, 1.2), (-0.5, 1.3), "masking and shadowing")


def draw_turned_facet(axes: Axes, o: Array, turn: float) -> None:
    """A facet in two positions, and where it reflects o."""
    for degrees, look, color in ((0, "-", GRAY), (-turn, "-", INK)):
        _facet(axes, -degrees, color)
        arrow(axes, [0, 0], 0.75 * toward(degrees), color=color, ls=look)
        arrow(axes, [0, 0], mirrored(o, toward(degrees)), color=ORANGE, ls=look)
    arrow(axes, [0, 0], o, "$w_o$", BLUE)
    arc(axes, [0, 0], -turn, 0, 0.6, "δ")
    arc(axes, [0, 0], -50 - 2 * turn, -50, 0.8, "2 δ", ORANGE)
    bare(axes, (-1.2, 1.1), (-0.5, 1.3), "a facet turns")


def draw_visible_normals(axes: Axes, height: float, w: Array, name: str) -> None:
    """An arch, the normals on the part of it that w sees; of a circle also w reflected at them."""
    angles = np.linspace(-90, 90, 181)
    arch = np.array([toward(each) for each in angles]) * [1, height]
    normals = arch / [1, height**2]
    seen = normals @ w > 0
    axes.fill(*arch.T, color="#eceef0")
    axes.plot(*arch.T, color=GRAY)
    axes.plot(*arch[seen].T, color=BLUE, linewidth=3)
    for k in np.flatnonzero(seen)[4::16]:
        n = unit(normals[k])
        arrow(axes, arch[k], arch[k] + 0.3 * n, color=BLUE, lw=0.8)
        if height == 1:
            arrow(axes, arch[k], arch[k] + 0.45 * mirrored(w, n), color=ORANGE, lw=0.8)
    arrow(axes, [0, 0], 1.5 * w, name, CRIMSON)


def _facet(axes: Axes, tilt: float, color: str) -> None:
    along = 0.4 * np.array([np.cos(np.radians(tilt)), np.sin(np.radians(tilt))])
    axes.plot(*np.array([-along, along]).T, color=color, linewidth=3, solid_capstyle="butt")
