"""Derivative pictures through media: the transpose of the adjoint, differences, a closed form."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.lights import DirectionalLight, PointLight
from photograd.transport import (
    Accumulation,
    Medium,
    PathOptions,
    PathTracer,
    Scene,
    TextureUse,
    derivative_image,
    direction_of,
)

from support.bits import same_bits
from tests.transport.media_scenes import (
    FOG,
    FROSTED,
    INK,
    WAX,
    ball_of,
    fog_box,
    haze,
    pencil,
    smoke,
)
from tests.transport.test_alpha import checker, gray
from tests.transport.test_derivative import gaps
from tests.transport.test_media_alpha import veiled
from tests.transport.test_media_closed_forms import slab

OPTIONS = PathOptions(max_depth=6, roulette_from=3, sampler="independent")
LAMP = (PointLight([0.8, 1.6, 0.9], [5.0, 4.0, 3.0]),)
TOLERANCE = 1e-12  # of the sum of what is multiplied; 5.1e-16 at most was found


def dome() -> Scene:
    card = gray(0.7, textures={"alpha": TextureUse("t")})
    return veiled(card, smoke(), size=6, textures={"t": checker()})


SCENES = {
    "fog under a lamp": lambda: fog_box(size=6),
    "smoke in a grid": lambda: fog_box(smoke(), size=6),
    "black smoke in a grid": lambda: fog_box(replace(smoke(), albedo=None), size=6),
    "haze without end": lambda: haze(size=6),
    "wax behind frosted glass": lambda: ball_of(WAX, FROSTED, size=6, lights=LAMP, floor=True),
    "ink": lambda: ball_of(INK, size=6, floor=True),
    "smoke behind a painted veil": dome,
}


@pytest.mark.parametrize("name", SCENES)
def test_the_transpose_of_the_adjoint(name: str) -> None:
    # <d, J v> = <J^T d, v> for every parameter: media, materials, lights, textures.
    found = gaps(SCENES[name](), OPTIONS)
    media = [key for key in found if key.startswith("media.")]
    assert media
    for key, (gap, size) in found.items():
        assert gap <= TOLERANCE, key
        assert size > 0 or key == "materials.black.albedo", f"{key}: nothing depends on it"


@pytest.mark.parametrize("strategy", ["light", "bsdf"])
def test_every_strategy(strategy: str) -> None:
    found = gaps(fog_box(smoke(), size=12), replace(OPTIONS, strategy=strategy))
    for key, (gap, size) in found.items():
        assert gap <= TOLERANCE, key
        assert size > 0 or key in ("materials.black.albedo",), key


@pytest.mark.parametrize("parameter", ["sigma_t[1]", "albedo", "g", "density[1, 2, 3]", "density"])
def test_differences_on_held_paths(parameter: str) -> None:
    traced = PathTracer(fog_box(smoke(), size=6), dtype=np.float64)
    start = {name: value.copy() for name, value in traced.params.items()}
    along = f"media.fog.{parameter}"
    picture, derivative = derivative_image(traced, along, spp=8, seed=2, options=OPTIONS)
    ((name, v),) = direction_of(start, along).items()
    step, pictures = 1e-5, []
    for sign in (-1, 1):
        traced.params = {**start, name: start[name] + sign * step * v}
        sums = Accumulation.empty(6, 6)
        traced.add_samples(sums, 8, seed=2, options=OPTIONS, sampling_params=start)
        pictures.append(sums.mean)
    traced.params = start
    np.testing.assert_allclose(picture.mean, 0.5 * (pictures[0] + pictures[1]), rtol=1e-7)
    differences = (pictures[1] - pictures[0]) / (2 * step)
    largest = np.abs(derivative.mean).max()
    assert largest > 1e-4
    np.testing.assert_allclose(derivative.mean, differences, atol=1e-7 * largest, rtol=1e-6)


def test_single_scattering_in_closed_form() -> None:
    # As in test_media_adjoint: L = albedo p(0) E exp(-sigma h) (1 - exp(-sigma d)).
    g, h, d, E = 0.3, 0.25, 0.75, 2.0
    sigma, albedo = np.array([0.3, 1.1, 2.2]), np.array([0.9, 0.5, 0.2])
    camera = pencil((0, 1.0 - h, 1), (0, 1.0 - h, 0))
    sun = DirectionalLight([0, 1, 0], [E] * 3)
    scene = slab(Medium(sigma, albedo, values={"g": g}), d, camera, sun, sky=0.0)
    traced, options = PathTracer(scene, dtype=np.float64), PathOptions(max_depth=2)
    p = (1 - g * g) / (4 * np.pi * (1 + g * g) ** 1.5)
    lost, T = np.exp(-sigma * h), np.exp(-sigma * d)
    L = albedo * p * E * lost * (1 - T)
    less, more = h * L, albedo * p * E * lost * d * T
    expected = {
        "sigma_t": (more - less, more + less),
        "albedo": (L / albedo, L / albedo),
        "g": ((-2 * g / (1 - g * g) - 3 * g / (1 + g * g)) * L, L),
    }
    for name, (value, size) in expected.items():
        _, found = derivative_image(
            traced, f"media.inside.{name}", spp=32768, seed=3, options=options
        )
        assert (np.abs(found.mean[0, 0] - value) < 0.01 * size).all(), name


@same_bits("derivative images of media")
def picture_and_derivative() -> list[Any]:
    tracer = PathTracer(fog_box(smoke(), size=16))
    return [s.radiance for s in derivative_image(tracer, "media.fog.density", spp=4, seed=9)]


def test_two_media_keep_apart() -> None:
    # What one of them does to the picture is not put down to the other.
    scene = ball_of(FOG, size=6, lights=LAMP)
    other = replace(scene, media={"inside": FOG, "elsewhere": WAX})
    _, none = derivative_image(PathTracer(other), "media.elsewhere.albedo", spp=4, seed=1)
    _, some = derivative_image(PathTracer(other), "media.inside.albedo", spp=4, seed=1)
    assert not none.radiance.any()
    assert some.radiance.any()
