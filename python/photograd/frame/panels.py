"""Buffers of a frame as pictures, for `photograd frame --show`."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from photograd_course.color import srgb_encode

from photograd.errors import RangeError, message
from photograd.frame.gbuffer import GBuffer
from photograd.frame.graph import FrameResult
from photograd.frame.lighting import Shadows
from photograd.raster import Visibility
from photograd.types import Array

PANELS = (
    *("visibility", "gbuffer", "shadows", "occlusion", "direct", "sky_light", "gathered"),
    *("background", "opaque", "layered", "fogged", "focused", "radiance", "bloom", "lens"),
    *("toned", "smoothed", "display"),
)
"""Buffers that can be shown."""
COLORS = np.array(
    [
        *([230, 159, 0], [86, 180, 233], [0, 158, 115], [240, 228, 66]),
        *([0, 114, 178], [213, 94, 0], [204, 121, 167], [150, 150, 150]),
    ]
)
"""Of numbers: a palette that people with any color vision can tell apart [Okabe2008]."""


def panels(result: FrameResult, name: str) -> dict[str, Array]:
    """Pictures {title: (H, W, 3)} of a buffer, display-encoded, 0 to 1.

    Args:
        result: of a frame.
        name: one of `PANELS`.

    Raises:
        RangeError: another name, or a buffer that was not made.
    """
    if name not in PANELS:
        raise RangeError(message("panels", "name", f"one of {', '.join(PANELS)}", name))
    buffer = result[name]
    makers: Mapping[type, Callable[..., dict[str, Array]]] = {
        Visibility: _visibility,
        GBuffer: _gbuffer,
        dict: _shadows,
    }
    if type(buffer) in makers:
        return makers[type(buffer)](buffer)
    if buffer.ndim == 2:
        return {name: _gray(buffer)}
    return {name: _encoded(buffer)}


def _visibility(buffer: Visibility) -> dict[str, Array]:
    most = max(int(buffer.overdraw.max()), 1)
    return {
        "face": _numbers(buffer.face),
        "depth": _depth(buffer.depth),
        "overdraw": _gray(buffer.overdraw / most),
    }


def _gbuffer(buffer: GBuffer) -> dict[str, Array]:
    found = {
        "depth": _depth(buffer.depth),
        "material": _numbers(buffer.material),
        "normal": _direction(buffer.normal, buffer.covered),
        "shading normal": _direction(buffer.shading, buffer.covered),
        "emission": _encoded(buffer.emission),
        "alpha": _gray(buffer.alpha),
    }
    if buffer.rows.shape[2] >= 3:
        found["first parameters"] = _encoded(buffer.rows[..., :3])
    return found


def _shadows(buffer: Shadows) -> dict[str, Array]:
    return {
        f"{name}, view {number}": _depth(depth)
        for name, shadow in buffer.items()
        for number, depth in enumerate(shadow.depths)
    }


def _encoded(picture: Array) -> Array:
    return srgb_encode(np.clip(picture, 0.0, 1.0))


def _gray(values: Array) -> Array:
    return np.repeat(np.clip(values, 0.0, 1.0)[..., None], 3, axis=-1)


def _direction(vectors: Array, covered: Array) -> Array:
    return np.where(covered[..., None], 0.5 + 0.5 * vectors, 0.0)


def _numbers(numbers: Array) -> Array:
    colors = COLORS[np.maximum(numbers, 0) % len(COLORS)] / 255.0
    return np.where((numbers >= 0)[..., None], colors, 0.0)


def _depth(depth: Array) -> Array:
    """Near is bright, by the logarithm; nothing is black."""
    visible = np.isfinite(depth)
    if not visible.any():
        return np.zeros((*depth.shape, 3))
    low, high = depth[visible].min(), depth[visible].max()
    stops = np.log(np.where(visible, depth, low) / low)
    bright = 1.0 - 0.85 * stops / (np.log(high / low) or 1.0)
    return _gray(np.where(visible, bright, 0.0))
