"""What the figures of assignment 14 draw: fits, estimates, derivatives of single pixels."""

from __future__ import annotations

from functools import cache
from types import ModuleType

import numpy as np
from photograd_course.build.kit_module import kit_module
from photograd_course.viz.handout import Array

FIGURE_1 = kit_module("14_edges_and_light", "figure_1")
LETTERS = FIGURE_1.LETTERS
CURVE = FIGURE_1.CURVE
WIDTH = FIGURE_1.WIDTH
close_up = FIGURE_1.close_up
likeness = FIGURE_1.likeness

TRIANGLE = np.array([[3.2, 2.1], [12.9, 5.5], [6.1, 13.4]])


def samples_of(offset: float, angle: float, side: int = 500) -> float:
    """Covered share of side^2 points of a pixel."""
    x = (np.arange(side) + 0.5) / side - 0.5
    return float(np.mean(np.cos(angle) * x + np.sin(angle) * x[:, None] < offset))


def inside(vertices: Array, points: Array) -> Array:
    """Which points (N, 2) lie in a convex polygon."""
    a, b = vertices, np.roll(vertices, -1, axis=0)
    d, p = b - a, points[:, None] - a
    return ((d[:, 0] * p[..., 1] - d[:, 1] * p[..., 0]) > 0).all(axis=1)


def vertex_error(found: Array, truth: Array) -> float:
    """The largest distance of a vertex, however they are numbered."""
    turns = [np.roll(found, k, axis=0) - truth for k in range(len(truth))]
    return min(float(np.hypot(*turn.T).max()) for turn in turns)


def starts() -> list[Array]:
    """Five triangles around the one to be found."""
    rng, found = np.random.default_rng(4), []
    for _ in range(5):
        turn, size = rng.uniform(-0.5, 0.5), rng.uniform(0.5, 0.9)
        c, s = size * np.cos(turn), size * np.sin(turn)
        middle = TRIANGLE.mean(axis=0)
        spin = np.array([[c, s], [-s, c]])
        found.append(middle + rng.uniform(-1.5, 1.5, 2) + (TRIANGLE - middle) @ spin)
    return found


def stroke_derivatives(module: ModuleType, size: int) -> tuple[Array, Array]:
    """By pixel: with respect to the width, and to y of the middle control point."""
    by_width, by_point = np.zeros((size, size)), np.zeros((size, size))
    for row in range(size):
        for column in range(size):
            d_alpha = np.zeros((size, size))
            d_alpha[row, column] = 1.0
            d_curve, by_width[row, column] = module.stroke_backward(CURVE, WIDTH, d_alpha)
            by_point[row, column] = d_curve[1, 1]
    return by_width, by_point


def curve_length(module: ModuleType) -> float:
    """Of CURVE."""
    points = module.bezier(CURVE, np.linspace(0, 1, 2001))
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def niche_image(module: ModuleType, width: int, height: int, samples: int, depth: int) -> Array:
    """An image (height, width, 3) of the niche."""
    rays = [np.repeat(each, samples, axis=0) for each in module.niche_rays(width, height)]
    seen = module.path_radiance(module.demo_niche(), *rays, depth, 1)
    return seen.reshape(height, width, samples, 3).mean(axis=2)


def wall_derivatives(module: ModuleType, width: int, height: int, samples: int) -> tuple:
    """By pixel: red with respect to red of the red wall, by replay and by finite differences."""
    scene, (o, d) = module.demo_niche(), module.niche_rays(width, height)
    rays = [np.repeat(each, samples, axis=0) for each in (o, d)]
    ends = []
    for step in (1e-5, -1e-5):
        moved = {**scene, "base_color": scene["base_color"].copy()}
        moved["base_color"][2, 0] += step
        seen = module.path_radiance(moved, *rays, 3, 5, scene)[:, 0]
        ends.append(seen.reshape(-1, samples).mean(axis=1))
    by_steps = (ends[0] - ends[1]) / 2e-5
    radiance, replayed = module.path_radiance(scene, *rays, 3, 5), np.zeros(len(o))
    for k in range(len(o)):
        given = np.zeros(radiance.shape)
        given[k * samples : (k + 1) * samples, 0] = 1 / samples
        replayed[k] = module.replay_backward(scene, *rays, 3, 5, radiance, given)[0][2, 0]
    return replayed.reshape(height, width), by_steps.reshape(height, width)


@cache
def table_photograph(source: object) -> Array:
    """Pixels (N, 3) of the niche, depth 3, many paths each; `source` is the module's file."""
    module = source
    rays = [np.repeat(each, 500, axis=0) for each in module.niche_rays(8, 6)]
    seen = [module.path_radiance(module.demo_niche(), *rays, 3, 90 + k) for k in range(10)]
    return np.mean(seen, axis=0).reshape(-1, 500, 3).mean(axis=1)
