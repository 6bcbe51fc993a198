"""Several ways to estimate one picture: their means agree, within what their spread allows."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.transport import Accumulation, Material, PathOptions, PathTracer, Scene
from photograd.transport.builtin import cornell_box
from photograd.transport.shapes import box, rectangle

from support.statistics import sidak
from tests.transport.scenes import GRAY, STRATEGY_SCENES, any_material, stage, view

LEVEL = 1e-3  # all z-tests of one parametrised test together raise a false alarm this often


def block_z(a: Accumulation, b: Accumulation, blocks: int = 2) -> Any:
    """z of the difference of means over blocks x blocks parts of the picture, per channel."""

    def pooled(x: Any) -> Any:
        parts = [np.array_split(row, blocks, axis=1) for row in np.array_split(x, blocks, axis=0)]
        return np.array([[part.mean(axis=(0, 1)) for part in row] for row in parts])

    n = a.mean.shape[0] * a.mean.shape[1] / blocks**2
    variance = pooled(a.standard_error**2 + b.standard_error**2) / n
    return (pooled(a.mean) - pooled(b.mean)) / np.sqrt(np.maximum(variance, 1e-30))


def assert_same_mean(a: Accumulation, b: Accumulation, tests: int, power: float) -> None:
    """Fails if a block differs; `power`: a difference of this part of the mean would be seen."""
    z = block_z(a, b)
    limit = math.sqrt(2) * erf_inverse(1 - sidak(LEVEL, tests * z.size))
    assert np.abs(z).max() < limit, z
    together = np.sqrt((a.standard_error**2 + b.standard_error**2).mean() / (a.mean.size / 3))
    assert 4 * together < power * a.mean.mean()


def erf_inverse(y: float) -> float:
    """By bisection."""
    low, high = 0.0, 10.0
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if math.erfc(middle) > 1 - y else (low, middle)
    return low


@pytest.mark.parametrize("name", STRATEGY_SCENES)
def test_light_bsdf_and_both_agree(name: str) -> None:
    tracer = PathTracer(STRATEGY_SCENES[name]())
    found = {
        strategy: tracer.render(
            spp=3072 if strategy == "bsdf" else 768,
            seed=seed,
            options=PathOptions(strategy, max_depth=6, roulette_from=None),
        )
        for seed, strategy in enumerate(("light", "bsdf", "mis"))
    }
    assert found["mis"].mean.mean() > 0.01
    # Few paths find a small light by chance, or a light through frosted glass.
    power = 0.2 if name in ("room", "frosted glass") else 0.1
    assert_same_mean(found["mis"], found["light"], 2 * len(STRATEGY_SCENES), power)
    assert_same_mean(found["mis"], found["bsdf"], 2 * len(STRATEGY_SCENES), power)


def test_both_heuristics_agree_and_beat_each_strategy_alone() -> None:
    # A large light and a glossy floor: light sampling is bad at the mirror image of the light, BSDF
    # sampling at the diffuse rest.
    tracer = PathTracer(stage(any_material("gltf", 0.2), floor=any_material("gltf", 0.3)))
    noise = {}
    found = []
    for seed, (strategy, heuristic) in enumerate(
        [("light", "power"), ("bsdf", "power"), ("mis", "balance"), ("mis", "power")]
    ):
        options = PathOptions(strategy, heuristic, max_depth=3)
        found.append(tracer.render(spp=1024, seed=seed, options=options))
        noise[strategy, heuristic] = found[-1].noise
    assert_same_mean(found[2], found[3], 1, 0.05)
    assert max(noise["mis", "balance"], noise["mis", "power"]) < 0.9 * min(
        noise["light", "power"], noise["bsdf", "power"]
    )


@pytest.mark.parametrize("start", [0, 1, 3])
def test_roulette_keeps_the_mean(start: int) -> None:
    # A bright room: paths are long, and where roulette starts early, few survivors carry much.
    room = box("room", [0, 1, 0], [4, 2, 4], "white", inward=True)
    lamp = rectangle("lamp", [-0.5, 1.9, -0.5], [1, 0, 0], [0, 0, 1], "white", [5, 5, 5])
    white = Material("lambert", {"albedo": [0.8, 0.7, 0.6]})
    tracer = PathTracer(
        Scene("r", (room, lamp), {"white": white}, view(8, (0, 1, 1.5), (0, 0, -1)))
    )
    without = tracer.render(spp=512, seed=1, options=PathOptions(max_depth=30, roulette_from=None))
    played = tracer.render(spp=1024, seed=2, options=PathOptions(max_depth=30, roulette_from=start))
    assert_same_mean(without, played, 3, 0.06)


def test_more_samples_may_come_later() -> None:
    tracer = PathTracer(cornell_box(8))
    at_once = tracer.render(spp=32, seed=3)
    sums = tracer.render(spp=16, seed=3)
    tracer.add_samples(sums, 16, seed=3)
    # Cut between samples at a packet's border: the very same packets, the very same bits.
    np.testing.assert_array_equal(sums.radiance, at_once.radiance)
    assert sums.count == 32
    other = tracer.render(spp=16, seed=4)
    assert not np.array_equal(other.radiance, tracer.render(spp=16, seed=3).radiance)


def test_noise_falls_as_one_over_the_root() -> None:
    # Direct light, whose samples are bounded: the spread of a few tells that of many.
    tracer = PathTracer(stage(GRAY, size=16, sky=0.5))
    options = PathOptions(max_depth=2, sampler="independent")
    errors = []
    truth = tracer.render(spp=4096, seed=9, options=options).mean
    for spp in (8, 32, 128):
        found = tracer.render(spp=spp, seed=5, options=options)
        rms = float(np.sqrt(np.square(found.mean - truth).mean()))
        # The error of 256 pixels is itself known by chance: 0.93 to 1.00; other seeds: to 1.16.
        assert rms == pytest.approx(np.sqrt(np.square(found.standard_error).mean()), rel=0.1)
        errors.append(rms)
    slope = np.polyfit(np.log([8, 32, 128]), np.log(errors), 1)[0]
    assert slope == pytest.approx(-0.5, abs=0.06)


def test_another_camera_is_taken() -> None:
    tracer = PathTracer(cornell_box(8))
    wide = Camera(12, 4, 20.0, 20.0, 6.0, 2.0, tracer.scene.camera.world_from_camera)
    assert tracer.render(spp=2, seed=1, camera=wide).mean.shape == (4, 12, 3)
