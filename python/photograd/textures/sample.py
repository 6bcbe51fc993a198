"""Bilinear lookups in a texture, and the loss of a texture against colors at points."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.types import Array

TEXTURE = ("H", "W", "C")


@typed_call
def sample(texture: Array, uv: Array, *, out: Array | None = None) -> Array:
    """Look up points of a texture.

    Args:
        texture: (H, W, C).
        uv: (N, 2) texture coordinates of the same dtype.
        out: (N, C) to write to and return, of unknown content after an error; fresh memory for
            millions of points costs as much as their lookup.

    Returns:
        (N, C), the same bits on any number of threads.

    Raises:
        DtypeError, ShapeError: arrays of other or different types or shapes.
        RangeError: texture coordinates that are not finite, counted; no texel, or more than four
            channels.
    """
    call = Arguments("sample")
    texture = call.array("texture", texture, TEXTURE, finite=False)
    uv = call.array("uv", uv, ("N", 2), finite=False)
    if out is None:
        out = np.empty((len(uv), texture.shape[-1]), texture.dtype)
    _core.sample(texture, uv, out)
    return out


@typed_call
def sample_backward(texture: Array, uv: Array, d_color: Array) -> tuple[Array, Array]:
    """The adjoint of `sample`.

    Args:
        texture, uv: as for `sample`.
        d_color: (N, C) dL/dcolor.

    Returns:
        dL/dtexture (H, W, C), every texel's contributions added in one order whatever the number
        of threads, and dL/duv (N, 2), zero along an axis where the point is clamped to the border.
        At a texel center, where the color has a kink, it is the derivative towards growing uv.

    Raises:
        DtypeError, ShapeError, RangeError: as for `sample`.
    """
    call = Arguments("sample_backward")
    texture = call.array("texture", texture, TEXTURE, finite=False)
    uv = call.array("uv", uv, ("N", 2), finite=False)
    d_color = call.array("d_color", d_color, ("N", "C"), finite=False)
    d_texture, d_uv = np.zeros_like(texture), np.zeros_like(uv)
    _core.sample_backward(texture, uv, d_color, d_texture, d_uv)
    return d_texture, d_uv


# The loss of a texture against colors at points, and its gradient, as often as wanted.


@typed_call
class TexturePlan:
    """Points of a texture sorted by tile, with the colors that they should have.

    Sorting costs as much as several gradients; after that every lookup finds its texels in the
    first-level cache. The points and colors are copied: changing the arrays later has no effect.

    Attributes:
        shape: (H, W, C) of the textures that the plan is for.
    """

    def __init__(self, uv: Array, colors: Array, shape: Sequence[int]) -> None:
        """Sort points uv (N, 2) with colors (N, C) for textures of shape (H, W).

        Raises:
            DtypeError, ShapeError: arrays of other or different types or shapes.
            RangeError: no point, or texture coordinates that are not finite.
        """
        call = Arguments("TexturePlan")
        uv = call.array("uv", uv, ("N", 2), finite=False)
        colors = call.array("colors", colors, ("N", "C"), finite=False)
        height, width = call.array("shape", shape, (2,), dtype=np.int64).tolist()
        self._core = call.run(_core.TexturePlan, height, width, uv, colors)
        self.shape = (height, width, colors.shape[1])

    def loss_and_gradient(self, texture: Array, *, out: Array | None = None) -> tuple[float, Array]:
        """L = mean over points and channels of (T(uv) - color)^2, and dL/dT (H, W, C).

        The same bits on any number of threads.

        Args:
            texture: (H, W, C) of the dtype of the plan's points.
            out: an array for the gradient, which is cleared first.

        Raises:
            DtypeError, ShapeError, RangeError: not the texture that the plan was made for.
        """
        call = Arguments("TexturePlan.loss_and_gradient")
        texture = call.array("texture", texture, TEXTURE, finite=False)
        gradient = np.zeros_like(texture) if out is None else out
        if out is not None:
            gradient.fill(0)
        return call.run(self._core.loss_and_gradient, texture, gradient), gradient


@typed_call
def loss_and_gradient(texture: Array, uv: Array, colors: Array) -> tuple[float, Array]:
    """L = mean over points and channels of (T(uv) - color)^2, and dL/dT (H, W, C), once.

    For many steps with the same points and colors, make a `TexturePlan` of them: sorting them is
    most of the work of this function.

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other or different types or shapes, or texture
            coordinates that are not finite.
    """
    texture = Arguments("loss_and_gradient").array("texture", texture, TEXTURE, finite=False)
    return TexturePlan(uv, colors, texture.shape[:2]).loss_and_gradient(texture)
