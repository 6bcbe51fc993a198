"""Derivative pictures: against the adjoint, against differences on held paths, in closed form."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.transport import (
    Accumulation,
    PathOptions,
    PathTracer,
    Scene,
    TextureUse,
    add_derivative_samples,
    derivative_image,
    direction_of,
)
from photograd.transport.builtin import cornell_box, furnace_box
from photograd.transport.material import MODELS

from support.bits import same_bits
from tests.transport import test_textures as textures
from tests.transport.light_scenes import LIGHTS, TILT, environment_map, lit_by
from tests.transport.scenes import any_material, bent_floor, stage
from tests.transport.test_alpha import checker, gray, shade
from tests.transport.test_emission_textures import room

OPTIONS = PathOptions(max_depth=5, roulette_from=2)
SPP = 3
TOLERANCE = 1e-10  # of the sum of what is multiplied; 1.1e-15 at most was found


def gaps(scene: Scene, options: PathOptions = OPTIONS) -> dict[str, tuple[float, float]]:
    """{parameter: (|<d_image, J v> - <J^T d_image, v>| over its terms, |J v|)} for random v."""
    tracer = PathTracer(scene, dtype=np.float64, allow_incomplete=True)
    g = np.random.default_rng(3)
    d_image = g.uniform(-1, 1, (scene.camera.height, scene.camera.width, 3))
    gradient = tracer.render_backward(d_image, spp=SPP, seed=1, options=options)
    found = {}
    for name, value in tracer.params.items():
        v = g.uniform(-1, 1, value.shape)
        _, derivative = derivative_image(tracer, {name: v}, spp=SPP, seed=1, options=options)
        terms = d_image * derivative.mean
        size = float(np.abs(terms).sum())
        gap = abs(float(terms.sum()) - float((gradient[name] * v).sum()))
        found[name] = (gap / size if size else gap, size)
    return found


def check(scene: Scene, options: PathOptions = OPTIONS, *, without: tuple[str, ...] = ()) -> None:
    for name, (gap, size) in gaps(scene, options).items():
        assert gap <= TOLERANCE, name
        assert size > 0 or name in without, f"{name}: nothing depends on it"


@pytest.mark.parametrize("model", MODELS)
def test_every_model_is_the_transpose_of_its_adjoint(model: str) -> None:
    # The black light reflects nothing unless some path starts from it; the others must all count.
    check(stage(any_material(model), size=6, sky=0.4), without=("materials.black.albedo",))


@pytest.mark.parametrize("name", [name for name in LIGHTS if name not in ("map", "all")])
def test_every_light(name: str) -> None:
    check(lit_by(*LIGHTS[name], size=6), PathOptions(max_depth=4, roulette_from=2))


@pytest.mark.parametrize("strategy", ["light", "bsdf", "mis"])
def test_every_strategy(strategy: str) -> None:
    kinds = ("point", "spot", "directional", "ambient", "sky")
    lights = [LIGHTS[kind][0] for kind in kinds]
    scene = lit_by(*lights, environment_map(turn=TILT, share=0.5), size=12)
    check(scene, PathOptions(strategy, max_depth=4, roulette_from=2, sampler="independent"))


def test_textures_and_bent_normals() -> None:
    check(textures.stage(), without=("materials.black.albedo",))
    check(bent_floor(6))


@pytest.mark.parametrize("alpha", [0.2, 0.6, 1.0])
def test_veils(alpha: float) -> None:
    check(shade(gray(alpha)))
    card = gray(0.7, textures={"alpha": TextureUse("holes")})
    check(shade(card, size=8, textures={"holes": checker()}))


def test_painted_lamps() -> None:
    check(room(), without=("materials.black.albedo",))


def test_differences_on_held_paths() -> None:
    # Pixel by pixel: the polynomial of each path, moved by h both ways.
    scene = textures.stage(8)
    tracer = PathTracer(scene, dtype=np.float64)
    start = {name: value.copy() for name, value in tracer.params.items()}
    g = np.random.default_rng(5)
    for name in ("materials.floor.roughness", "textures.paint", "emission.lamp", "environment"):
        v = g.uniform(0.2, 1, start[name].shape)
        _, derivative = derivative_image(tracer, {name: v}, spp=SPP, seed=2, options=OPTIONS)
        step, pictures = 1e-5, []
        for sign in (-1, 1):
            tracer.params = {**start, name: start[name] + sign * step * v}
            sums = Accumulation.empty(8, 8)
            tracer.add_samples(sums, SPP, seed=2, options=OPTIONS, sampling_params=start)
            pictures.append(sums.mean)
        tracer.params = start
        difference = (pictures[1] - pictures[0]) / (2 * step)
        size = float(np.abs(difference).max())
        assert size > 1e-3, name
        np.testing.assert_allclose(derivative.mean, difference, atol=1e-7 * size, err_msg=name)


def test_furnace_in_closed_form() -> None:
    # L = e / (1 - a): dL/da = e / (1 - a)^2 and dL/de = 1 / (1 - a), in every pixel and in the
    # channel that changes alone.
    tracer = PathTracer(furnace_box(8, 0.5, 0.7))
    options = PathOptions(max_depth=100)
    for parameter, slope in (("materials.wall.albedo[1]", 0.7 / 0.25), ("emission.walls[1]", 2.0)):
        picture, derivative = derivative_image(tracer, parameter, spp=256, seed=6, options=options)
        found = derivative.mean
        assert picture.mean.mean() == pytest.approx(1.4, rel=0.015)
        assert found[..., 1].mean() == pytest.approx(slope, rel=0.015), parameter
        assert not found[..., [0, 2]].any(), parameter


def test_wrong_derivatives_die() -> None:
    scene = stage(any_material("ggx_metal"), size=6, sky=0.4)
    tracer = PathTracer(scene, dtype=np.float64)
    d = np.random.default_rng(7).uniform(-1, 1, (6, 6, 3))
    name = "materials.ball.f0"
    v = np.array([0.3, -0.5, 0.9])
    gradient = tracer.render_backward(d, spp=SPP, seed=1, options=OPTIONS)[name]
    _, derivative = derivative_image(tracer, {name: v}, spp=SPP, seed=1, options=OPTIONS)
    right = derivative.mean
    _, other = derivative_image(tracer, {name: v}, spp=SPP, seed=2, options=OPTIONS)
    wrong = (0 * right, -right, 2 * right, right[..., ::-1], right[::-1], other.mean)
    for image in (right, *wrong):
        gap = abs((d * image).sum() - (gradient * v).sum()) / np.abs(d * right).sum()
        assert (gap <= TOLERANCE) == (image is right)


@same_bits("derivative images")
def picture_and_derivative() -> list[Any]:
    tracer = PathTracer(cornell_box(24), dtype=np.float64)
    both = derivative_image(tracer, "materials.red.albedo[0]", spp=8, seed=9)
    return [part for sums in both for part in (sums.radiance, sums.squares)]


def test_the_pass_is_that_of_the_picture_and_of_its_parts() -> None:
    tracer = PathTracer(cornell_box(24), dtype=np.float64)
    found = picture_and_derivative()
    # Paths that have turned black are followed here, and add nothing.
    picture = tracer.render(spp=8, seed=9)
    np.testing.assert_allclose(found[0], picture.radiance, rtol=1e-12)
    parts = Accumulation.empty(24, 24), Accumulation.empty(24, 24)
    for count in (3, 5):
        add_derivative_samples(tracer, *parts, "materials.red.albedo[0]", count, seed=9)
    np.testing.assert_allclose(parts[1].radiance, found[2], rtol=1e-12, atol=1e-12)


def test_spelling_and_mistakes() -> None:
    tracer = PathTracer(textures.stage(4))
    params = tracer.params
    whole = direction_of(params, "textures.paint")
    assert whole["textures.paint"].shape == (5, 4, 3)
    assert (whole["textures.paint"] == 1).all()
    one = direction_of(params, "textures.paint[2, 1,0]")["textures.paint"]
    assert one[2, 1, 0] == 1
    assert one.sum() == 1
    assert direction_of(params, "materials.floor.roughness")["materials.floor.roughness"] == 1
    for spelling in (
        "materials.flor.roughness",
        "",
        "textures.paint[0]",
        "textures.paint[5,0,0]",
        "materials.box.albedo[x]",
    ):
        with pytest.raises(RangeError, match="direction_of: parameter"):
            direction_of(params, spelling)
    with pytest.raises(RangeError, match="spp: expected a whole number of at least 1"):
        derivative_image(tracer, "emission.lamp", spp=0, seed=0)
    bad: tuple[tuple[dict[str, Any], type[Exception]], ...] = (
        ({"emission.lamp": np.ones(2)}, ShapeError),
        ({"emission.lamp": np.full(3, np.nan)}, RangeError),
        ({"emission.lmap": np.ones(3)}, RangeError),
    )
    for along, error in bad:
        with pytest.raises(error, match="derivative_image"):
            derivative_image(tracer, along, spp=1, seed=0)
    sums = Accumulation.empty(4, 4)
    with pytest.raises(RangeError, match="derivative: expected 0 samples"):
        add_derivative_samples(tracer, sums, replace(sums, count=1), "emission.lamp", 1, seed=0)
    with pytest.raises(ShapeError, match="derivative: expected shape"):
        add_derivative_samples(tracer, sums, Accumulation.empty(3, 4), "emission.lamp", 1, seed=0)
