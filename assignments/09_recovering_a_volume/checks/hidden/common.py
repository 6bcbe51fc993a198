"""Helpers for the hidden checks of several tasks."""

import numpy as np

from ..common import around, views_of


def alike(t, n):
    """Two pictures of n rows."""
    return t.rng.uniform(-0.2, 1.2, (n, 3)), t.rng.uniform(-0.2, 1.2, (n, 3))


def two_balls(t, n, scale=1.0):
    """A volume (n, n, n, 4) of two balls, bright and striped, their insides opaque."""
    x = (np.stack(np.indices((n, n, n)), axis=-1) + 0.5) / n * 2 - 1
    center = t.rng.normal(size=3)
    center *= t.rng.uniform(0.25, 0.4) / np.linalg.norm(center)
    wave = t.rng.normal(size=3)
    wave *= 9.0 / np.linalg.norm(wave)
    grid = np.full((n, n, n, 4), 0.5)
    grid[..., 3] = 0.0
    for middle, radius in ((center, 0.45), (-1.3 * center, 0.3)):
        away = np.linalg.norm(x - scale * middle, axis=-1)
        inside = np.clip((scale * radius - away) * n / 3 + 0.5, 0, 1)
        paint = t.rng.uniform(0.6, 1.0, 3)
        here = inside > grid[..., 3] / 10
        shade = 0.8 + 0.2 * np.sin(x[here] @ wave)
        grid[here, :3] = shade[:, None] * paint
        grid[..., 3] = np.maximum(grid[..., 3], 10 * inside)
    return grid


def photographed(t, grid, count, size, turn=0.0):
    """Views of a volume by the reference's renderer, before a dark background."""
    views = views_of(np.zeros((count, size, size, 3)), around(count, turn=turn), np.zeros(3))
    views["background"] = np.array([0.04, 0.05, 0.08])
    views["pictures"] = rendered(t, grid, views).reshape(count, size, size, 3)
    return views


def rendered(t, grid, views):
    """Pixels (R, 3) of all views of a volume, by the reference."""
    chosen = np.arange(views["pictures"][..., 0].size)
    origins, directions, _ = t.reference.ray_batch(views, chosen)
    box = views["low"], views["high"]
    return t.reference.render_rays(grid, *box, origins, directions, 32, views["background"])
