"""A picture of a density grid or scan: a transfer function, and a dense field for the marcher."""

from __future__ import annotations

from pathlib import Path
from typing import Literal, get_args

import numpy as np
from photograd_course.color import srgb_decode

from photograd._checks import typed
from photograd._fit_options import FitOptions
from photograd._memory import require_room
from photograd.errors import RangeError, message
from photograd.fields.dense_grid import DenseGrid
from photograd.fields.march import MarchPolicy
from photograd.fitting.model import Model
from photograd.grids.sparse import SparseGrid
from photograd.grids.vdb import read_vdb
from photograd.grids.volumes import SUFFIXES, read_volume
from photograd.types import Array

Ramp = Literal["white", "inferno", "viridis", "bone"]
RAMPS: tuple[Ramp, ...] = get_args(Ramp)
GRAY = 0.8
THICK = 12.0
"""Optical depth of the longest edge of the box, filled with the highest density, by default."""


def load_fog(
    path: Path,
    *,
    ramp: Ramp,
    sigma_t: float | None,
    resolution: int,
    window: tuple[float, float] | None = None,
) -> Model:
    """What `fog_model` makes of the first scalar grid in a .vdb file, or of a volume's density.

    Raises IoError as `photograd.grids.read_vdb` and `photograd.grids.read_volume` as well.

    Args:
        path: a .vdb file, or a volume: .vtk, .nii, .nii.gz or .vol.
        ramp: name of the colors over density.
        sigma_t: extinction in 1/m of the largest density; None takes a default.
        resolution: voxels along the longest edge at most.
        window: values of a volume that become density 0 and 1; None takes all.
    """
    if path.name.lower().endswith(SUFFIXES):
        volume = read_volume(path)
        grid = SparseGrid.from_dense(volume.density, world_from_index=volume.world_from_index)
    else:
        scalars = [found for found in read_vdb(path).grids if found.channels == 1]
        if not scalars:
            raise RangeError(message("render", f"{path}", "a grid of densities", "vectors only"))
        grid = scalars[0]
    return fog_model(grid, ramp=ramp, sigma_t=sigma_t, resolution=resolution, window=window)


def fog_model(
    grid: SparseGrid,
    *,
    ramp: Ramp = "white",
    sigma_t: float | None = None,
    resolution: int = 128,
    window: tuple[float, float] | None = None,
) -> Model:
    """A density grid as glowing fog: sigma_t proportional to the value, its color from a ramp.

    Args:
        grid: one channel; values below zero count as none.
        ramp: one of RAMPS, which map 0 to the highest value to colors.
        sigma_t: 1/m at value 1; by default such that the highest value fills the box opaquely.
        resolution: voxels along the longest edge of the box, at most; the values are resampled
            trilinearly where the grid is finer or not aligned with the world.
        window: values that count as 0 and as 1; below and above is cut off. Scans need it, in which
            air or noise has a value. By default values are taken as they are.

    Raises:
        RangeError: another ramp, a grid without positive values, an empty window, a field beyond
            memory.
    """
    typed("render", "ramp", Ramp, ramp)
    lo, hi = (0.0, np.inf) if window is None else window
    if not lo < hi:
        raise RangeError(message("render", "window", "two values, the lower first", window))
    found = grid.statistics.most
    if not found > lo:
        expected = f"a value above {'zero' if window is None else f'{lo:g}'} somewhere"
        raise RangeError(message("render", "density", expected, f"{found}"))
    most = found if window is None else 1.0
    box, shape = _box_and_shape(grid, resolution)
    require_room("render", f"a field of {shape} voxels", 64 * int(np.prod(shape)))
    extent = box[1] - box[0]
    axes = [box[0, k] + (np.arange(n) + 0.5) * extent[k] / n for k, n in enumerate(shape)]
    at = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    sampled = np.clip(grid.sample(at), lo, hi).reshape(shape)
    density = sampled if window is None else (sampled - lo) / (hi - lo)
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
    center = box.mean(axis=0)
    half = np.array([x, y, z]) * voxel / 2
    return np.stack([center - half, center + half]), (x, y, z)


def _colors(share: Array, ramp: Ramp) -> Array:
    """Linear colors (X, Y, Z, 3) of values in 0..1."""
    if ramp == "white":
        return np.full((*share.shape, 3), GRAY)
    from matplotlib import colormaps

    return np.asarray(srgb_decode(colormaps[ramp](share.astype(np.float64))[..., :3]))
