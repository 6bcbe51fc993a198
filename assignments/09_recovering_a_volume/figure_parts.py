"""What the figures of assignment 09 draw: scenes, their photographs, fits."""

from __future__ import annotations

from types import ModuleType

import numpy as np
from matplotlib.axes import Axes
from photograd_course.captures import all_around, look_at_origin, two_striped_balls
from photograd_course.viz.handout import Array

Views = dict[str, Array | float]
BACKGROUND = np.array([0.04, 0.05, 0.08])
LOW, HIGH = np.full(3, -1.0), np.full(3, 1.0)
LARGE = 80  # pixels of the views that are shown


def views_of(pictures: Array, poses: Array, zoom: float = 1.2) -> Views:
    return {
        "pictures": pictures,
        "world_from_camera": poses,
        "focal": zoom * pictures.shape[2],
        "low": LOW,
        "high": HIGH,
        "background": BACKGROUND,
    }


def columns_of(views: Views, view: int, points: Array) -> Array:
    """The columns to which points are projected, by equation (5)."""
    pose = np.asarray(views["world_from_camera"])[view]
    x, _, z = ((points - pose[:3, 3]) @ pose[:3, :3]).T
    return views["focal"] * x / z + np.asarray(views["pictures"]).shape[2] / 2


def snowman(n: int) -> Array:
    """A snowman of n^3 voxels, with a hat, a scarf and a carrot, lit from the upper left."""
    x = (np.stack(np.indices((n, n, n)), axis=-1) + 0.5) / n * 2 - 1
    grid = np.full((n, n, n, 4), 0.5)
    grid[..., 3] = 0.0
    light = np.array([-0.5, 0.7, 0.5])

    def add(inside: Array, paint: tuple, middle: tuple, size: float) -> None:
        """Where `inside`, in voxels, is positive; shaded as a ball around `middle`."""
        solid = np.clip(inside * n / 2 + 0.5, 0, 1)
        here = solid > 0.3
        lit = np.clip((x[here] - middle) @ light / size, -0.3, 1)
        grid[here, :3] = (0.5 + 0.45 * lit)[:, None] * paint
        grid[..., 3] = np.maximum(grid[..., 3], 14 * solid)

    for height, radius in ((-0.5, 0.45), (0.1, 0.32), (0.53, 0.23)):
        away = np.linalg.norm(x - [0, height, 0], axis=-1)
        add(radius - away, (1.0, 1.0, 1.0), (0, height, 0), radius)
    axis = np.hypot(x[..., 0], x[..., 2])
    scarf = 0.085 - np.hypot(axis - 0.22, x[..., 1] - 0.34)
    add(scarf, (0.95, 0.12, 0.1), (0, 0.3, 0), 0.3)
    tail = 0.09 - np.max(np.abs((x - [0.17, 0.16, 0.27]) / [0.9, 2.2, 0.9]), axis=-1)
    add(tail, (0.95, 0.12, 0.1), (0, 0.1, 0), 0.4)
    for radius, half, height in ((0.33, 0.05, 0.72), (0.2, 0.14, 0.83)):
        hat = np.minimum(radius - axis, half - np.abs(x[..., 1] - height))
        add(hat, (0.2, 0.25, 0.5), (0, 0.6, 0), 0.3)
    nose = x - [0, 0.53, 0.2]
    cone = 0.075 * (1 - nose[..., 2] / 0.4) - np.hypot(nose[..., 0], nose[..., 1])
    cone = np.minimum(cone, np.minimum(nose[..., 2], 0.4 - nose[..., 2]))
    add(cone, (1.0, 0.5, 0.1), (0, 0.45, 0.2), 0.1)
    for place in ((-0.09, 0.6, 0.22), (0.09, 0.6, 0.22), (0, 0.2, 0.33), (0, 0.02, 0.33)):
        add(0.055 - np.linalg.norm(x - place, axis=-1), (0.05, 0.05, 0.08), place, 0.1)
    return grid


def rendered(module: ModuleType, grid: Array, views: Views) -> Array:
    chosen = np.arange(np.asarray(views["pictures"])[..., 0].size)
    origins, directions, _ = module.ray_batch(views, chosen)
    return module.render_rays(grid, LOW, HIGH, origins, directions, 32, BACKGROUND)


def photographs(
    module: ModuleType, grid: Array, count: int, size: int, turn: float = 0.0, zoom: float = 1.2
) -> Views:
    poses = np.stack([look_at_origin(3.2 * p) for p in all_around(count, turn, up=1)])
    views = views_of(np.zeros((count, size, size, 3)), poses, zoom)
    views["pictures"] = rendered(module, grid, views).reshape(count, size, size, 3)
    return views


def large_view(module: ModuleType, grid: Array, views: Views, which: int) -> Views:
    """One of the views, with LARGE x LARGE pixels."""
    pose = np.asarray(views["world_from_camera"])[which : which + 1]
    zoom = float(views["focal"]) / np.asarray(views["pictures"]).shape[2]
    large = views_of(np.zeros((1, LARGE, LARGE, 3)), pose, zoom)
    large["pictures"] = rendered(module, grid, large).reshape(1, LARGE, LARGE, 3)
    return large


def score(module: ModuleType, grid: Array, views: Views) -> float:
    error = rendered(module, grid, views) - np.asarray(views["pictures"]).reshape(-1, 3)
    return float(-10 * np.log10(np.mean(error**2)))


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


def watched(
    module: ModuleType, views: Views, n: int, marks: tuple[int, ...], hiding: bool = True
) -> list[Array]:
    """The volumes after the marked numbers of steps of one fit.

    Without `hiding`, composite_adjoint of 08 lacks the occlusion term of d_sigma.
    """
    passed: list[Array] = []
    earlier = module.render_adjoint.__globals__
    tv, ray = module.tv_loss_adjoint, earlier["composite_adjoint"]

    def spy(grid: Array, eps: float) -> object:
        passed.append(grid.copy())
        return tv(grid, eps)

    def wrong(sigma: Array, color: Array, dt: Array, *rest: Array) -> tuple[Array, ...]:
        own = dt * np.exp(-np.cumsum(sigma * dt, axis=1)) * np.einsum("rsc,rc->rs", color, rest[1])
        return own, *ray(sigma, color, dt, *rest)[1:]

    module.tv_loss_adjoint = spy  # type: ignore[attr-defined]
    earlier["composite_adjoint"] = ray if hiding else wrong
    try:
        start = module.fog((n, n, n))
        last, _ = module.fit_volume(views, start, marks[-1], np.random.default_rng(9))
    finally:
        module.tv_loss_adjoint = tv  # type: ignore[attr-defined]
        earlier["composite_adjoint"] = ray
    return [[*passed, last][k] for k in marks]


def show(axes: Axes, picture: Array, title: str) -> None:
    axes.imshow(np.clip(picture, 0, 1) ** (1 / 2.2), interpolation="nearest")
    axes.set(xticks=[], yticks=[])
    axes.set_title(title)
