"""The two samplers of the path tracer: they agree on average, and Sobol points have less error."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.transport import PathOptions, PathTracer
from photograd.transport.builtin import cornell_box

from support.bits import same_bits
from tests.transport.scenes import any_material, stage

pytestmark = pytest.mark.usefixtures("core")

SEEDS = 24


def test_sobol_points_keep_the_mean_and_err_less() -> None:
    # Pictures of 16 samples with seeds of their own are independent, whatever their samples are.
    tracer = PathTracer(stage(any_material("gltf"), size=12, sky=0.3))
    found = {}
    for sampler in ("sobol", "independent"):
        options = PathOptions(max_depth=4, roulette_from=2, sampler=sampler)
        found[sampler] = np.array(
            [tracer.render(spp=16, seed=seed, options=options).mean for seed in range(SEEDS)]
        )
    sobol, other = found["sobol"], found["independent"]
    assert sobol.mean() > 0.1
    variance = {name: pictures.var(axis=0, ddof=1) for name, pictures in found.items()}
    z = (sobol.mean(axis=(0, 1, 2)) - other.mean(axis=(0, 1, 2))) / np.sqrt(
        (variance["sobol"] + variance["independent"]).sum(axis=(0, 1)) / SEEDS / 12**4
    )
    # The three channels go together: one false alarm in 10 000 seeds.
    assert np.abs(z).max() < 3.9
    # A bias of two percent would be seen.
    spread = np.sqrt((variance["sobol"] + variance["independent"]).sum() / 3 / SEEDS / 12**4)
    assert 3.9 * spread < 0.02 * sobol.mean()
    assert variance["sobol"].mean() < 0.5 * variance["independent"].mean()  # 0.35


def test_the_spread_of_samples_is_not_the_error_of_sobol_points() -> None:
    tracer = PathTracer(cornell_box(12))
    options = PathOptions(max_depth=2)
    pictures = [tracer.render(spp=64, seed=seed, options=options) for seed in range(SEEDS)]
    error = np.sqrt(np.var([p.mean for p in pictures], axis=0, ddof=1).mean())
    claimed = np.sqrt(np.mean([p.standard_error**2 for p in pictures]))
    assert 0 < error < 0.6 * claimed


@same_bits("Sobol samples in two passes")
def in_two_passes() -> list[Any]:
    tracer = PathTracer(cornell_box(8))
    sums = tracer.render(spp=16, seed=3)
    tracer.add_samples(sums, 32, seed=3)
    return [sums.radiance]


def test_sobol_samples_may_come_later() -> None:
    at_once = PathTracer(cornell_box(8)).render(spp=48, seed=3)
    np.testing.assert_array_equal(in_two_passes()[0], at_once.radiance)


def test_an_unknown_sampler_is_refused() -> None:
    with pytest.raises(RangeError, match="sampler"):
        PathOptions(sampler="halton")
