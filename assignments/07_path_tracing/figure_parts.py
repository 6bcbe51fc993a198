"""What the figures of assignment 07 draw: scenes, measurements, pieces of pictures."""

from __future__ import annotations

from types import ModuleType

import numpy as np
from matplotlib.axes import Axes
from photograd_course.build.kit_module import kit_module
from photograd_course.viz.handout import Array, note
from photograd_course.viz.style import BLUE, GRAY, INK, ORANGE

FIGURE_1 = kit_module("07_path_tracing", "figure_1")
table_rays = FIGURE_1.table_rays
table = FIGURE_1.table
apart = FIGURE_1.apart

UP = np.array([0.0, 1.0, 0.0])


def table_derivatives(module: ModuleType, size: tuple, rng: object) -> tuple[Array, Array]:
    """By pixel: its red with respect to red of the table, its mean with respect to roughness."""
    scene, side = module.demo_table(), 7
    hit = module.closest_hit(scene, *table_rays(module, *size))
    found = np.zeros((2, len(hit["primitive"])))
    for k in np.flatnonzero(hit["primitive"] == 0):
        many = module.repeated(module.take(hit, [k]), side**2)
        u = module.strata(rng, 1, side), module.strata(rng, 1, side)
        d = np.full((side**2, 3), 1 / (3 * side**2))
        by_color, by_rough = module.direct_light_backward(scene, many, *u, d)
        found[:, k] = 3 * by_color[0, 0], by_rough[0]
    return tuple(found.reshape(2, *size[::-1]))


def draw_solid_angle(axes: Axes) -> None:
    """A piece of a light, its normal, and the solid angle that it covers, seen from a point."""
    start, end = np.array([0.2, 2.2]), np.array([2.2, 1.7])
    along = (end - start) / np.linalg.norm(end - start)
    piece = start + (end - start) * np.array([0.6, 0.78])[:, None]
    middle = piece.mean(axis=0)
    axes.plot([-0.9, 2.4], [0, 0], color=GRAY)
    axes.plot(*np.stack([start, end]).T, color=ORANGE, linewidth=2)
    axes.plot(*piece.T, color=INK, linewidth=4, solid_capstyle="butt")
    axes.fill([0, *piece[:, 0]], [0, *piece[:, 1]], color=BLUE, alpha=0.15, linewidth=0)
    axes.plot([0, middle[0]], [0, middle[1]], color=BLUE)
    angle = np.arctan2(piece[:, 1], piece[:, 0])
    arc = np.linspace(*angle, 20)
    axes.plot(0.75 * np.cos(arc), 0.75 * np.sin(arc), color=BLUE, linewidth=2.5)
    tip = middle + 0.75 * np.array([along[1], -along[0]])
    axes.annotate("", tip, middle, arrowprops={"arrowstyle": "->", "color": INK})
    back = -middle / np.linalg.norm(middle)
    turn = np.linspace(np.arctan2(*(tip - middle)[::-1]), np.arctan2(*back[::-1]), 20)
    axes.plot(middle[0] + 0.4 * np.cos(turn), middle[1] + 0.4 * np.sin(turn), color=INK, lw=0.8)
    bisector = middle + 0.52 * np.array([np.cos(turn.mean()), np.sin(turn.mean())])
    for text, place, color in (
        ("light", (0.15, 2.32), ORANGE),
        ("dA", (1.62, 2.05), INK),
        ("r", (0.5, 1.05), BLUE),
        ("dω", (0.72, 0.42), BLUE),
        ("θ′", tuple(bisector - [0.1, 0.1]), INK),
        ("normal", (tip[0] - 0.05, tip[1] - 0.22), INK),
        ("x", (-0.08, -0.28), INK),
    ):
        note(axes, text, place, (0, 0), color=color)
    axes.plot(0, 0, "o", color=INK, markersize=4)
    axes.set(xlim=(-0.9, 2.5), ylim=(-0.4, 2.6), aspect="equal")
    axes.set_axis_off()


def irradiance(corners: Array) -> float:
    """Lambert's formula, of a surface at the origin that faces up."""
    d = corners / np.linalg.norm(corners, axis=1, keepdims=True)
    total = np.zeros(3)
    for a, b in zip(d, np.roll(d, -1, axis=0), strict=True):
        c = np.cross(a, b)
        total += np.arctan2(np.linalg.norm(c), a @ b) * c / np.linalg.norm(c)
    return float(abs(total @ UP) / 2)


def alone(module: ModuleType, scene: dict, hit: dict, u_light: Array, u_surface: Array) -> list:
    """Direct light by one strategy alone, with weight 1: light sampling, BSDF sampling."""
    found = []
    for by_light_sampling in (True, False):
        if by_light_sampling:
            wi, _, light = module.sample_light(scene, hit["points"], u_light)
        else:
            wi = module.sample_brdf(scene, hit, u_surface)
        there = module.closest_hit(scene, hit["points"], wi)
        if by_light_sampling:
            p = module.light_pdf(scene, there["primitive"], wi, there["t"])
            p = np.where(there["primitive"] == light, p, 0.0)
        else:
            p = module.brdf_pdf(scene, hit, wi)
        c = np.maximum(module.dot(wi, hit["normals"]), 0) / np.where(p > 0, p, np.inf)
        found.append(module.brdf(scene, hit, wi) * module.emitted(scene, there) * c[:, None])
    return found


