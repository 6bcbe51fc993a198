"""Helpers for the hidden checks of several tasks."""

import numpy as np
from photograd_course.captures import ball_volume

from ..common import around, views_of


def alike(t, n):
    """Two pictures of n rows."""
    return t.rng.uniform(-0.2, 1.2, (n, 3)), t.rng.uniform(-0.2, 1.2, (n, 3))


def two_balls(t, n, scale=1.0):
    """A volume (n, n, n, 4) of two balls, bright and striped, their insides opaque."""
    center = t.rng.normal(size=3)
    center *= t.rng.uniform(0.25, 0.4) / np.linalg.norm(center)
    wave = t.rng.normal(size=3)
    wave *= 9.0 / np.linalg.norm(wave)
    balls = [
        (scale * middle, scale * radius, t.rng.uniform(0.6, 1.0, 3))
        for middle, radius in ((center, 0.45), (-1.3 * center, 0.3))
    ]
    return ball_volume(n, balls, wave, 0.2)


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
