"""One thread and many, every instruction set: the same bits."""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
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

from support.instruction_sets import assert_same_bits
from tests.texture.oracle import noise, points


def everything(dtype: Any) -> list[Any]:
    """Results of all functions, of more points than two pieces of the parallel sort hold."""
    texture = noise((75, 90, 3), 1).astype(dtype)
    uv, d_color = points(140_000, 2).astype(dtype), noise((140_000, 3), 3).astype(dtype)
    level = mip_level((75, 90), 0.2 * noise((140_000, 2, 2), 4).astype(dtype))
    mips = build_mips(texture)
    d_mips, *d_places = sample_mips_backward(mips, uv, level, d_color)
    loss, gradient = loss_and_gradient(texture, uv, d_color)
    return [
        sample(texture, uv),
        *sample_backward(texture, uv, d_color),
        level,
        *mips,
        sample_mips(mips, uv, level),
        *d_mips,
        *d_places,
        build_mips_backward(d_mips),
        np.array(loss),
        gradient,
    ]


def digests() -> list[str]:
    """One a result."""
    results = everything(np.float32) + everything(np.float64)
    return [hashlib.sha256(result.tobytes()).hexdigest() for result in results]


def test_thread_count_changes_nothing() -> None:
    seen = []
    for threads in (1, 2, 5):
        _core.set_thread_count(threads)
        seen.append(digests())
    _core.set_thread_count(0)
    assert len(set(seen[0])) == len(seen[0])  # no result is empty or another's
    assert seen[0] == seen[1] == seen[2]


@pytest.mark.slow
def test_every_instruction_set_gives_the_same_bits() -> None:
    assert_same_bits("from tests.texture.test_texture_bits import digests; print(*digests())")
