"""Several ways to estimate one picture with media: their means agree."""

from __future__ import annotations

import numpy as np
import pytest
from photograd.lights import PointLight, SunLight
from photograd.transport import PathOptions, PathTracer

from tests.transport.media_scenes import FROSTED, WAX, ball_of, fog_box, haze, smoke
from tests.transport.test_strategies import assert_same_mean

LAMPS = (
    PointLight([0.8, 1.6, 0.9], [2.0, 1.6, 1.2]),
    SunLight([0.4, 1.0, 0.3], [25.0, 20.0, 15.0], 0.2),
)
SCENES = {
    "fog": fog_box,
    "smoke": lambda: fog_box(smoke()),
    "haze": haze,
    # A point light would make caustics through frosted glass: few paths, which carry much.
    "wax": lambda: ball_of(WAX, FROSTED, sky=0.5, floor=True),
    "bare wax": lambda: ball_of(WAX, sky=0.5, lights=LAMPS, floor=True),
}


@pytest.mark.parametrize("name", SCENES)
def test_light_bsdf_and_both_agree(name: str) -> None:
    tracer = PathTracer(SCENES[name]())
    found = {
        strategy: tracer.render(
            spp=1024 if strategy == "bsdf" else 384,
            seed=seed,
            options=PathOptions(strategy, max_depth=6, roulette_from=None, sampler="independent"),
        )
        for seed, strategy in enumerate(("light", "bsdf", "mis"))
    }
    assert found["mis"].mean.mean() > 0.05
    power = 0.15 if name == "haze" else 0.1  # near the light in it, few collisions carry much
    assert_same_mean(found["mis"], found["light"], 2 * len(SCENES), power)
    assert_same_mean(found["mis"], found["bsdf"], 2 * len(SCENES), power)


def test_roulette_keeps_the_mean() -> None:
    tracer = PathTracer(ball_of(WAX, size=4, lights=LAMPS[1:]))
    options = {"max_depth": 40, "sampler": "independent"}
    without = tracer.render(spp=512, seed=1, options=PathOptions(roulette_from=None, **options))
    played = tracer.render(spp=1024, seed=2, options=PathOptions(roulette_from=1, **options))
    assert_same_mean(without, played, 1, 0.1)


def test_sobol_samples_are_no_noisier() -> None:
    tracer = PathTracer(fog_box(size=6))
    truth = tracer.render(spp=2048, seed=9).mean
    errors = {}
    for sampler in ("sobol", "independent"):
        options = PathOptions(sampler=sampler)
        runs = [tracer.render(spp=64, seed=s, options=options).mean - truth for s in range(3)]
        errors[sampler] = float(np.sqrt(np.mean(np.square(runs))))
    assert errors["sobol"] < errors["independent"]
