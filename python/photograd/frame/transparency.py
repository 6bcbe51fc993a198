"""Surfaces that cover a part of what is behind them, blended over the opaque ones.

Exactly, nearest first, in the order that depth peeling finds [Everitt2001]; shape by shape, the
farthest center first, as engines sort what they draw; or in any order with weights that fall with
depth [McGuire2013]. Colors are linear radiance, and are multiplied by alpha once, here.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.errors import DtypeError, ShapeError, message
from photograd.types import Array


@typed_call
@dataclass(frozen=True, eq=False)
class Layer:
    """Surfaces of which each pixel shows one at most.

    Attributes:
        depth: (H, W) along the camera's axis, meters; infinite where there is none.
        color: (H, W, 3) radiance, not multiplied by alpha.
        alpha: (H, W) the part of what is behind that is covered; 0 where there is none.
    """

    depth: Array
    color: Array
    alpha: Array


@typed_call
def blend_nearest_first(layers: Iterable[Layer], behind: Array) -> Array:
    """Layers over an opaque picture; exact where each lies behind the one before it.

    Args:
        layers: the nearest first.
        behind: (H, W, 3) radiance.
    """
    call = Arguments("blend_nearest_first")
    behind = call.array("behind", behind, ("H", "W", 3), finite=False)
    color, clear = np.zeros_like(behind), np.ones((*behind.shape[:2], 1), behind.dtype)
    for layer in layers:
        _check_layer(call.function, layer, behind)
        part = clear * layer.alpha[..., None]
        color, clear = color + part * layer.color, clear - part
    out: Array = color + clear * behind
    return out


@typed_call
def blend_weighted(layers: Iterable[Layer], behind: Array, scale: float) -> Array:
    """Layers over an opaque picture, the same in any order [McGuire2013].

    With w = alpha / (1e-3 + (depth / scale)^4): the mean of the colors, weighted with w, covers
    what all layers together cover, 1 - prod (1 - alpha). One layer is blended exactly.

    Args:
        layers: in any order.
        behind: (H, W, 3) radiance.
        scale: meters; where weights begin to fall.
    """
    call = Arguments("blend_weighted")
    behind = call.array("behind", behind, ("H", "W", 3), finite=False)
    call.number("scale", scale, above=0)
    dtype = behind.dtype.type
    color, total = np.zeros_like(behind), np.zeros((*behind.shape[:2], 1), behind.dtype)
    clear = np.ones_like(total)
    for layer in layers:
        _check_layer(call.function, layer, behind)
        alpha = layer.alpha[..., None]
        far = np.where(layer.alpha > 0, layer.depth, 0).astype(behind.dtype)[..., None]
        far = far / dtype(scale)
        weight = alpha / (dtype(1e-3) + far * far * far * far)
        color, total, clear = color + weight * layer.color, total + weight, clear * (1 - alpha)
    mean = color / np.maximum(total, np.finfo(behind.dtype).tiny)
    out: Array = mean * (1 - clear) + clear * behind
    return out


def _check_layer(function: str, layer: object, behind: Array) -> None:
    """Raise DtypeError or ShapeError for a layer that does not lie over a picture."""
    if not isinstance(layer, Layer):
        raise DtypeError(message(function, "layers", "a Layer each", type(layer).__name__))
    size = behind.shape[:2]
    for name, shape in (("depth", size), ("color", behind.shape), ("alpha", size)):
        found = np.shape(getattr(layer, name))
        if found != shape:
            raise ShapeError(message(function, f"{name} of layers", f"shape {shape}", found))
