"""The texture lookup in NumPy and double precision, and its adjoint with np.add.at."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def corners(shape: tuple[int, ...], uv: Array, wrong: str | None = None) -> list[tuple[Any, Array]]:
    """((rows, columns), weights (N,)) of the four texels; `wrong` names a mistake to make."""
    height, width = shape[:2]
    u, v = uv[:, 1 if wrong == "swapped axes" else 0], uv[:, 0 if wrong == "swapped axes" else 1]
    shift = 0.0 if wrong == "half a texel" else 0.5
    sizes = (width - 1, height - 1) if wrong == "corners aligned" else (width, height)
    x, y = u * sizes[0] - shift, v * sizes[1] - shift
    if wrong != "wraps around":
        x, y = np.clip(x, 0, width - 1), np.clip(y, 0, height - 1)
    column, row = np.floor(x).astype(int), np.floor(y).astype(int)
    f, g = x - column, y - row
    if wrong == "fractions swapped":
        f, g = g, f
    right, below = np.minimum(column + 1, width - 1), np.minimum(row + 1, height - 1)
    if wrong == "wraps around":
        column, right = column % width, (column + 1) % width
        row, below = row % height, (row + 1) % height
    found = [
        ((row, column), (1 - f) * (1 - g)),
        ((row, right), f * (1 - g)),
        ((below, column), (1 - f) * g),
        ((below, right), f * g),
    ]
    return found[:3] if wrong == "a texel forgotten" else found


def lookup(texture: Array, uv: Array, wrong: str | None = None) -> Array:
    """(N, C)."""
    parts = [texture[at] * w[:, None] for at, w in corners(texture.shape, uv, wrong)]
    total: Array = np.sum(parts, axis=0)
    return total


def adjoint(shape: tuple[int, ...], uv: Array, d_color: Array, wrong: str | None = None) -> Array:
    """dL/dtexture (H, W, C)."""
    total = np.zeros(shape)
    for at, w in corners(shape, uv, wrong):
        if wrong == "overwrites":
            total[at] = w[:, None] * d_color
        else:
            np.add.at(total, at, w[:, None] * d_color)
    return total


def points(count: int, seed: int, reach: float = 0.15) -> Array:
    """(count, 2) points of the unit square and a little beyond."""
    return np.random.default_rng(seed).uniform(-reach, 1 + reach, (count, 2))


def noise(shape: tuple[int, ...], seed: int) -> Array:
    """A texture without any symmetry."""
    return np.random.default_rng(seed).uniform(-1, 1, shape)
