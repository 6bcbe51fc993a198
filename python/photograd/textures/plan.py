"""The loss of a texture against colours at points, and its gradient, as often as wanted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from photograd._compiled import _core
from photograd.errors import ShapeError, message
from photograd.textures.sample import float_array
from photograd.types import Array


class TexturePlan:
    """Points of a texture sorted by tile, with the colours that they should have.

    Sorting costs as much as several gradients; after that every lookup finds its texels in the
    first-level cache. The points and colours are copied: changing the arrays later has no effect.

    Attributes:
        shape: (H, W, C) of the textures that the plan is for.
    """

    def __init__(self, uv: Array, colors: Array, shape: Sequence[int]) -> None:
        """Sort points uv (N, 2) with colours (N, C) for textures of shape (H, W).

        Raises:
            DtypeError, ShapeError: arrays of other or different types or shapes.
            RangeError: no point, or texture coordinates that are not finite.
        """
        uv = float_array("TexturePlan", "uv", uv)
        colors = float_array("TexturePlan", "colors", colors)
        if len(shape) != 2:
            raise ShapeError(message("TexturePlan", "shape", "(H, W)", tuple(shape)))
        height, width = (int(size) for size in shape)
        self._core = _core.TexturePlan(height, width, uv, colors)
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
        texture = float_array("loss_and_gradient", "texture", texture)
        gradient = np.zeros_like(texture) if out is None else out
        if out is not None:
            gradient.fill(0)
        return self._core.loss_and_gradient(texture, gradient), gradient


def loss_and_gradient(texture: Array, uv: Array, colors: Array) -> tuple[float, Array]:
    """L = mean over points and channels of (T(uv) - color)^2, and dL/dT (H, W, C), once.

    For many steps with the same points and colours, make a `TexturePlan` of them: sorting them is
    most of the work of this function.

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other or different types or shapes, or texture
            coordinates that are not finite.
    """
    texture = float_array("loss_and_gradient", "texture", texture)
    if texture.ndim != 3:
        raise ShapeError(message("loss_and_gradient", "texture", "shape (H, W, C)", texture.shape))
    return TexturePlan(uv, colors, texture.shape[:2]).loss_and_gradient(texture)
