"""What the figures of assignment 10 draw: scenes, measurements, pieces of pictures."""

from __future__ import annotations

from collections.abc import Sequence
from types import ModuleType
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from photograd_course.assignment.load import load_module
from photograd_course.build.kit_module import kit_module
from photograd_course.build.kits import source_folders
from photograd_course.captures import all_around, rays_to_origin
from photograd_course.viz.handout import Array
from photograd_course.viz.style import INK


def _photographs() -> ModuleType:
    """`data/photographs.py`."""
    file = source_folders()["10_sparse_grids"] / "data" / "photographs.py"
    return load_module("photographs", file.read_text("utf-8"), {"__file__": str(file)})


PHOTOGRAPHS: Any = _photographs()
FIGURE_1 = kit_module("10_sparse_grids", "figure_1")
rays_of, decibels = FIGURE_1.rays_of, FIGURE_1.decibels
faster, show = FIGURE_1.faster, FIGURE_1.show


def training(size: int, every: int = 1) -> tuple[Array, Array]:
    """Rays and colors of the photographs to recover from, made smaller."""
    found: tuple[Array, Array] = FIGURE_1.training(PHOTOGRAPHS, size, every)
    return found


def gap(module: ModuleType, sigma: float, color: float) -> tuple[float, Array]:
    """(loss, gradient of the four numbers of the middle step) on the ray of the warm-up."""
    values = np.array([[0.2] * 3 + [1.0], [color] * 3 + [sigma], [0.8] * 3 + [2.0]])
    row = np.full((8, 3), -1)
    row[0] = 0, 1, 2
    weight = np.zeros((8, 3))
    weight[0] = 1.0
    samples = (np.ones((1, 3), bool), np.array([0.5]), row, weight)
    loss, d_values = module.loss_and_grad(values, samples, np.full((1, 3), 0.6))
    return loss, d_values[1]


def shell(n: int) -> Array:
    """Cells that a sphere crosses."""
    x = (np.stack(np.indices((n, n, n)), axis=-1) + 0.5) / n * 2 - 1
    away = np.linalg.norm(x - [0.05, -0.1, 0.0], axis=-1)
    return np.abs(away - 0.72) < 0.9 / n


def one_cell(n: int) -> Array:
    """A cube of cells of which one is full."""
    full = np.zeros((n, n, n), bool)
    full[1, 2, 0] = True
    return full


def rays_in_slice(n: int) -> tuple[Array, Array]:
    """(first, stride) of four rays through the middle slice of n cells."""
    height = np.array([3.3, 9.7, 16.4, 24.1])
    first = np.stack([np.full(4, 0.27), height, np.full(4, n / 2 + 0.5)], axis=1)
    tilt = np.array([0.05, 0.03, -0.02, -0.04])
    return first, np.stack([np.full(4, 0.493), 0.493 * tilt, np.zeros(4)], axis=1)


def leaves_in_slice(
    module: ModuleType, tree: Array, n: int, k: int
) -> list[tuple[tuple[float, float], float, bool]]:
    """(lower corner, side, full) of the leaves that contain cells (i, j, k)."""
    cells = np.stack([*np.indices((n, n)).reshape(2, -1), np.full(n * n, k)], axis=1) + 0.5
    full, low, side = module.octree_leaf(tree, n, cells)
    rows = np.unique(np.column_stack([low[:, :2], side, full]), axis=0)
    return [((x, y), s, bool(f)) for x, y, s, f in rows]


def cameras(views: int, size: int, turned: float = 0.0) -> Array:
    """Rays (2, views size^2, 3) of cameras all around."""
    return rays_to_origin(3.2 * all_around(views, turned), size, 0.38)


def ball_and_ring(n: int) -> tuple[Array, Array]:
    """(voxels, values): an orange ball with a blue ring around it."""
    every = np.argwhere(np.ones((n, n, n), bool))
    x = (every + 0.5) / n * 2 - 1
    ball = np.clip((0.33 - np.linalg.norm(x, axis=1)) * n / 3 + 0.5, 0, 1)
    ring = np.hypot(np.hypot(x[:, 0], x[:, 1]) - 0.7, x[:, 2])
    ring = np.clip((0.14 - ring) * n / 3 + 0.5, 0, 1)
    values = np.zeros((len(x), 4))
    values[:, :3] = np.where((ball >= ring)[:, None], (0.9, 0.6, 0.25), (0.35, 0.55, 0.9))
    values[:, 3] = 8 * np.maximum(ball, ring)
    return every[values[:, 3] > 0], values[values[:, 3] > 0]


def outlines(axes: Axes, n: int, sets: Sequence[Array]) -> None:
    """The borders of sets of voxels (V, 3) in the middle slice across z, dashed from the second."""
    for voxels, style in zip(sets, ("-", "--"), strict=True):
        mask = np.zeros((n + 2, n + 2))
        at = voxels[voxels[:, 2] == n // 2] + 1
        mask[at[:, 0], at[:, 1]] = 1.0
        for i, j in np.argwhere(mask[:-1] != mask[1:]):
            axes.plot([i - 0.5, i - 0.5], [j - 1.5, j - 0.5], color=INK, linestyle=style, lw=1)
        for i, j in np.argwhere(mask[:, :-1] != mask[:, 1:]):
            axes.plot([i - 1.5, i - 0.5], [j - 0.5, j - 0.5], color=INK, linestyle=style, lw=1)
