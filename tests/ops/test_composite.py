"""Compositing of premultiplied colors: any bracketing gives the core's sum, any order does not."""

from __future__ import annotations

from functools import reduce
from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core

pytestmark = pytest.mark.usefixtures("core")
SAMPLES, DT = 32, 0.13
G = np.random.default_rng(7)
SIGMA_T, RGB, BEHIND = G.uniform(0.05, 2, SAMPLES), G.random((SAMPLES, 3)), G.random(3)


def over(front: Any, back: Any) -> Any:
    """(4,) premultiplied color and alpha of one thing before another."""
    return front + (1 - front[3]) * back


def fragments() -> list[Any]:
    """Each sample's premultiplied color and alpha, front to back, and the opaque background."""
    alpha = 1 - np.exp(-SIGMA_T * DT)
    parts = np.concatenate([alpha[:, None] * RGB, alpha[:, None]], axis=1)
    return [*parts, np.append(BEHIND, 1.0)]


def bracketed(parts: list[Any], seed: int) -> Any:
    """Neighbors joined in an order of chance."""
    g, parts = np.random.default_rng(seed), list(parts)
    while len(parts) > 1:
        k = int(g.integers(len(parts) - 1))
        parts[k : k + 2] = [over(parts[k], parts[k + 1])]
    return parts[0]


@pytest.mark.parametrize(("dtype", "tolerance"), [(np.float32, 1e-6), (np.float64, 1e-13)])
def test_any_bracketing_is_the_cores_sum(dtype: Any, tolerance: float) -> None:
    packed = np.concatenate([SIGMA_T, RGB.ravel(), BEHIND]).astype(dtype)
    core = _core.ops["composite"].forward(packed)
    parts = fragments()
    front_to_back = reduce(over, parts)
    for seed in range(20):
        np.testing.assert_allclose(bracketed(parts, seed), front_to_back, rtol=1e-13)
    np.testing.assert_allclose(core[:3], front_to_back[:3], rtol=tolerance)
    # Its opacity is that of the samples, without what lies behind.
    assert core[3] == pytest.approx(reduce(over, parts[:-1])[3], rel=tolerance)


def test_order_and_premultiplication_matter() -> None:
    parts = fragments()
    right = reduce(over, parts)
    assert np.abs(reduce(over, [*parts[-2::-1], parts[-1]]) - right).max() > 0.01
    # Colors that are not premultiplied depend on the bracketing.
    plain = [np.append(part[:3] / part[3], part[3]) for part in parts]

    def mixed(front: Any, back: Any) -> Any:
        alpha = front[3] + (1 - front[3]) * back[3]
        return np.append(front[3] * front[:3] + (1 - front[3]) * back[:3], alpha)

    left = mixed(mixed(plain[0], plain[1]), plain[2])
    other = mixed(plain[0], mixed(plain[1], plain[2]))
    assert np.abs(left - other).max() > 0.01
