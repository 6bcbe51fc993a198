"""Derivatives of traced pictures: by differences with held paths, by closed forms, by bits."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd.transport import Accumulation, Material, PathOptions, PathTracer, Scene
from photograd.transport.builtin import cornell_box, cornell_spheres, furnace_box
from photograd.transport.material import MODELS
from photograd_course.gradcheck import check_gradient

from support.bits import same_bits
from support.gradient_mutants import check_gradient_mutants
from tests.transport.scenes import BLACK, GRAY, any_material, picture_and_gradients, stage

SPP = 4
OPTIONS = PathOptions(max_depth=5, roulette_from=2)
# Of the few paths of these tests, independent ones happen to leave the black light, too.
INDEPENDENT = PathOptions(max_depth=5, roulette_from=2, sampler="independent")


def proof(scene: Scene, options: PathOptions = OPTIONS) -> tuple[Any, Any, dict[str, Any]]:
    """(function, backward, start) of the picture with paths held where `start` puts them."""
    tracer = PathTracer(scene, dtype=np.float64, allow_incomplete=True)
    start = {name: value.copy() for name, value in tracer.params.items()}

    def function(params: dict[str, Any]) -> Any:
        tracer.params = {name: np.array(value) for name, value in params.items()}
        sums = Accumulation.empty(scene.camera.height, scene.camera.width)
        tracer.add_samples(sums, SPP, seed=1, options=options, sampling_params=start)
        return sums.mean

    def backward(params: dict[str, Any], d_image: Any) -> dict[str, Any]:
        tracer.params = {name: np.array(value) for name, value in params.items()}
        return tracer.render_backward(d_image, spp=SPP, seed=1, options=options)

    return function, backward, start


@pytest.mark.parametrize("model", MODELS)
def test_every_parameter_of_every_model(model: str) -> None:
    function, backward, start = proof(stage(any_material(model), size=6, sky=0.4))
    report = check_gradient(function, backward, start, seed=2, coordinates=3, directions=3)
    assert report, str(report)


@pytest.mark.parametrize("strategy", ["light", "bsdf", "mis"])
def test_every_strategy(strategy: str) -> None:
    options = replace(INDEPENDENT, strategy=strategy)
    function, backward, start = proof(stage(any_material("gltf"), size=6, sky=0.4), options)
    report = check_gradient(function, backward, start, seed=3, coordinates=3, directions=3)
    assert report, str(report)


def test_wrong_gradients_die() -> None:
    scene = stage(any_material("ggx_metal"), size=3, sky=0.4)
    function, backward, start = proof(scene, INDEPENDENT)
    d = 0.2 + np.random.default_rng(5).random((3, 3, 3))
    deaths = check_gradient_mutants(
        function, backward, start, d, seed=4, coordinates=2, directions=1
    )
    assert deaths, str(deaths)


def test_black_surfaces_have_derivatives() -> None:
    # A division by the albedo would give none; the difference says there is one.
    scene = stage(BLACK, size=6, sky=0.4, floor=BLACK)
    function, backward, start = proof(scene)
    gradient = backward(start, np.ones((6, 6, 3)))
    assert (gradient["materials.ball.albedo"] > 0).all()
    assert (gradient["materials.floor.albedo"] > 0).all()
    nowhere = ("materials.black.albedo", "emission.lamp")  # the light is not in the picture
    report = check_gradient(
        function, backward, start, seed=5, coordinates=3, directions=3, may_be_zero=nowhere
    )
    assert report, str(report)
    # A lobe of weight 0 is chosen now and then, or its derivative would be lost.
    for model, values, name in (
        ("mirror", {"reflectance": [0.0] * 3}, "reflectance"),
        ("thin_glass", {"eta": 1.5, "tint": [0.0] * 3}, "tint"),
    ):
        floor = Material(model, values)
        _, backward, start = proof(stage(GRAY, size=6, sky=0.4, floor=floor))
        assert (backward(start, np.ones((6, 6, 3)))[f"materials.floor.{name}"] > 0).all()


def test_furnace_derivatives_in_closed_form() -> None:
    # L = e / (1 - a): dL/da = e / (1 - a)^2, dL/de = 1 / (1 - a). No path is held here.
    tracer = PathTracer(furnace_box(8, 0.5, 0.7))
    d_image = np.full((8, 8, 3), 1 / 64)
    found = tracer.render_backward(d_image, spp=2048, seed=6, options=PathOptions(max_depth=100))
    np.testing.assert_allclose(found["materials.wall.albedo"], 0.7 / 0.25, rtol=0.01)
    np.testing.assert_allclose(found["emission.walls"], 1 / 0.5, rtol=0.005)


def test_a_loss_needs_paths_of_its_own() -> None:
    # L = sum (I - t)^2: with the picture's own paths its noise enters the mean of the derivative,
    # 2 cov(I, dI); with other paths the mean is the derivative of the mean.
    tracer = PathTracer(furnace_box(4, 0.5, 1.0))
    options = PathOptions("bsdf", max_depth=40, roulette_from=1)
    truth = 2 * (2.0 - 1.8) * 3 * 16 * 1.0 / 0.25
    own, other = [], []
    for seed in range(300):
        d = 2 * (tracer.render(spp=1, seed=seed, options=options).mean - 1.8)
        for found, used in ((own, seed), (other, seed + 10_000)):
            gradient = tracer.render_backward(d, spp=1, seed=used, options=options)
            found.append(gradient["materials.wall.albedo"].sum())
    spread = np.std(other) / np.sqrt(len(other))
    assert abs(np.mean(other) - truth) < 4 * spread
    assert np.mean(own) - truth > 8 * spread


@same_bits("path tracing")
def cornell_picture_and_gradients() -> list[Any]:
    return picture_and_gradients(cornell_box(24), 20)


def test_twice_the_cotangent_is_twice_the_gradient() -> None:
    tracer = PathTracer(cornell_box(12))
    d = np.random.default_rng(8).uniform(-1, 1, (12, 12, 3))
    once, twice = (tracer.render_backward(f * d, spp=8, seed=9) for f in (1, 2))
    for name, value in once.items():
        np.testing.assert_allclose(twice[name], 2 * value, rtol=1e-6)


@pytest.mark.parametrize("scene", [cornell_box, cornell_spheres])
def test_float_agrees_with_double(scene: Any) -> None:
    # Single paths fall the other way at edges, where float rounds; the rest agrees to rounding.
    tracers = [
        PathTracer(scene(12), dtype=t, allow_incomplete=True) for t in (np.float32, np.float64)
    ]
    a, b = (t.render(spp=8, seed=1).mean for t in tracers)
    same = np.isclose(a, b, rtol=1e-4, atol=1e-6).all(axis=2, keepdims=True)
    assert same.mean() > 0.97
    d = np.where(same, np.random.default_rng(8).uniform(-1, 1, (12, 12, 3)), 0.0)
    g, h = (t.render_backward(d, spp=8, seed=1) for t in tracers)
    for name in g:
        assert np.linalg.norm(h[name]) > 0
        # Measured: 6e-5 of the light's albedo, 4e-5 of the index of glass, 4e-6 of all others.
        assert np.linalg.norm(g[name] - h[name]) <= 1e-4 * np.linalg.norm(h[name]), name


def test_bad_arguments_are_named() -> None:
    tracer = PathTracer(cornell_box(4))
    with pytest.raises(ShapeError, match="d_image: expected shape"):
        tracer.render_backward(np.zeros((3, 4, 3)), spp=1, seed=0)
    with pytest.raises(RangeError, match="spp: expected a whole number of at least 1"):
        tracer.render(spp=0, seed=0)
    with pytest.raises(ShapeError, match="sums: expected shape"):
        tracer.add_samples(Accumulation.empty(3, 4), 1, seed=0)
    with pytest.raises(DtypeError, match="dtype"):
        PathTracer(cornell_box(4), dtype=np.float16)
    with pytest.raises(RangeError, match="strategy"):
        PathOptions("hope")
    with pytest.raises(RangeError, match="max_depth"):
        PathOptions(max_depth=0)
