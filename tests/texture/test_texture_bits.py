"""Results of all functions of textures, in float and double, for the test of bits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.textures import (
    build_mips,
    build_mips_backward,
    loss_and_gradient,
    mip_level,
    sample,
    sample_backward,
    sample_mips,
    sample_mips_backward,
)

from support.bits import same_bits
from tests.texture.oracle import noise, points


@same_bits("textures", each=("float32", "float64"), kernels=("sample_rgb",))
def everything(name: str) -> list[Any]:
    """Results of all functions, of more points than two pieces of the parallel sort hold."""
    dtype = np.dtype(name)
    texture = noise((75, 90, 3), 1).astype(dtype)
    uv, d_color = points(140_000, 2).astype(dtype), noise((140_000, 3), 3).astype(dtype)
    level = mip_level((75, 90), 0.5 * noise((140_000, 2, 2), 4).astype(dtype))
    mips = build_mips(texture)
    d_mips, *d_places = sample_mips_backward(mips, uv, level, d_color)
    loss, gradient = loss_and_gradient(texture, uv, d_color)
    return [
        sample(texture, uv),
        *sample_backward(texture, uv, d_color),
        level,
        *mips[1:],  # the first is the texture
        sample_mips(mips, uv, level),
        *d_mips,
        *d_places,
        build_mips_backward(d_mips),
        np.array(loss),
        gradient,
    ]


@pytest.mark.parametrize("name", ["float32", "float64"])
def test_no_result_is_another_one(name: str) -> None:
    results = [result.tobytes() for result in everything(name)]
    assert len(set(results)) == len(results)
