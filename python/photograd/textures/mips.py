"""Mip maps: a texture and its averages over ever larger squares, and lookups between them.

A mip map is a list of arrays (H, W, C), level 0 the texture itself, each next level half as high
and wide, rounded down, and at least one texel. Texels of the next level are means over the area
that they cover, also where the size is odd (cpp/photograd/texture/mip_chain.h).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.textures.sample import TEXTURE
from photograd.types import Array

LN_2 = 0.6931471805599453


@typed_call
def build_mips(texture: Array) -> list[Array]:
    """All levels of a texture (H, W, C), down to a single texel; level 0 is `texture` itself.

    Raises:
        DtypeError, ShapeError, RangeError: no such texture.
    """
    mips = [Arguments("build_mips").array("texture", texture, TEXTURE, finite=False)]
    height, width, channels = mips[0].shape
    for shape in _core.mip_shapes(height, width)[1:]:
        mips.append(np.empty((*shape, channels), mips[0].dtype))
    _core.build_mips(mips)
    return mips


@typed_call
def build_mips_backward(d_mips: Sequence[Array]) -> Array:
    """dL/dtexture (H, W, C) for dL/dlevel of every level, as `sample_mips_backward` gives them.

    Raises:
        DtypeError, ShapeError, RangeError: arrays that are no mip map.
    """
    levels = _levels(Arguments("build_mips_backward"), "d_mips", d_mips)
    copies = [level.copy() for level in levels]
    _core.build_mips_backward(copies)
    return copies[0]


@typed_call
def mip_level(shape: Sequence[int], footprint: Array) -> Array:
    """The level (N,) whose texels are as large as the longer side of each footprint.

    Args:
        shape: (H, W, ...) of level 0.
        footprint: (N, 2, 2), footprint[:, 0] = (du/dx, dv/dx) and footprint[:, 1] = (du/dy, dv/dy),
            derivatives of the texture coordinates along the picture's axes, in pixels.

    Returns:
        (N,) log2 of the longer side in texels, 0 for footprints smaller than one. It is not limited
        to the levels that there are; `sample_mips` does that.

    Raises:
        DtypeError, ShapeError, RangeError: other arrays, or numbers that are not finite.
    """
    call = Arguments("mip_level")
    footprint = call.array("footprint", footprint, ("N", 2, 2), finite=False)
    height, width = call.size("shape", tuple(shape)[:2])
    level: Array = _core.mip_level(height, width, footprint)
    return level


@typed_call
def mip_level_backward(shape: Sequence[int], footprint: Array, d_level: Array) -> Array:
    """The adjoint of `mip_level`: with r^2 the square of the longer side, level = log2(r^2) / 2.

    Args:
        shape, footprint: as for `mip_level`.
        d_level: (N,) dL/d of what it returned.

    Returns:
        dL/dfootprint (N, 2, 2), zero for the shorter side, and where the level is 0.

    Raises:
        DtypeError, ShapeError, RangeError: as for `mip_level`.
    """
    call = Arguments("mip_level_backward")
    footprint = call.array("footprint", footprint, ("N", 2, 2))
    d_level = call.array("d_level", d_level, ("N",))
    height, width = call.size("shape", tuple(shape)[:2])
    texels = np.array([width, height], footprint.dtype)
    square = np.square(footprint * texels).sum(axis=2)
    longer = square.argmax(axis=1)
    rows = np.arange(len(footprint))
    r2 = square[rows, longer]
    scale = np.where(r2 > 1, d_level / (LN_2 * np.maximum(r2, 1)), 0)
    d_footprint = np.zeros_like(footprint)
    d_footprint[rows, longer] = scale[:, None] * footprint[rows, longer] * np.square(texels)
    return d_footprint


@typed_call
def sample_mips(mips: Sequence[Array], uv: Array, level: Array) -> Array:
    """Look up points (N, 2) at levels (N,): bilinear in two levels, linear between them.

    Levels are limited to those that there are. Returns (N, C).

    Raises:
        DtypeError, ShapeError, RangeError: no mip map, arrays that do not fit it, or points or
            levels that are not finite.
    """
    call = Arguments("sample_mips")
    levels = _levels(call, "mips", mips)
    uv = call.array("uv", uv, ("N", 2), finite=False)
    level = call.array("level", level, ("N",), finite=False)
    out = np.empty((len(uv), levels[0].shape[2] if levels else 0), uv.dtype)
    _core.sample_mips(levels, uv, level, out)
    return out


@typed_call
def sample_mips_backward(
    mips: Sequence[Array], uv: Array, level: Array, d_color: Array
) -> tuple[list[Array], Array, Array]:
    """The adjoint of `sample_mips`.

    Returns:
        dL/dlevel of every level of the mip map, dL/duv (N, 2), and dL/dlevel (N,), zero where the
        level is limited. `build_mips_backward` carries the first on to the texture.

    Raises:
        DtypeError, ShapeError, RangeError: as for `sample_mips`.
    """
    call = Arguments("sample_mips_backward")
    levels = _levels(call, "mips", mips)
    uv = call.array("uv", uv, ("N", 2), finite=False)
    level = call.array("level", level, ("N",), finite=False)
    d_mips = [np.zeros_like(part) for part in levels]
    d_uv, d_level = np.zeros_like(uv), np.zeros_like(level)
    d_color = call.array("d_color", d_color, ("N", "C"), finite=False)
    _core.sample_mips_backward(levels, uv, level, d_color, d_mips, d_uv, d_level)
    return d_mips, d_uv, d_level


def _levels(call: Arguments, name: str, levels: Sequence[Array]) -> list[Array]:
    """Levels (H, W, C), each of its own size, in the dtype of the call."""
    found = []
    for k, level in enumerate(levels):
        alone = Arguments(call.function, call.dtype, convert=False)
        found.append(alone.array(f"{name}[{k}]", level, TEXTURE, finite=False))
        call.dtype = alone.dtype
    return found
