"""A picture to be recovered from samples of it: texels T[row, column], bilinear in between.

Texel (row, column) has its centre at ((column + 0.5) / W, (row + 0.5) / H) of the canvas, v points
down, and outside of the outermost centres the border value continues (clamp). With f, g the
fractions along column and row,

    value = (1 - g) ((1 - f) T00 + f T01) + g ((1 - f) T10 + f T11)

    dT00 = (1 - g)(1 - f) d_value, and so on: the four weights of the lookup
    dx   = W ((1 - g)(T01 - T00) + g (T11 - T10)) . d_value,  0 where x is clamped
    dy   = H ((1 - f)(T10 - T00) + f (T11 - T01)) . d_value,  0 where y is clamped

The value is linear in T. In the point it has kinks at texel centres, where the right side counts.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from photograd_course.random import uniform

from photograd.errors import DtypeError, ShapeError, message
from photograd.representation import (
    Array,
    CanvasBatch,
    Outputs,
    ParamSpec,
    RenderOptions,
    Representation,
    register,
)


@dataclass(frozen=True)
class _Corners:
    """For each point: flat texel numbers (4, N), weights (4, N), fractions and clamped axes."""

    index: NDArray[np.int64]
    weight: Array
    fraction: tuple[Array, Array]  # along column, along row
    inside: tuple[NDArray[np.bool_], NDArray[np.bool_]]


def bilinear(texture: Array, points: Array) -> Array:
    """Look up points (N, 2) of the canvas, x right and y down in [0, 1], in a texture (H, W, C).

    Returns (N, C). Points outside of the canvas get the border's value.
    """
    corners = _corners(texture, points)
    texels = texture.reshape(-1, texture.shape[2])[corners.index]
    value: Array = (corners.weight[..., None] * texels).sum(axis=0)
    return value


def bilinear_backward(texture: Array, points: Array, d_value: Array) -> tuple[Array, Array]:
    """dL/d texture (H, W, C) and dL/d points (N, 2) for dL/d value (N, C).

    Each texel adds up its contributions in the order of the points, in double precision.
    """
    corners = _corners(texture, points)
    height, width, channels = texture.shape
    d_texture = np.empty_like(texture)
    for channel in range(channels):
        share = corners.weight * d_value[:, channel]
        total = np.bincount(corners.index.ravel(), share.ravel(), minlength=height * width)
        d_texture[..., channel] = total.reshape(height, width)
    texels = texture.reshape(-1, channels)[corners.index]
    t00, t01, t10, t11 = (np.einsum("nc,nc->n", texel, d_value) for texel in texels)
    f, g = corners.fraction
    d_x = width * ((1 - g) * (t01 - t00) + g * (t11 - t10))
    d_y = height * ((1 - f) * (t10 - t00) + f * (t11 - t01))
    d_points = np.stack([d_x * corners.inside[0], d_y * corners.inside[1]], axis=-1)
    return d_texture, d_points.astype(points.dtype, copy=False)


def _corners(texture: Array, points: Array) -> _Corners:
    height, width = texture.shape[:2]
    column, f, inside_x = _cell(points[:, 0], width)
    row, g, inside_y = _cell(points[:, 1], height)
    right, below = np.minimum(column + 1, width - 1), np.minimum(row + 1, height - 1)
    index = np.stack(
        [row * width + column, row * width + right, below * width + column, below * width + right]
    )
    weight = np.stack([(1 - g) * (1 - f), (1 - g) * f, g * (1 - f), g * f])
    return _Corners(index, weight, (f, g), (inside_x, inside_y))


def _cell(x: Array, size: int) -> tuple[NDArray[np.int64], Array, NDArray[np.bool_]]:
    """First texel centre at or before x, the fraction to the next, and whether x is not clamped."""
    raw = x * size - x.dtype.type(0.5)
    position = np.clip(raw, 0, size - 1)
    first = np.minimum(position.astype(np.int64), max(size - 2, 0))
    return first, (position - first).astype(x.dtype), (raw >= 0) & (raw < size - 1)


@dataclass(frozen=True)
class CanvasContext:
    """What the backward pass of a canvas needs: its parameters and points, as they were."""

    params: dict[str, Array]
    points: Array
    camera_adjoint: bool


@register
class Texture2D(Representation):
    """params["texels"] (H, W, 3): linear colour of each texel, itself the value at its centre."""

    name: ClassVar[str] = "texture_2d"
    capabilities: ClassVar[frozenset[str]] = frozenset({"canvas2d"})

    def __init__(self, texels: Array) -> None:
        """Raises ShapeError unless texels is (H, W, 3), DtypeError unless it is a float array."""
        if texels.ndim != 3 or texels.shape[2] != 3 or texels.size == 0:
            raise ShapeError(message("Texture2D", "texels", "shape (H, W, 3)", f"{texels.shape}"))
        if texels.dtype not in (np.dtype(np.float32), np.dtype(np.float64)):
            raise DtypeError(
                message("Texture2D", "texels", "float32 or float64", f"{texels.dtype}")
            )
        self.params = {"texels": np.ascontiguousarray(texels)}

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Texture2D:
        """5 rows of 7 random texels."""
        texels = uniform(seed, step=0, pixel=np.arange(5 * 7 * 3), sample=0, dimension=0)
        return cls(texels.reshape(5, 7, 3).astype(dtype))

    def example_batch(self, *, seed: int) -> CanvasBatch:
        """60 points all over the canvas, a few of them beyond the outermost texel centres."""
        index = np.arange(60)
        points = [uniform(seed, step=1, pixel=index, sample=0, dimension=k) for k in range(2)]
        return CanvasBatch(np.stack(points, axis=-1))

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """One group."""
        return {"texels": ParamSpec(self.params["texels"].shape, "1", (0.0, 1.0), 0.02, "canvas")}

    def render(
        self, batch: CanvasBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, CanvasContext]:
        """Colour (N, 3) at the points; a canvas has neither opacity nor depth."""
        del seed, step  # nothing random here
        texels = self.params["texels"]
        points = np.asarray(batch.points, texels.dtype)
        context = CanvasContext(dict(self.params), points, options.camera_adjoint)
        return Outputs(bilinear(texels, points)), context

    def render_backward(self, context: CanvasContext, d_outputs: Outputs) -> dict[str, Array]:
        """{"texels": (H, W, 3)}, and "points" (N, 2) if the options asked."""
        texels = context.params["texels"]
        d_color = np.asarray(d_outputs.color, texels.dtype)
        d_texels, d_points = bilinear_backward(texels, context.points, d_color)
        return {"texels": d_texels} | ({"points": d_points} if context.camera_adjoint else {})
