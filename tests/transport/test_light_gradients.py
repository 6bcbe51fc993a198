"""Derivatives of traced pictures by everything that lights send."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.transport import PathOptions, PathTracer
from photograd_course.gradcheck import check_gradient

from support.bits import same_bits
from support.gradient_mutants import check_gradient_mutants
from tests.transport.light_scenes import LIGHTS, TILT, environment_map, lit_by
from tests.transport.scenes import GRAY, picture_and_gradients
from tests.transport.test_adjoint import proof

OPTIONS = PathOptions(max_depth=4, roulette_from=2)
EVERYWHERE = environment_map(turn=TILT, share=0.5)
KINDS = [name for name in LIGHTS if name not in ("map", "all")]


def params_of_lights(tracer: PathTracer) -> list[str]:
    return [name for name in tracer.params if name.startswith("lights.")]


@pytest.mark.parametrize("name", KINDS)
def test_every_parameter_of_every_light(name: str) -> None:
    function, backward, start = proof(lit_by(*LIGHTS[name], size=6), OPTIONS)
    assert any(key.startswith("lights.0.") for key in start)
    report = check_gradient(function, backward, start, seed=2, coordinates=4, directions=3)
    assert report, str(report)


@pytest.mark.parametrize("strategy", ["light", "bsdf", "mis"])
def test_lights_together_and_every_strategy(strategy: str) -> None:
    # Few paths meet small lights by chance: the others, for all strategies alike.
    kinds = ("point", "spot", "directional", "ambient", "sky", "turned map")
    # Even samples would send none of six times six to the spot.
    options = PathOptions(strategy, max_depth=4, roulette_from=2, sampler="independent")
    scene = lit_by(*(LIGHTS[kind][0] for kind in kinds), size=6)
    function, backward, start = proof(scene, options)
    report = check_gradient(function, backward, start, seed=3, coordinates=2, directions=1)
    assert report, str(report)


def test_wrong_gradients_die() -> None:
    lights = (environment_map(2, share=0.5), LIGHTS["point"][0], LIGHTS["rectangle"][0])
    function, backward, start = proof(lit_by(*lights, size=4, gloss=GRAY), OPTIONS)
    d = 0.2 + np.random.default_rng(5).random((4, 4, 3))
    deaths = check_gradient_mutants(
        function, backward, start, d, seed=4, coordinates=2, directions=1
    )
    assert deaths, str(deaths)


@pytest.mark.parametrize(
    "name", ["point", "spot", "sky", "sun", "rectangle", "sphere", "triangle", "map"]
)
def test_differences_of_converged_means(name: str) -> None:
    # Nothing is held but the random numbers, and the derivative has others: both are means that
    # have settled. Coordinates of a map are moved together, by a random positive step of each. A
    # mesh is left out: half of its samples fall on faces that look away, and 1 % would take more
    # paths than a test may; its pieces are triangles.
    lights = (EVERYWHERE,) if name == "map" else LIGHTS[name]
    tracer = PathTracer(lit_by(*lights, gloss=GRAY), dtype=np.float64)
    start = {key: value.copy() for key, value in tracer.params.items()}
    d = 0.5 + np.random.default_rng(6).random((8, 8, 3))
    options = PathOptions(max_depth=3)
    spp = 6144 if name in ("rectangle", "sphere", "triangle") else 2048
    found = tracer.render_backward(d, spp=spp, seed=11, options=options)
    g = np.random.default_rng(7)
    for key in params_of_lights(tracer):
        v = (0.5 + g.random(start[key].shape)) * start[key]
        step = 1e-3
        values = []
        for sign in (-1, 1):
            tracer.params = {**start, key: start[key] + sign * step * v}
            picture = tracer.render(spp=spp, seed=12, options=options)
            values.append(float((d * picture.mean).sum()))
        difference = (values[1] - values[0]) / (2 * step)
        assert abs(difference) > 1e-3
        assert float((found[key] * v).sum()) == pytest.approx(difference, rel=0.01), key


def test_radiance_is_linear_in_lights_whatever_the_number_of_samples() -> None:
    # sum of p dL/dp = L, on the same paths to rounding: 300 samples are more than are held at once.
    lights = (EVERYWHERE, *(LIGHTS[n][0] for n in ("point", "sky", "rectangle", "sphere")))
    tracer = PathTracer(lit_by(*lights, size=6), dtype=np.float64)
    d = np.random.default_rng(8).random((6, 6, 3))
    for spp in (3, 300):
        gradient = tracer.render_backward(d, spp=spp, seed=9, options=OPTIONS)
        picture = tracer.render(spp=spp, seed=9, options=OPTIONS).mean
        total = sum(
            float((gradient[key] * tracer.params[key]).sum()) for key in params_of_lights(tracer)
        )
        assert total == pytest.approx(float((d * picture).sum()), rel=1e-9)


@same_bits("lights and texels of the environment")
def gradients_of_all_lights() -> list[Any]:
    return picture_and_gradients(lit_by(*LIGHTS["all"], EVERYWHERE, size=24), 20)


def test_float_agrees_with_double() -> None:
    # Paths that rounding sends elsewhere make the difference.
    scene = lit_by(EVERYWHERE, *LIGHTS["rectangle"], *LIGHTS["spot"], size=12)
    d = np.random.default_rng(8).random((12, 12, 3))
    g, h = (
        PathTracer(scene, dtype=dtype).render_backward(d, spp=16, seed=1)
        for dtype in (np.float32, np.float64)
    )
    for name in g:
        assert np.linalg.norm(g[name] - h[name]) <= 0.03 * np.linalg.norm(h[name])
