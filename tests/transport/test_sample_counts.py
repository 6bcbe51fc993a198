"""Derivatives whose paths go where the loss looks."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.transport import PathOptions, PathTracer
from photograd.transport.accumulation import MOST, UNIFORM_SHARE, sample_counts
from photograd.transport.builtin import cornell_box

from support.bits import same_bits

pytestmark = pytest.mark.usefixtures("core")
OPTIONS = PathOptions(max_depth=4, roulette_from=None)
SIZE, SPP = 12, 8


def few_bright(seed: int = 3) -> Any:
    """A cotangent of which four pixels hold most, as a loss of squares gives for a light."""
    d = np.random.default_rng(seed).uniform(0.5, 1, (SIZE, SIZE, 3)) / 50
    d[5, 2:6] *= 1000
    return d


def test_counts_follow_the_cotangent() -> None:
    d = few_bright()
    counts = sample_counts(d, SPP, "cotangent")
    assert counts is not None
    assert counts.min() >= 1
    assert abs(int(counts.sum()) - SPP * SIZE**2) <= SIZE**2 / 2  # the rounding of each
    assert counts[5, 2:6].min() > 10 * SPP
    assert counts[6:].max() < SPP
    one = np.zeros((SIZE, SIZE, 3))
    one[1, 1] = -2.0
    counts = sample_counts(one, SPP, "cotangent")
    assert counts is not None
    assert counts[1, 1] == MOST * SPP
    assert (np.delete(counts.ravel(), SIZE + 1) == UNIFORM_SHARE * SPP).all()
    assert sample_counts(d, SPP, "uniform") is None
    assert sample_counts(np.zeros_like(d), SPP, "cotangent") is None
    with pytest.raises(RangeError, match=r"spread: expected .*uniform.*cotangent"):
        sample_counts(d, SPP, "steep")


def test_each_pixel_is_the_mean_of_its_own_paths() -> None:
    # Pixels with equal counts are those of an even derivative with that many paths.
    tracer, d = PathTracer(cornell_box(SIZE), dtype=np.float64), few_bright()
    found = tracer.render_backward(d, spp=SPP, seed=2, options=OPTIONS, spread="cotangent")
    counts = sample_counts(d, SPP, "cotangent")
    assert counts is not None
    sums = {name: np.zeros_like(value) for name, value in found.items()}
    for count in np.unique(counts):
        part = tracer.render_backward(
            d * (counts == count)[..., None], spp=int(count), seed=2, options=OPTIONS
        )
        for name, value in part.items():
            sums[name] += value
    for name, value in found.items():
        scale = np.abs(sums[name]).max()
        assert scale > 0
        np.testing.assert_allclose(value, sums[name], rtol=1e-9, atol=1e-12 * scale)


def test_the_mean_stays_and_noise_falls() -> None:
    tracer, d = PathTracer(cornell_box(SIZE)), few_bright()

    def estimates(spread: str, first: int) -> Any:
        return np.array(
            [
                tracer.render_backward(d, spp=SPP, seed=first + k, options=OPTIONS, spread=spread)[
                    "materials.white.albedo"
                ].sum()
                for k in range(100)
            ]
        )

    even, focused = estimates("uniform", 0), estimates("cotangent", 1000)
    error = np.sqrt((even.var() + focused.var()) / 100)
    assert abs(even.mean() - focused.mean()) < 4 * error
    assert 10 * error < abs(even.mean())  # so that the line above says something
    # Measured: 23 times.
    assert even.var() > 2 * focused.var()


@same_bits("samples where the cotangent is")
def gradients_of_spread_samples() -> list[Any]:
    tracer = PathTracer(cornell_box(SIZE))
    gradient = tracer.render_backward(
        few_bright(), spp=SPP, seed=9, options=OPTIONS, spread="cotangent"
    )
    return list(gradient.values())
