"""Teaching many small networks what one field of networks says: distillation [Reiser2021].

Each network sees points of its own cell, its margin included, in voxels that are visible or next to
one. There it learns the opacity of a voxel's edge and the color, each by the cross-entropy between
sigmoid(raw) and the teacher's value y, whose derivative with respect to raw is sigmoid(raw) - y.
With sigma_t = density_scale softplus(raw) and a density scale of 1 / edge that opacity is
1 - exp(-softplus(raw)) = sigmoid(raw). Colors count by the opacity.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from photograd_course.optim import Adam
from photograd_course.portable_math import cos, expm1, sigmoid, sin
from photograd_course.random import uniform
from photograd_course.schedules import exponential

from photograd.fields.active_voxels import SIDE, dilated
from photograd.fields.cell_networks import CellGrid, Overlaps
from photograd.fields.decoded_march import harmonics
from photograd.fields.tabulate import Radiance
from photograd.types import Array

STEPS = 400
POINTS = 64
"""Of each network in a step."""
RATE, LAST_RATE = 1e-2, 0.1
"""Learning rate of Adam, and the fraction of it that is left at the end."""


def distill(grid: CellGrid, radiance: Radiance, *, seed: int) -> None:
    """Change the parameters of the networks in place until they say what a field says.

    Args:
        grid: networks with random weights, in float32.
        radiance: of the field.
        seed: of the points and directions.
    """
    cells = len(grid.active.origins)
    voxels, first = _voxels_of_cells(grid)
    lower, upper = np.array(grid.policy.box)
    edge = (upper - lower) / grid.active.shape
    cell = np.repeat(np.arange(cells), POINTS)
    pixel = np.arange(cells * POINTS)
    optimizer, rate = Adam(), exponential(LAST_RATE, STEPS)
    for step in range(STEPS):
        u = [uniform(seed, step=step, pixel=pixel, sample=1, dimension=k) for k in range(6)]
        chosen = first[cell] + (u[5] * np.diff(first)[cell]).astype(np.int64)
        inside = voxels[chosen] + np.stack(u[:3], axis=1)  # voxel i reaches from i to i + 1
        inside = np.clip(inside, 0, grid.active.shape)
        directions = _directions(u[3], u[4])
        sigma_t, rgb = radiance(lower + inside * edge, directions)
        opacity = -expm1(-sigma_t.astype(np.float64) * edge[0])
        targets = np.concatenate([opacity[:, None], rgb], axis=1)
        corner = grid.active.origins[cell]
        local = (2 * (inside - corner) / SIDE - 1).astype(np.float32)
        _step(grid, local, directions, targets, optimizer, RATE * rate(step))


def _step(
    grid: CellGrid, local: Array, directions: Array, targets: Array, optimizer: Adam, rate: float
) -> None:
    cells, rows = len(grid.active.origins), np.arange(len(local))
    one = np.ones(len(local), local.dtype)
    where = Overlaps(rows, np.arange(cells + 1) * POINTS, local, one, one)
    encoded, given = grid.densities(where)
    basis = harmonics(directions.astype(local.dtype))
    taken, raw = grid.colors(where, given[:, 1:], basis)
    share = 1 / POINTS
    d_density = share * (sigmoid(given[:, 0]) - targets[:, 0])
    d_color = share * targets[:, :1] * (sigmoid(raw) - targets[:, 1:])
    density, color = grid.policy.networks()
    d_color_rows, d_taken = color.backward(
        grid.params["color"], where.offset, taken, d_color.astype(local.dtype)
    )
    d_features = d_taken[:, : grid.policy.features]
    d_given = np.concatenate([d_density[:, None], d_features], axis=1).astype(local.dtype)
    d_density_rows, _ = density.backward(grid.params["density"], where.offset, encoded, d_given)
    gradients = {"density": d_density_rows, "color": d_color_rows}
    optimizer.step(grid.params, gradients, rate)


def _voxels_of_cells(grid: CellGrid) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Voxels (K, 3) in sight, or next to one, of each cell and its margin; where each begins."""
    mask = np.pad(dilated(np.pad(grid.active.mask, 1)), SIDE)
    found = []
    for origin in grid.active.origins:
        x, y, z = origin + SIDE  # one voxel before the cell, in the padded mask
        window = mask[x : x + SIDE + 2, y : y + SIDE + 2, z : z + SIDE + 2]
        found.append(origin - 1 + np.argwhere(window))
    return np.concatenate(found), np.concatenate([[0], np.cumsum([len(rows) for rows in found])])


def _directions(u: Array, v: Array) -> Array:
    """Uniform on the sphere."""
    z, turn = 2 * u - 1, 2 * np.pi * v
    radius = np.sqrt(np.maximum(1 - z * z, 0))
    return np.stack([radius * cos(turn), radius * sin(turn), z], axis=1)
