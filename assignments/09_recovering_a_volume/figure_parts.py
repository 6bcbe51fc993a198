"""What the figures of assignment 09 draw: scenes, their photographs, fits."""

from __future__ import annotations

from types import ModuleType

import numpy as np
from photograd_course.build.kit_module import kit_module
from photograd_course.captures import two_striped_balls
from photograd_course.viz.handout import Array

FIGURE_1 = kit_module("09_recovering_a_volume", "figure_1")
BACKGROUND = FIGURE_1.BACKGROUND
LOW = FIGURE_1.LOW
HIGH = FIGURE_1.HIGH
LARGE = FIGURE_1.LARGE
views_of = FIGURE_1.views_of
renderings = FIGURE_1.renderings
photographs = FIGURE_1.photographs
large_view = FIGURE_1.large_view
score = FIGURE_1.score
show = FIGURE_1.show

Views = dict[str, Array | float]


def columns_of(views: Views, view: int, points: Array) -> Array:
    """The columns to which points are projected, by equation (5)."""
    pose = np.asarray(views["world_from_camera"])[view]
    x, _, z = ((points - pose[:3, 3]) @ pose[:3, :3]).T
    return views["focal"] * x / z + np.asarray(views["pictures"]).shape[2] / 2


def watched(
    module: ModuleType, views: Views, n: int, marks: tuple[int, ...], hiding: bool = True
) -> list[Array]:
    """The volumes after the marked numbers of steps of one fit.

    Without `hiding`, composite_adjoint of 08 lacks the occlusion term of d_sigma.
    """
    earlier = module.render_adjoint.__globals__
    ray = earlier["composite_adjoint"]

    def wrong(sigma: Array, color: Array, dt: Array, *rest: Array) -> tuple[Array, ...]:
        own = dt * np.exp(-np.cumsum(sigma * dt, axis=1)) * np.einsum("rsc,rc->rs", color, rest[1])
        return own, *ray(sigma, color, dt, *rest)[1:]

    earlier["composite_adjoint"] = ray if hiding else wrong
    try:
        found: list[Array] = FIGURE_1.watched(module, views, n, marks)
    finally:
        earlier["composite_adjoint"] = ray
    return found


def small_scene(module: ModuleType) -> tuple[Array, Views]:
    scene = two_striped_balls(16, 0.7)
    return scene, photographs(module, scene, 6, 14)


def slope_of(module: ModuleType, grid: Array, views: Views) -> Array:
    """The derivative with respect to extinction over all pixels."""
    chosen = np.arange(np.asarray(views["pictures"])[..., 0].size)
    origins, directions, truth = module.ray_batch(views, chosen)
    rays = (LOW, HIGH, origins, directions, module.SAMPLES, BACKGROUND)
    _, d_pixels = module.mse_and_cotangent(module.render_rays(grid, *rays), truth)
    return module.render_adjoint(grid, *rays, d_pixels)[0][..., 3]


def kinds(module: ModuleType, scene: Array, views: Views) -> tuple[Array, Array, Array, Array]:
    """Voxels inside; before background only; other empty ones; how many views see a ball.

    The last is -1 where no ray reads a voxel at all.
    """
    pictures = np.asarray(views["pictures"])
    each = pictures[0, ..., 0].size
    white = np.ones(scene.shape)
    seen, blamed = np.zeros(scene.shape[:3], bool), np.zeros(scene.shape[:3], int)
    for view in range(len(pictures)):
        chosen = view * each + np.arange(each)
        origins, directions, truth = module.ray_batch(views, chosen)
        meets = np.abs(truth - BACKGROUND).max(axis=1) > 1e-3
        rays = (LOW, HIGH, origins, directions, module.SAMPLES, BACKGROUND)
        for which in (np.ones(each), meets):
            weight = which[:, None] * np.ones(3)
            touched = module.render_adjoint(white, *rays, weight)[0][..., 0] > 1e-9
            if which is meets:
                blamed += touched
            else:
                seen |= touched
    blamed[~seen] = -1
    empty = scene[..., 3] == 0
    return scene[..., 3] > 5, blamed == 0, empty & (blamed > 0), blamed


def share_of(signs: Array, where: Array, sign: int) -> float:
    return float(np.mean(signs[where] == sign)) if where.any() else float("nan")