def furnace(module: ModuleType, albedo: float, n: int, rng: np.random.Generator) -> tuple:
    """(scene, origins, directions): a closed cube that emits, and rays inside."""
    faces = (
        ((-1, -1, -1), (0, 0, 2), (2, 0, 0)),
        ((-1, 1, -1), (2, 0, 0), (0, 0, 2)),
        ((-1, -1, -1), (2, 0, 0), (0, 2, 0)),
        ((-1, -1, 1), (0, 2, 0), (2, 0, 0)),
        ((-1, -1, -1), (0, 2, 0), (0, 0, 2)),
        ((1, -1, -1), (0, 0, 2), (0, 2, 0)),
    )
    scene = module.assemble([module.rectangle(*f, emission=1.0, base_color=albedo) for f in faces])
    d = rng.normal(size=(n, 3))
    return scene, np.zeros((n, 3)), d / np.linalg.norm(d, axis=1, keepdims=True)


def fine(module: ModuleType, scene: dict, place: dict) -> float:
    """Mean of the channels of direct light from the one light, by a fine quadrature over it."""
    x, w = np.polynomial.legendre.leggauss(24)
    u, v = np.meshgrid((x + 1) / 2, (x + 1) / 2, indexing="ij")
    hit = module.repeated(place, u.size)
    u3 = np.stack([0 * u.ravel(), u.ravel(), v.ravel()], axis=1)
    wi, far, _ = module.sample_light(scene, hit["points"], u3)
    normal = module.front_normals(scene)[1]
    area = float(np.linalg.norm(np.cross(scene["edges_u"][1], scene["edges_v"][1])))
    irradiance = (wi @ UP) * -(wi @ normal) * area / far**2 * np.outer(w, w).ravel() / 4
    return float((irradiance @ module.brdf(scene, hit, wi) * scene["emission"][1]).mean())


def through_density(module: ModuleType, scene: dict, hit: dict, u: Array, value: float) -> float:
    """The term that is added where the density of the material is differentiated, too."""
    wi = module.sample_brdf(scene, hit, u)
    there = module.closest_hit(scene, hit["points"], wi)
    p = module.light_pdf(scene, there["primitive"], wi, there["t"])
    q = module.brdf_pdf(scene, hit, wi)
    near = module.brdf_pdf(module.demo_table(roughness=value + 1e-4), hit, wi)
    c = module.mis_weight(q, p) * np.maximum(module.dot(wi, hit["normals"]), 0)
    value_of = module.brdf(scene, hit, wi) * module.emitted(scene, there)
    return float(
        -(value_of.mean(axis=1) * c / np.where(q > 0, q, 1) ** 2 * (near - q) / 1e-4).mean()
    )


def descent(module: ModuleType, shared: bool) -> Array:
    """A matte base color by gradient descent, one sample per pixel, 110 steps."""
    light = module.rectangle([-1.2, 0.5, -1.2], [2.4, 0, 0], [0, 0, 2.4], emission=1.0)
    floor = module.rectangle([-1, 0, -1], [0, 0, 2], [2, 0, 0], base_color=0.6)
    scene = module.assemble([floor, light])
    rng = np.random.default_rng(8)
    n = 40
    points = np.column_stack([rng.uniform(-1, 1, n), np.zeros(n), rng.uniform(-1, 1, n)])
    hit = {
        "points": points,
        "normals": np.tile(UP, (n, 1)),
        "wo": np.tile(UP, (n, 1)),
        "front": np.ones(n, bool),
        "t": np.ones(n),
        "primitive": np.zeros(n, int),
    }
    many = module.repeated(hit, 144)
    x = (np.arange(12) + 0.5) / 12
    even = np.stack([0 * x.repeat(12), x.repeat(12), np.tile(x, 12)], axis=1)
    wi, far, _ = module.sample_light(scene, many["points"], np.tile(even, (n, 1)))
    irradiance = (wi @ UP) ** 2 * 2.4**2 / far**2
    picture = 0.6 / np.pi * irradiance.reshape(n, 144).mean(axis=1)
    track = []
    for _ in range(110):
        u = rng.random((4, n, 3))
        residual = module.direct_light(scene, hit, u[0], u[1]) - picture[:, None]
        which = u[:2] if shared else u[2:]
        slope, _ = module.direct_light_backward(scene, hit, *which, 2 * residual / n)
        scene["base_color"][0] = np.clip(scene["base_color"][0] - 0.15 * slope[0].mean(), 0, 1)
        track.append(scene["base_color"][0, 0])
    return np.array(track)
