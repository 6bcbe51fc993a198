"""What the figures of assignment 10 draw: scenes, measurements, pieces of pictures."""

from __future__ import annotations

from types import ModuleType

import numpy as np
from photograd_course.captures import all_around, rays_to_origin
from photograd_course.viz.handout import Array


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


def leaves_in_slice(
    module: ModuleType, tree: Array, n: int, k: int
) -> list[tuple[tuple[float, float], float, bool]]:
    """(lower corner, side, full) of the leaves that contain cells (i, j, k)."""
    cells = np.stack([*np.indices((n, n)).reshape(2, -1), np.full(n * n, k)], axis=1) + 0.5
    full, low, side = module.octree_leaf(tree, n, cells)
    rows = np.unique(np.column_stack([low[:, :2], side, full]), axis=0)
    return [((x, y), s, bool(f)) for x, y, s, f in rows]


def looks(
    module: ModuleType, rng: np.random.Generator, slots: int, count: int
) -> tuple[float, float]:
    """Mean number of slots visited by searches for voxels in the table and for others."""
    voxels = np.unique(rng.integers(-500, 500, (2 * count + 2000, 3)), axis=0)
    voxels = rng.permutation(voxels)
    table = np.zeros((slots, 4), np.int64)
    table[:, 3] = -1
    table = module.voxel_hash_insert(table, voxels[:count], np.arange(count))
    taken = table[:, 3] >= 0
    start = module.hash_slot(voxels, slots)
    place = np.flatnonzero(taken)
    here = np.zeros(count, int)
    here[table[place, 3]] = place
    hits = (here - start[:count]) % slots + 1
    free = np.flatnonzero(~taken)
    ahead = np.searchsorted(free, start[count:]) % len(free)
    misses = (free[ahead] - start[count:]) % slots + 1
    return float(hits.mean()), float(misses.mean())


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


def rods_of(n: int) -> tuple[Array, Array]:
    """(voxels, values): three rods that pass each other."""
    every = np.argwhere(np.ones((n, n, n), bool))
    x = (every + 0.5) / n * 2 - 1
    values = np.zeros((len(x), 4))
    rods = (
        ((0.9, 0.5, 0.2), (-0.3, 0.25)),
        ((0.3, 0.8, 0.3), (0.35, -0.3)),
        ((0.3, 0.5, 0.9), (0.1, 0.4)),
    )
    for axis, (paint, place) in enumerate(rods):
        away = np.linalg.norm(np.delete(x, axis, axis=1) - place, axis=1)
        inside = np.clip((0.17 - away) * n / 3 + 0.5, 0, 1) * (np.abs(x[:, axis]) < 0.75)
        values[inside > 0, :3] = paint
        values[:, 3] = np.maximum(values[:, 3], 8 * inside)
    return every[values[:, 3] > 0], values[values[:, 3] > 0]


def samples_of(module: ModuleType, n: int, voxels: Array, rays: Array) -> tuple[Array, ...]:
    empty = module.new_table(len(voxels))
    table = module.voxel_hash_insert(empty, voxels, np.arange(len(voxels)))
    return module.march(n, voxels, table, rays)


def picture(module: ModuleType, n: int, found: tuple[Array, ...], rays: Array) -> Array:
    return module.render(found[1], samples_of(module, n, found[0], rays))


def decibels(a: Array, b: Array) -> float:
    return float(-10 * np.log10(max(float(np.mean((a - b) ** 2)), 1e-30)))
