"""The path tracer to read agrees in expectation with the fast one.

cpp/photograd/render/reference/path_tracer.h follows one ray; its random numbers are others, and so
is how it samples media. On every built-in scene, and where those lack a feature: the mean radiance
of blocks of pixels, against its standard error.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.lights import DirectionalLight, PointLight
from photograd.transport import BOUNDARY, Accumulation, PathOptions, PathTracer, Scene
from photograd.transport.builtin import BUILTIN
from photograd.transport.shapes import box, rectangle

from tests.transport.media_scenes import FOG, GLASS, WAX, fog_box, smoke, with_interior
from tests.transport.scenes import BLACK, FLOOR, GRAY, view
from tests.transport.test_media_particles import SCENES as MEDIA_SCENES
from tests.transport.test_strategies import assert_same_mean

SIZE, SPP = 8, 2048
NOISY = "fog behind a veil"  # shadow rays are attenuated by the occluder, paths at random


def reference(tracer: PathTracer, spp: int, options: PathOptions, seed: int = 9) -> Accumulation:
    camera = tracer.scene.camera
    sums = Accumulation.empty(camera.height, camera.width)
    _core.trace_reference(
        **tracer.wide_arguments(),
        options=options.numbers(seed),
        first=0,
        count=spp,
        radiance=sums.radiance,
        squares=sums.squares,
    )
    sums.count = spp
    return sums


def wax_in_glass() -> Scene:
    slab = with_interior(box("slab", [0, 0.5, 0], [1.5, 0.4, 1.5], "shell"), "wax")
    lamp = rectangle("lamp", [-1, 1.4, -1], [2, 0, 0], [0, 0, 2], "black", [4.0, 3.0, 2.0])
    shapes = (rectangle("floor", *FLOOR, "floor"), slab, lamp)
    materials = {"floor": GRAY, "shell": GLASS, "black": BLACK}
    return Scene("slab", shapes, materials, view(SIZE), media={"wax": WAX})


def foggy_world() -> Scene:
    shapes = (rectangle("floor", *FLOOR, "floor"), box("hole", [0, 0.5, 0], [1, 0.6, 1], BOUNDARY))
    lights = (PointLight([0.3, 1.2, 0.2], [3.0, 2.5, 2.0]),)
    return Scene(
        "w", shapes, {"floor": GRAY}, view(SIZE), None, lights, media={"fog": FOG}, world="fog"
    )


MORE: dict[str, Callable[[], Scene]] = {
    **{
        name: lambda make=make: replace(make(), camera=view(SIZE))
        for name, make in MEDIA_SCENES.items()
    },
    "wax in glass": wax_in_glass,
    "foggy world": foggy_world,
    "smoke under the sun": lambda: replace(
        fog_box(smoke(), size=SIZE), lights=(DirectionalLight([0.3, 1, 0.2], [2.0, 1.5, 1.0]),)
    ),
}
CASES: dict[str, Callable[[], Scene]] = {
    **{name: lambda make=make: make(SIZE) for name, make in BUILTIN.items()},
    **MORE,
}


@pytest.mark.parametrize("name", CASES)
def test_equal_in_expectation(name: str) -> None:
    tracer = PathTracer(CASES[name]())
    options = PathOptions(sampler="independent", max_depth=12)
    fast = tracer.render(spp=SPP, seed=4, options=options)
    plain = reference(tracer, 4096 if name == NOISY else 640, options)
    assert plain.mean.mean() > 0.01
    assert_same_mean(fast, plain, len(CASES), 0.25 if name == NOISY else 0.15)


@pytest.mark.parametrize("strategy", ["light", "bsdf", "mis"])
def test_each_strategy(strategy: str) -> None:
    tracer = PathTracer(BUILTIN["cornell-spheres"](SIZE))
    options = PathOptions(strategy, sampler="independent", max_depth=5, roulette_from=1)
    fast = tracer.render(spp=SPP, seed=4, options=options)
    assert_same_mean(fast, reference(tracer, 2048, options), 3, 0.2)


def test_emission_alone_is_equal_to_rounding() -> None:
    # One segment: both see the same rays, and nothing is random behind them.
    tracer = PathTracer(BUILTIN["cornell-box"](SIZE), dtype=np.float64)
    options: Any = PathOptions(sampler="independent", max_depth=1)
    fast, plain = tracer.render(spp=16, seed=4, options=options), reference(tracer, 16, options, 4)
    assert fast.mean.max() > 0
    np.testing.assert_allclose(plain.mean, fast.mean, rtol=1e-12)
