"""Soft shadows by asking a light many times, and mirrors and glass bounce by bounce."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from photograd.lights import QuadLight
from photograd.transport import PathOptions, PathTracer, Scene
from photograd.transport.builtin import camera_at
from photograd.transport.shapes import rectangle

from tests.transport.scenes import BLACK, FLOOR, GRAY, STRATEGY_SCENES
from tests.transport.test_closed_forms import polygon_irradiance

LAMP = QuadLight([-0.5, 2.0, -0.5], [1.0, 0, 0], [0, 0, 1.0], [3.0, 3.0, 3.0])
# At half the height x < 0 is covered: from (p, 0, 0), the light is visible where x > -p.
COVER = rectangle("cover", [-5, 1, -5], [5, 0, 0], [0, 0, 10], "black")


def shadowed(p: float) -> PathTracer:
    """One pixel on the floor at (p, 0, 0), half in the shadow of an edge."""
    camera = camera_at([p, 0.5, 1.0], [p, 0.0, 0.0], 0.01, 1, 1)
    shapes = (rectangle("floor", *FLOOR, "gray"), COVER)
    materials = {"gray": GRAY, "black": BLACK}
    return PathTracer(Scene("s", shapes, materials, camera, lights=(LAMP,)), dtype=np.float64)


def irradiance(p: float, left: float) -> float:
    """Of the part of the light right of x = left."""
    corners = [[left, 2.0, -0.5], [0.5, 2.0, -0.5], [0.5, 2.0, 0.5], [left, 2.0, 0.5]]
    return 3.0 * polygon_irradiance(corners, np.array([p, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))


def seen(p: float, spp: int, sampler: str, seed: int) -> float:
    options = PathOptions("light", max_depth=2, sampler=sampler)
    return float(shadowed(p).render(spp=spp, seed=seed, options=options).mean[0, 0, 0])


@pytest.mark.parametrize("p", [-0.7, -0.35, -0.1, 0.0, 0.2, 0.4, 0.7])
def test_the_penumbra_of_an_edge(p: float) -> None:
    # B06: within 1 % of the open light with 1024 shadow rays.
    open_lamp = 0.5 / np.pi * irradiance(p, -0.5)
    expected = 0.5 / np.pi * irradiance(p, min(max(-0.5, -p), 0.5)) if p > -0.5 else 0.0
    assert abs(seen(p, 1024, "sobol", 1) - expected) < 0.01 * open_lamp
    if abs(p) < 0.5:
        assert 0.05 * open_lamp < expected < 0.95 * open_lamp


def test_even_shadow_rays_beat_random_ones_fourfold() -> None:
    tracer = shadowed(0.1)

    def variance(sampler: str) -> Any:
        options = PathOptions("light", max_depth=2, sampler=sampler)
        found = [tracer.render(spp=256, seed=s, options=options).mean[0, 0, 0] for s in range(100)]
        return np.var(found)

    # A variance of 100 values is known to 14 %; the ratio is about 30.
    assert variance("sobol") < variance("independent") / 4


@pytest.mark.parametrize("name", ["smooth glass", "mirror", "frosted glass"])
def test_more_bounces_take_no_light_away(name: str) -> None:
    # The same seed: a longer limit adds segments to the same paths.
    tracer = PathTracer(STRATEGY_SCENES[name](), dtype=np.float64)
    pictures = [
        tracer.render(spp=16, seed=2, options=PathOptions(max_depth=depth, roulette_from=None)).mean
        for depth in (1, 2, 3, 4, 6, 10, 20)
    ]
    for fewer, more in pairwise(pictures):
        assert (more >= fewer).all()
    assert (pictures[3] > pictures[2]).mean() > 0.05
    # And what is left to come becomes little.
    assert np.abs(pictures[-1] - pictures[-2]).mean() < 0.01 * pictures[-1].mean()
