"""What the figures of assignment 13 share: pictures, trainings, scores."""

from __future__ import annotations

from functools import cache
from types import ModuleType
from typing import Any

import numpy as np
from photograd_course.build.kit_module import kit_module

Array = np.ndarray[Any, np.dtype[Any]]

TRAINING = kit_module("13_hash_grids", "training")
decibels, SLOWER = TRAINING.decibels, TRAINING.SLOWER


def smooth(points: Array) -> Array:
    """A picture without fine detail: colors (N, 3) in warped waves."""
    x, y = points.T
    a = x + 0.15 * np.sin(2 * np.pi * y)
    b = y + 0.15 * np.sin(2 * np.pi * (x + y))
    shift = 0.1 * np.arange(3)[:, None]
    waves = np.sin(2 * np.pi * (2 * a + shift + b)) * np.cos(2 * np.pi * (b - a))
    return (0.5 + 0.5 * waves).T


def hash_grid(
    module: ModuleType,
    target: Array,
    resolutions: tuple[int, ...],
    most: int,
    steps: int,
    batch: int,
    rate: float = 0.03,
) -> tuple[Array, int]:
    """(colors of all pixels, parameters) of a hash grid trained on a square picture."""
    points = module.pixels(round(len(target) ** 0.5))
    levels = module.make_levels(resolutions, 2, most)
    table, weights = TRAINING.hash_grid(module, target, levels, steps, batch, rate)
    colors = module.network(weights, module.encode(points, table, levels))
    return colors, table.size + module.numbers_per_point(weights)


_plain: dict[tuple[Any, ...], tuple[Array, list[Array]]] = {}


def plain_network(
    module: ModuleType,
    target: Array,
    steps: int,
    batch: int,
    octaves: int = 5,
    hidden: tuple[int, ...] = (64, 64),
    rate: float = 0.006,
) -> tuple[Array, list[Array]]:
    """(colors of all pixels, weights) of a network; it does not depend on any task."""
    key = (target.tobytes(), steps, batch, octaves, hidden, rate)
    if key not in _plain:
        points = module.pixels(round(len(target) ** 0.5))
        weights = TRAINING.plain_network(module, target, steps, batch, octaves, hidden, rate)
        _plain[key] = module.network(weights, module.frequencies(points, octaves)), weights
    return _plain[key]


def as_picture(colors: Array) -> Array:
    """A square picture (n, n, 3) in steps of 1/31, which keep the file small."""
    size = round(len(colors) ** 0.5)
    return np.round(np.clip(colors, 0, 1) * 31).reshape(size, size, -1) / 31


def outlines(leaf: Array, scale: int) -> Array:
    """A mask (n scale, n scale), rows downward: True on the left and upper edges of leaves."""
    rows = leaf.T  # leaf is indexed x first
    edge = np.zeros((len(rows) * scale, len(rows) * scale), bool)
    across = np.ones(rows.shape, bool)
    across[:, 1:] = rows[:, 1:] != rows[:, :-1]
    down = np.ones(rows.shape, bool)
    down[1:] = rows[1:] != rows[:-1]
    edge[:, ::scale] |= np.repeat(across, scale, axis=0)
    edge[::scale] |= np.repeat(down, scale, axis=1)
    return edge


@cache
def corner_list(resolution: int) -> Array:
    """All corners of a level of the plane, x fastest."""
    j, i = np.divmod(np.arange((resolution + 1) ** 2), resolution + 1)
    return np.stack([i, j], axis=1)
