"""A quantity for every direction of the world, painted on a picture of all directions."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from photograd.errors import ShapeError, message
from photograd.lights.environment import checked_rotation
from photograd.types import Array


@dataclass(frozen=True, eq=False)
class DirectionMap:
    """Laid out as `EnvironmentMap`; what the numbers mean says whoever makes one.

    Unlike there, rows go on beyond a pole on its other side, so that smooth quantities stay smooth.

    Attributes:
        values: (H, 2 H, C) float64, row 0 around +Y, middle columns around +Z.
        world_from_map: rotation (3, 3).

    Raises:
        ShapeError: values of another shape.
        RangeError: a matrix that does more than rotate.
    """

    values: Array
    world_from_map: Array = field(default_factory=lambda: np.eye(3))

    def __post_init__(self) -> None:
        values = np.asarray(self.values, np.float64)
        if values.ndim != 3 or values.shape[1] != 2 * values.shape[0] or not values.size:
            raise ShapeError(message("DirectionMap", "values", "shape (H, 2 H, C)", values.shape))
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "world_from_map", checked_rotation(self.world_from_map))

    def at(self, w: Array) -> Array:
        """Values (..., C) in directions w (..., 3) of the world, of any length; bilinear."""
        height, width = self.values.shape[:2]
        x, y, z = np.moveaxis(np.asarray(w, np.float64) @ self.world_from_map, -1, 0)
        column = (0.5 + np.arctan2(-x, z) / (2 * np.pi)) * width - 0.5
        row = np.arctan2(np.hypot(x, z), y) / np.pi * height - 0.5
        left, upper = np.floor(column).astype(np.intp), np.floor(row).astype(np.intp)
        across, down = (column - left)[..., None], (row - upper)[..., None]
        rows = [self._between(upper + i, left, across) for i in (0, 1)]
        return np.asarray(rows[0] + (rows[1] - rows[0]) * down)

    def _between(self, row: Array, left: Array, across: Array) -> Array:
        """Values of a row; beyond a pole it is the outermost one, seen from the other side."""
        height, width = self.values.shape[:2]
        beyond = (row < 0) | (row >= height)
        left = left + np.where(beyond, width // 2, 0)
        row = np.clip(row, 0, height - 1)
        first, second = self.values[row, left % width], self.values[row, (left + 1) % width]
        return np.asarray(first + (second - first) * across)


def cell_directions(height: int) -> Array:
    """Unit directions (H, 2 H, 3), in the map's frame, of the middles of its cells."""
    theta = (np.arange(height) + 0.5) / height * np.pi
    phi = ((np.arange(2 * height) + 0.5) / height - 1) * np.pi
    side = np.sin(theta)[:, None]
    up = np.broadcast_to(np.cos(theta)[:, None], (height, 2 * height))
    return np.stack([-side * np.sin(phi), up, side * np.cos(phi)], axis=-1)
