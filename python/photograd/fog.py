"""A picture of a sparse density grid: a transfer function, and a dense field for the marcher."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib import colormaps
from photograd_course.color import srgb_decode

from photograd.errors import RangeError, message
from photograd.fields.dense_grid import DenseGrid
from photograd.fields.march import MarchPolicy
from photograd.fit_options import FitOptions
from photograd.memory import require_room
from photograd.model import Model
from photograd.representation import Array
from photograd.sparse import SparseGrid
from photograd.vdb import read_vdb

RAMPS = ("white", "inferno", "viridis", "bone")
GREY = 0.8
THICK = 12.0
"""Optical depth of the longest edge of the box, filled with the highest density, by default."""


def load_fog(path: Path, *, ramp: str, sigma_t: float | None, resolution: int) -> Model:
    """What `fog_model` makes of the first scalar grid in a .vdb file. Raises IoError as well."""
    scalars = [grid for grid in read_vdb(path).grids if grid.channels == 1]
    if not scalars:
        raise RangeError(message("render", f"{path}", "a grid of densities", "vectors only"))
    return fog_model(scalars[0], ramp=ramp, sigma_t=sigma_t, resolution=resolution)


def fog_model(
    grid: SparseGrid, *, ramp: str = "white", sigma_t: float | None = None, resolution: int = 128
) -> Model:
    """A density grid as glowing fog: sigma_t proportional to the value, its colour from a ramp.

    Args:
        grid: one channel; values below zero count as none.
        ramp: one of RAMPS, which map 0 to the highest value to colours.
        sigma_t: 1/m at value 1; by default such that the highest value fills the box opaquely.
        resolution: voxels along the longest edge of the box, at most; the values are resampled
            trilinearly where the grid is finer or not aligned with the world.

    Raises:
        RangeError: another ramp, a grid without positive values, a field beyond memory.
    """
    if ramp not in RAMPS:
        raise RangeError(message("render", "ramp", f"one of {', '.join(RAMPS)}", repr(ramp)))
    most = grid.statistics.most
    if not most > 0:
        raise RangeError(message("render", "density", "a value above zero somewhere", f"{most}"))
    box, shape = _box_and_shape(grid, resolution)
    require_room("render", f"a field of {shape} voxels", 64 * int(np.prod(shape)), None)
    extent = box[1] - box[0]
    axes = [box[0, k] + (np.arange(n) + 0.5) * extent[k] / n for k, n in enumerate(shape)]
    at = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    density = np.maximum(grid.sample(at), 0).reshape(shape)
    values = np.concatenate([_colors(density / most, ramp), density[..., None]], axis=-1)
    policy = MarchPolicy(
        (tuple(box[0].tolist()), tuple(box[1].tolist())),
        float((extent / shape).min()) / 2,
        density_activation="relu",
        color_activation="identity",
        density_scale=THICK / (float(extent.max()) * most) if sigma_t is None else sigma_t,
    )
    field = DenseGrid(values.astype(np.float32), policy)
    return Model(field, np.zeros(3), FitOptions(), {}, np.zeros((0, 3)))


def _box_and_shape(grid: SparseGrid, resolution: int) -> tuple[Array, tuple[int, int, int]]:
    """World box (2, 3) around the active voxels, and how many cubes fill it."""
    lo, hi = grid.statistics.box - 0.5
    corners = np.array([np.where(c, hi, lo) for c in np.ndindex(2, 2, 2)])
    world = grid.to_world(corners)
    box = np.stack([world.min(axis=0), world.max(axis=0)])
    extent = box[1] - box[0]
    finest = float(np.linalg.norm(grid.world_from_index[:3, :3], axis=0).min())
    voxel = max(finest, float(extent.max()) / resolution)
    x, y, z = np.maximum(np.ceil(extent / voxel - 1e-6).astype(int), 2).tolist()
    centre = box.mean(axis=0)
    half = np.array([x, y, z]) * voxel / 2
    return np.stack([centre - half, centre + half]), (x, y, z)


def _colors(share: Array, ramp: str) -> Array:
    """Linear colours (X, Y, Z, 3) of values in 0..1."""
    if ramp == "white":
        return np.full((*share.shape, 3), GREY)
    return np.asarray(srgb_decode(colormaps[ramp](share.astype(np.float64))[..., :3]))
