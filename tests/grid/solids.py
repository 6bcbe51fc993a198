"""Small sparse grids for tests."""

from __future__ import annotations

import numpy as np
from photograd.grids.sparse import SparseGrid
from photograd.types import Array

WORLD_FROM_INDEX = np.array(
    [[0.5, 0.1, 0, 1], [0, 0.25, 0, 2], [0, 0.05, 0.125, 3], [0, 0, 0, 1]], np.float64
)
"""Anisotropic voxels and a shear: exact in binary, and no axis can be mistaken for another."""
ORIGIN = (-5, 3, 700)


def spotted(channels: int = 1, *, seed: int = 0, density: float = 0.3) -> Array:
    """(20, 17, 30, C) float32, a part of it not zero, across borders of leaves at ORIGIN."""
    random = np.random.default_rng(seed)
    values = random.uniform(-2, 2, (20, 17, 30, channels)).astype(np.float32)
    values[random.random((20, 17, 30)) > density] = 0
    return values


def spotted_grid(channels: int = 1, *, seed: int = 0, density: float = 0.3) -> SparseGrid:
    """The same as a grid at ORIGIN, in a sheared world."""
    return SparseGrid.from_dense(
        spotted(channels, seed=seed, density=density),
        origin=ORIGIN,
        world_from_index=WORLD_FROM_INDEX,
        name="spots",
    )


def trilinear(values: Array, at: Array) -> Array:
    """(N, C) float64: values (X, Y, Z, C) at points (N, 3) in voxels, zero outside of the array."""
    padded = np.pad(values.astype(np.float64), ((2, 2), (2, 2), (2, 2), (0, 0)))
    at = np.clip(at, -2, np.array(values.shape[:3]) + 0.999) + 2
    base = np.floor(at).astype(int)
    fraction = at - base
    total = np.zeros((len(at), values.shape[3]))
    for corner in np.ndindex(2, 2, 2):
        weight = np.where(corner, fraction, 1 - fraction).prod(axis=1)
        total += weight[:, None] * padded[tuple((base + corner).T)]
    return total


def dilated(inside: Array, steps: int) -> Array:
    """True within a cube of `steps` around what is true; nothing may touch the border."""
    for axis in range(3):
        inside = np.any([np.roll(inside, k, axis) for k in range(-steps, steps + 1)], axis=0)
    return inside
