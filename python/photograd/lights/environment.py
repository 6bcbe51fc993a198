"""Light from all around, and any other quantity, painted on a picture of all directions."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.errors import RangeError, message
from photograd.lights.base import Light
from photograd.types import Array


@typed_call
def about_y(angle: float) -> Array:
    """Rotation (3, 3) about +Y, counterclockwise seen against it, for `angle` in radians.

    As `world_from_map` it turns what the middle of the picture shows from +Z towards +X.
    """
    Arguments("about_y").number("angle", angle)
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


@typed_call
@dataclass(frozen=True, eq=False)
class EnvironmentMap(Light):
    """Radiance by direction, bilinear between texels, sampled towards its bright parts.

    The picture is twice as wide as high. Its upper edge is the zenith +Y, its middle shows +Z and
    its left and right edges -Z; it is seen from inside, so that -X is to the right of +Z.

    Attributes:
        texels: (H, 2 H, 3), float32 or float64, W/(m^2 sr), row 0 on top.
        world_from_map: rotation (3, 3), for example `about_y(angle)`.
        uniform_share: part of the samples that go everywhere alike, in [0, 1]. With 0, directions
            that are black are never sampled, and a fit would learn nothing about them.

    Raises:
        DtypeError: texels that are not float32 or float64.
        ShapeError: a picture that is not twice as wide as high, a rotation that is not (3, 3).
        RangeError: texels that are negative or not finite, a matrix that does more than rotate, a
            share outside of [0, 1].
    """

    texels: Array
    world_from_map: Array = field(default_factory=lambda: np.eye(3))
    uniform_share: float = 0.0

    def __post_init__(self) -> None:
        call = Arguments("EnvironmentMap")
        texels = call.array("texels", self.texels, ("H", "2 H", 3), finite=False)
        object.__setattr__(self, "texels", texels)
        object.__setattr__(self, "world_from_map", _rotation(call, self.world_from_map))
        sampler = call.run(_core.EnvironmentSampler, texels, float(self.uniform_share))
        object.__setattr__(self, "_sampler", sampler)

    def with_texels(self, texels: Array) -> EnvironmentMap:
        """The same map with other texels, sampled as before: for the steps of a fit.

        Estimates stay right as long as this map's density is not zero where the new one is bright,
        which a `uniform_share` above 0 sees to. Make a new map from time to time: samples go where
        light was when it was made.

        Raises:
            ShapeError, DtypeError: texels of another shape or dtype.
            RangeError: texels that are negative, above 1e30 or not finite.
        """
        call = Arguments("EnvironmentMap.with_texels", self.texels.dtype, convert=False)
        texels = call.array("texels", texels, self.texels.shape, low=0.0, high=1e30)
        other = object.__new__(EnvironmentMap)
        for name, value in {**vars(self), "texels": texels}.items():
            object.__setattr__(other, name, value)
        return other

    def core_call(self, dtype: npt.DTypeLike) -> tuple[Any, tuple[Array, ...]]:
        """The core's table of directions; texels (H, 2 H, 3) and the rotation."""
        return (
            vars(self)["_sampler"],
            (self.texels.astype(dtype, copy=False), self.world_from_map.astype(dtype)),
        )

    def named(self, derivative: Array) -> dict[str, Array]:
        """{"texels": (H, 2 H, 3)}."""
        return {"texels": derivative}


def _rotation(call: Arguments, matrix: Any) -> Array:
    """`world_from_map` in float64 if it is a rotation."""
    rotation = call.array("world_from_map", matrix, (3, 3), dtype=np.float64)
    fits = np.abs(rotation @ rotation.T - np.eye(3)).max() <= 1e-5
    if not fits or np.linalg.det(rotation) < 0.0:
        raise RangeError(message(call.function, "world_from_map", "a rotation", rotation))
    return rotation


# A quantity for every direction of the world, painted on a picture of all directions.


@dataclass(frozen=True, eq=False)
class DirectionMap:
    """Laid out as `EnvironmentMap`; what the numbers mean is for its maker to say.

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
        call = Arguments("DirectionMap", np.float64)
        values = call.array("values", self.values, ("H", "2 H", "C"), finite=False, min_length=1)
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "world_from_map", _rotation(call, self.world_from_map))

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
