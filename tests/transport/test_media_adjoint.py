"""Derivatives of pictures with media: by held paths, by converged means, by bits."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.lights import DirectionalLight, PointLight
from photograd.transport import Accumulation, Material, Medium, PathOptions, PathTracer, Scene
from photograd_course.gradcheck import check_gradient

from support.bits import same_bits
from support.gradient_mutants import check_gradient_mutants
from tests.transport.media_scenes import (
    FOG,
    FROSTED,
    GLASS,
    INK,
    WAX,
    ball_of,
    fog_box,
    haze,
    pencil,
    smoke,
)
from tests.transport.scenes import picture_and_gradients
from tests.transport.test_adjoint import proof
from tests.transport.test_media_closed_forms import h_function, slab
from tests.transport.test_strategies import assert_same_mean

OPTIONS = PathOptions(max_depth=5, roulette_from=2, sampler="independent")
LAMP = (PointLight([0.8, 1.6, 0.9], [5.0, 4.0, 3.0]),)
SCENES = {
    "fog under a lamp": lambda: fog_box(size=5),
    "smoke in a grid": lambda: fog_box(smoke(), size=5),
    "haze without end": lambda: haze(size=5),
    "wax behind glass": lambda: ball_of(WAX, GLASS, size=5, lights=LAMP, floor=True),
    "wax behind frosted glass": lambda: ball_of(WAX, FROSTED, size=5, lights=LAMP, floor=True),
    "colored glass": lambda: ball_of(INK, GLASS, size=5, floor=True),
    "black smoke in a grid": lambda: fog_box(replace(smoke(), albedo=None), size=5),
}


@pytest.mark.parametrize("name", SCENES)
def test_every_parameter_of_every_medium(name: str) -> None:
    # And all materials, lights and emissions beside them.
    function, backward, start = proof(SCENES[name](), OPTIONS)
    media = [key for key in start if key.startswith("media.")]
    gradient = backward(start, np.ones((5, 5, 3)))
    assert media
    assert all(np.abs(gradient[key]).max() > 1e-3 for key in media)
    black = ("materials.black.albedo",)  # few paths leave the light
    report = check_gradient(
        function, backward, start, seed=2, coordinates=3, directions=2, may_be_zero=black
    )
    assert report, str(report)


@pytest.mark.parametrize("strategy", ["light", "bsdf"])
def test_every_strategy(strategy: str) -> None:
    options = replace(OPTIONS, strategy=strategy)
    function, backward, start = proof(fog_box(smoke(), size=4), options)
    rare = ("materials.black.albedo", "emission.lamp")
    report = check_gradient(
        function, backward, start, seed=3, coordinates=2, directions=1, may_be_zero=rare
    )
    assert report, str(report)


def test_wrong_gradients_die() -> None:
    scene = ball_of(FOG, size=3, floor=True)
    function, backward, start = proof(scene, OPTIONS)
    d = 0.2 + np.random.default_rng(5).random((3, 3, 3))
    deaths = check_gradient_mutants(
        function, backward, start, d, seed=4, coordinates=2, directions=1
    )
    assert deaths, str(deaths)


def test_empty_and_black_media_have_derivatives() -> None:
    # By a division through sigma_s there would be none; nor would collisions be drawn where
    # sigma_t is 0, were their chance not kept away from it.
    black = Medium([0.9, 0.6, 0.4], 0.0, values={"g": 0.4})
    _, backward, start = proof(ball_of(black, size=5, lights=LAMP), OPTIONS)
    assert (backward(start, np.ones((5, 5, 3)))["media.inside.albedo"] > 0).all()
    values = np.zeros((3, 4, 5))
    values[0] = 1.0
    scene = fog_box(smoke(values), size=6, sky=None)
    _function, backward, start = proof(scene, OPTIONS)
    d_density = backward(start, np.ones((6, 6, 3)))["media.fog.density"]
    assert (np.abs(d_density[2]) > 0).mean() > 0.5
    full = fog_box(smoke(np.ones((3, 4, 5))), size=6, sky=None)
    _, backward, start = proof(full, OPTIONS)
    assert np.abs(backward(start, np.ones((6, 6, 3)))["media.fog.density"]).min() > 0


def test_derivatives_in_closed_form() -> None:
    # Nothing is held. Sunlight from above, scattered once at the depth h in a slab of thickness d:
    # L = albedo p(0) E exp(-sigma h) (1 - exp(-sigma d)), as in test_media_closed_forms.
    g, h, d, E = 0.3, 0.25, 0.75, 2.0
    sigma, albedo = np.array([0.3, 1.1, 2.2]), np.array([0.9, 0.5, 0.2])
    camera = pencil((0, 1.0 - h, 1), (0, 1.0 - h, 0))
    sun = DirectionalLight([0, 1, 0], [E] * 3)
    scene = slab(Medium(sigma, albedo, values={"g": g}), d, camera, sun, sky=0.0)
    tracer = PathTracer(scene, dtype=np.float64)
    found = tracer.render_backward(
        np.ones((1, 1, 3)), spp=32768, seed=3, options=PathOptions(max_depth=2)
    )
    p = (1 - g * g) / (4 * np.pi * (1 + g * g) ** 1.5)
    lost, T = np.exp(-sigma * h), np.exp(-sigma * d)
    L = albedo * p * E * lost * (1 - T)
    by_g = -2 * g / (1 - g * g) - 3 * g / (1 + g * g)
    assert found["media.inside.g"] == pytest.approx(by_g * L.sum(), rel=0.01)
    np.testing.assert_allclose(found["media.inside.albedo"], L / albedo, rtol=0.01)
    less, more = h * L, albedo * p * E * lost * d * T  # which nearly cancel in the third channel
    error = np.abs(found["media.inside.sigma_t"] - (more - less))
    assert (error < 0.01 * (more + less)).all()


def test_derivative_of_a_half_space_by_its_albedo() -> None:
    # All orders of scattering: R = 1 - H(mu) sqrt(1 - a), differentiated numerically.
    a = np.array([0.5, 0.7, 0.85])
    scene = slab(Medium(1.0, a), 60.0, pencil((0, 0, 5), (0, 0, 0)), width=4000.0)
    options = PathOptions("bsdf", max_depth=400)
    found = PathTracer(scene, dtype=np.float64).render_backward(
        np.ones((1, 1, 3)), spp=32768, seed=4, options=options
    )

    def R(albedo: float) -> float:
        return 1 - h_function(albedo, 1.0) * np.sqrt(1 - albedo)

    expected = [(R(x + 1e-4) - R(x - 1e-4)) / 2e-4 for x in a]
    np.testing.assert_allclose(found["media.inside.albedo"], expected, rtol=0.01)
    # A half space has no length to compare sigma_t with.
    assert np.abs(found["media.inside.sigma_t"]).max() < 0.02


@pytest.mark.parametrize("medium", [FOG, smoke()])
def test_paths_of_other_media_keep_the_mean(medium: Medium) -> None:
    # What the derivative differentiates is the picture of some media by paths drawn for others;
    # its mean is that of paths drawn for themselves. So the derivative is the mean's.
    tracer = PathTracer(ball_of(medium, size=4, lights=LAMP, sky=0.3), dtype=np.float64)
    options = PathOptions(max_depth=5, roulette_from=None, sampler="independent")
    start = dict(tracer.params)
    moved = {"sigma_t": 1.25, "albedo": 0.9, "g": 1.3, "density": 0.8}
    tracer.params = {
        key: value * moved[key.split(".")[-1]] if key.startswith("media.") else value
        for key, value in start.items()
    }
    own = tracer.render(spp=4096, seed=1, options=options)
    other = Accumulation.empty(4, 4)
    tracer.add_samples(other, 4096, seed=2, options=options, sampling_params=start)
    tracer.params = start
    unmoved = tracer.render(spp=4096, seed=3, options=options)
    assert_same_mean(own, other, 2, 0.05)
    with pytest.raises(AssertionError):
        assert_same_mean(unmoved, other, 2, 0.05)


@same_bits("path tracing in media", each=("fog", "smoke"))
def picture_and_gradients_of_a_medium(name: str) -> list[Any]:
    return picture_and_gradients(fog_box({"fog": FOG, "smoke": smoke()}[name], size=24), 6)


@pytest.mark.parametrize("medium", [FOG, smoke()])
def test_twice_the_cotangent_is_twice_the_gradient(medium: Medium) -> None:
    tracer = PathTracer(fog_box(medium, size=12))
    d = np.random.default_rng(8).uniform(-1, 1, (12, 12, 3))
    once, twice = (tracer.render_backward(f * d, spp=6, seed=9) for f in (1, 2))
    for key, value in once.items():
        np.testing.assert_allclose(twice[key], 2 * value, rtol=1e-5, atol=1e-7)


def test_float_agrees_with_double() -> None:
    d = np.random.default_rng(8).random((12, 12, 3))
    for medium in (FOG, smoke()):
        narrow, wide = (PathTracer(fog_box(medium, size=12), dtype=t) for t in ("f4", "f8"))
        a, b = (t.render(spp=8, seed=1).mean for t in (narrow, wide))
        same = np.isclose(a, b, rtol=1e-3, atol=1e-4)
        assert same.mean() > 0.9
        g, h = (t.render_backward(d, spp=16, seed=1) for t in (narrow, wide))
        for key in g:
            assert np.linalg.norm(g[key] - h[key]) <= 0.05 * np.linalg.norm(h[key]) + 1e-6, key


def test_materials_and_lights_see_through_media() -> None:
    # sum of p dL/dp = L over all that shines, on the same paths, to rounding.
    scene: Scene = fog_box(smoke(), size=5)
    scene = replace(
        scene,
        lights=LAMP,
        materials={**scene.materials, "floor": Material("lambert", {"albedo": [0.7, 0.6, 0.5]})},
    )
    tracer = PathTracer(scene, dtype=np.float64)
    d = np.random.default_rng(8).random((5, 5, 3))
    gradient = tracer.render_backward(d, spp=20, seed=9, options=OPTIONS)
    picture = tracer.render(spp=20, seed=9, options=OPTIONS).mean
    shines = [key for key in gradient if key.startswith(("lights.", "emission.", "environment"))]
    total = sum(float((gradient[key] * tracer.params[key]).sum()) for key in shines)
    assert total == pytest.approx(float((d * picture).sum()), rel=1e-9)
