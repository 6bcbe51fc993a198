"""The visual hull: what every silhouette still allows [Laurentini1994]."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from photograd_course.portable_math import norm

from photograd.capture.camera import Camera
from photograd.capture.view import View
from photograd.types import FloatArray

RESOLUTIONS = (32, 64)
"""The second pass carves inside the box of the first, whose voxels were coarse."""

Silhouette: TypeAlias = tuple[Camera, npt.NDArray[np.int64]]
"""A camera and the summed-area table (H + 1, W + 1) of its pixels that may show the object."""


def visual_hull_box(
    silhouettes: Sequence[Silhouette], box: FloatArray, resolutions: Sequence[int] = RESOLUTIONS
) -> FloatArray | None:
    """Box (2, 3) of the voxels of `box` that no view shows to be empty; None if none is left.

    A voxel is empty if its footprint meets no pixel with alpha in some view that shows it, or if
    fewer than half of the views show it. A voxel is kept in doubt, so that the hull contains the
    object; its box is at most a voxel and a pixel too large on each side.
    """
    for resolution in resolutions:
        alive = _carve(silhouettes, box, resolution)
        if not bool(alive.any()):
            return None
        size = (box[1] - box[0]) / resolution
        found = np.argwhere(alive.reshape((resolution,) * 3))
        box = np.stack([box[0] + found.min(axis=0) * size, box[0] + (found.max(axis=0) + 1) * size])
    return box


def silhouettes_of(views: Sequence[View]) -> list[Silhouette]:
    """Read the alpha of each view; pixels that are not valid may show anything."""
    result: list[Silhouette] = []
    for view in views:
        occupied = (view.rgba()[..., 3] > 0.0) | ~view.valid_mask()
        table = np.zeros((occupied.shape[0] + 1, occupied.shape[1] + 1), dtype=np.int64)
        table[1:, 1:] = occupied.cumsum(axis=0, dtype=np.int64).cumsum(axis=1)
        result.append((view.camera, table))
    return result


def mean_coverage(silhouettes: Sequence[Silhouette]) -> float:
    """Fraction of pixels that may show the object; near 1, the silhouettes say nothing."""
    covered = sum(int(table[-1, -1]) for _, table in silhouettes)
    return covered / sum(camera.width * camera.height for camera, _ in silhouettes)


def _carve(
    silhouettes: Sequence[Silhouette], box: FloatArray, resolution: int
) -> npt.NDArray[np.bool_]:
    size = (box[1] - box[0]) / resolution
    radius = 0.5 * norm(size)
    steps = [box[0, a] + (np.arange(resolution) + 0.5) * size[a] for a in range(3)]
    centres = np.stack(np.meshgrid(*steps, indexing="ij"), axis=-1).reshape(-1, 3)
    alive = np.ones(len(centres), dtype=np.bool_)
    seen = np.zeros(len(centres), dtype=np.int64)
    for camera, table in silhouettes:
        ids = np.flatnonzero(alive)
        pixels, depth = camera.project(centres[ids])
        shown = depth > radius
        shown &= (pixels > 0.0).all(axis=1)
        shown &= (pixels < [camera.width, camera.height]).all(axis=1)
        ids, pixels, depth = ids[shown], pixels[shown], depth[shown]
        reach = radius * max(camera.fx, camera.fy) / (depth - radius)
        low = np.floor(pixels - reach[:, None]).astype(np.int64).clip(min=0)
        high = np.ceil(pixels + reach[:, None]).astype(np.int64)
        right = high[:, 0].clip(max=camera.width)
        bottom = high[:, 1].clip(max=camera.height)
        left, top = low[:, 0], low[:, 1]
        covered = table[bottom, right] - table[top, right] - table[bottom, left] + table[top, left]
        seen[ids] += 1
        alive[ids[covered == 0]] = False
    return alive & (2 * seen >= len(silhouettes))
