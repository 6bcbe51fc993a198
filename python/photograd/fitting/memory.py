"""What a fit takes of the memory, asked before it is taken.

Each is a lower bound: what it refuses cannot be done, what it allows may still be too much.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from photograd._memory import available_memory, require_room
from photograd.capture.capture import Capture
from photograd.fields.dense_grid import DenseGrid
from photograd.fields.sparse_sh import SparseSh
from photograd.fitting.options import FitOptions
from photograd.fitting.start import HARMONIC_GRIDS
from photograd.sh import count as sh_count
from photograd.splats.model import GaussianScene
from photograd.types import Array

COPIES = 4
"""A parameter, its gradient and two moments; also the 1.1 GB measured for 256³ voxels."""
BYTES_A_RAY = 480
"""Measured: 478 to 696, of dense_grid and sparse_sh, 200,000 and 800,000 rays."""
BYTES_A_PIXEL = 48
"""Color and alpha, view and place in it, and as much again while views are joined."""


def require_room_to_start(capture: Capture, box: Array, options: FitOptions) -> None:
    """Refuse a fit whose photographs, rays or parameters exceed the memory there is.

    Args:
        capture: its training views, of which the sizes count.
        box: (2, 3) of the scene, in meters.
        options: of the fit.

    Raises:
        RangeError: names the option, what it takes and what would do.
    """
    room = available_memory()
    parts = sorted(_parts(capture, box, options, room), key=lambda part: -part[2])
    for argument, what, size, remedy in parts:
        require_room("Fit.start", what, size, room, argument=argument, remedy=remedy)
        room -= size


def require_room_to_refine(grid: Any, resolution: int) -> None:
    """Raise RangeError if a grid, refined, takes more memory than there is.

    It is interpolated from the coarse grid while that still exists. A sparse grid that pruned
    little, of a capture without alpha, can grow eightfold.
    """
    now = sum(values.nbytes for values in grid.params.values())
    needed = COPIES * int(now * (1 + (resolution / grid.resolution) ** 3))
    remedy = f"fit with --resolution {grid.resolution}, or crop the capture's bounds"
    what = f"a grid of {resolution} voxels along an edge"
    require_room("Fit.step", what, needed, argument="resolution", remedy=remedy)


def _parts(
    capture: Capture, box: Array, options: FitOptions, room: int
) -> list[tuple[str, str, int, str]]:
    """Option, what it is, bytes, remedy."""
    pixels = sum(view.camera.width * view.camera.height for view in capture.train)
    parts = [
        ("capture", f"{pixels:,} pixels to learn from", BYTES_A_PIXEL * pixels,
         "take smaller photographs with --downscale"),
    ]  # fmt: skip
    name = options.representation
    if name == GaussianScene.name:
        # Position, scales, rotation and opacity; harmonics of three colors.
        each = COPIES * 4 * (3 + 3 + 4 + 1 + 3 * sh_count(options.degree))
        what = f"{options.gaussians:,} Gaussians"
        remedy = f"--gaussians {max(1, room // (2 * each)):,} takes half of it".replace(",", "")
        return [*parts, ("gaussians", what, each * options.gaussians, remedy)]
    remedy = "take fewer with --rays"
    parts.append(("rays", f"{options.rays:,} rays a step", BYTES_A_RAY * options.rays, remedy))
    if name == DenseGrid.name or name in HARMONIC_GRIDS:
        size = _grid_bytes(box, options)
        fits = int(options.resolution * min(1.0, room / (2 * size)) ** (1 / 3))
        what = f"a grid of {options.resolution} voxels along an edge"
        remedy = f"--resolution {fits} takes half of it; or crop the capture's bounds"
        parts.append(("resolution", what, size, remedy))
    return parts


def _grid_bytes(box: Array, options: FitOptions) -> int:
    """At the end of a fit; of a sparse grid, of which nobody knows what will be pruned, its mask
    at the end, and all of its voxels at the beginning.
    """
    name = options.representation
    channels = 4 if name == DenseGrid.name else 1 + 3 * sh_count(options.degree)
    if name != SparseSh.name:
        return COPIES * 4 * channels * _voxels(box, options.resolution)
    first = COPIES * 4 * channels * _voxels(box, options.levels()[0])
    mask_and_bricks = 2 * _voxels(box, options.resolution)
    return max(first, mask_and_bricks)


def _voxels(box: Array, resolution: int) -> int:
    extent = np.asarray(box[1] - box[0], np.float64)
    x, y, z = (int(n) for n in np.ceil(extent * (resolution / extent.max()) - 1e-6))
    return max(x, 2) * max(y, 2) * max(z, 2)
