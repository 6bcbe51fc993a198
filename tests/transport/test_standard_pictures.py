"""Pictures of the model `standard` against a second implementation, in plain NumPy."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
import pytest
from photograd.lights import DirectionalLight, EnvironmentMap, PointLight
from photograd.transport import Material, PathOptions, PathTracer, Scene, SphereShape
from photograd.transport.builtin import camera_at
from photograd_course.color import srgb_encode
from photograd_course.metrics import psnr

from tests.transport.standard_oracle import FAULTS, RIGHT, Balls, Form, lamp_picture
from tests.transport.standard_sky_oracle import sky_picture

pytestmark = pytest.mark.usefixtures("core")
LAMPS = (
    ("directional", [-0.5, 0.9, 0.8], [2.0, 1.8, 1.5]),
    ("point", [2.6, 0.6, 1.4], [1.6, 2.0, 2.6]),
)
ROUGHNESS, METALNESS = [0.1, 0.25, 0.45, 0.7, 1.0], [0.0, 0.5, 1.0]
LEAST_DECIBELS = 50.0


def rack(roughness: Any, metalness: Any) -> Balls:
    """Balls of radius 0.45 m, 1 m apart: roughness grows to the right, metalness downwards."""
    g = np.random.default_rng(14)
    rough, metal = (part.ravel() for part in np.meshgrid(roughness, metalness))
    x, y = np.meshgrid(
        np.arange(len(roughness)) - (len(roughness) - 1) / 2,
        (len(metalness) - 1) / 2 - np.arange(len(metalness)),
    )
    centers = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=-1)
    color, gloss = g.uniform(0.2, 0.95, (x.size, 3)), g.uniform(0.3, 1.0, x.size)
    return Balls(centers, np.full(x.size, 0.45), color, metal, rough, gloss)


def scene(balls: Balls, lights: Any, pixels: int) -> Scene:
    """The rack from 12 m away, `pixels` a meter."""
    shapes, materials = [], {}
    for i, (center, radius) in enumerate(zip(balls.centers, balls.radii, strict=True)):
        materials[f"m{i}"] = Material(
            "standard",
            {
                "base_color": balls.base_color[i],
                "metalness": balls.metalness[i],
                "roughness": balls.roughness[i],
                "reflectance": balls.reflectance[i],
            },
        )
        shapes.append(SphereShape(f"b{i}", center, float(radius), f"m{i}"))
    wide, high = (np.ptp(balls.centers, axis=0)[:2] + 1).astype(int)
    angle = 2 * np.degrees(np.arctan(high / 2 / 12.0))
    camera = camera_at([0, 0, 12], [0, 0, 0], angle, int(pixels * wide), int(pixels * high))
    return Scene("rack", tuple(shapes), materials, camera, lights=lights)


def shown(image: Any) -> Any:
    """As it is looked at: 0 to 1, display-encoded."""
    return srgb_encode(np.clip(np.asarray(image, np.float64), 0.0, 1.0))


@functools.cache
def lamp_pictures(dtype: Any = np.float32) -> tuple[Any, Balls, Scene]:
    """The image of the core under two lights, 4 samples per pixel.

    The sum of two: a path samples one light, at random.
    """
    balls, image = rack(ROUGHNESS, METALNESS), 0.0
    options = PathOptions(max_depth=2, roulette_from=None, sampler="independent")
    for kind, place, color in LAMPS:
        lamp = (DirectionalLight if kind == "directional" else PointLight)(place, color)
        described = scene(balls, (lamp,), 24)
        tracer = PathTracer(described, dtype=dtype)
        image = image + tracer.render(spp=4, seed=3, options=options).mean
    return image, balls, described


def lamp_decibels(form: Form) -> float:
    found, balls, described = lamp_pictures()
    expected = lamp_picture(balls, LAMPS, described.camera, spp=4, seed=3, form=form)
    return psnr(shown(found), shown(expected))


def test_balls_under_lamps_are_those_of_the_second_implementation() -> None:
    assert lamp_decibels(RIGHT) > LEAST_DECIBELS  # 127.6
    found, balls, described = lamp_pictures(np.float64)
    expected = lamp_picture(balls, LAMPS, described.camera, spp=4, seed=3)
    # Black background, and reflections of lights far brighter than 1, which are not clipped.
    assert (expected.sum(axis=-1) == 0).mean() > 0.2
    assert expected.max() > 100
    assert psnr(found, expected) > 100  # 114.5; places on spheres are float


@pytest.mark.parametrize("fault", FAULTS)
def test_mistakes_under_lamps_are_seen(fault: str) -> None:
    assert lamp_decibels(Form(**FAULTS[fault])) < 45  # 15.6 to 40.7


def texels() -> Any:
    """A small sky, brighter on one side."""
    g = np.random.default_rng(8)
    image = 0.2 + 0.5 * g.random((6, 12, 3))
    image[1, 3:5] += [1.2, 1.0, 0.7]
    return image


@functools.cache
def sky_pictures() -> tuple[Any, Balls, Scene]:
    balls = rack([0.3, 0.5, 0.7, 1.0], [0.0, 1.0])
    described = scene(balls, (EnvironmentMap(texels()),), 12)
    options = PathOptions(max_depth=2, roulette_from=None)
    found = PathTracer(described).render(spp=2048, seed=3, options=options)
    return found.mean, balls, described


def sky_decibels(form: Form, count: int = 8) -> float:
    found, balls, described = sky_pictures()
    expected, inner = sky_picture(balls, texels(), described.camera, count=count, form=form)
    assert inner.sum() > 350
    return psnr(shown(found)[inner], shown(expected)[inner])


def test_balls_under_a_sky_are_those_of_quadrature() -> None:
    assert sky_decibels(RIGHT) > LEAST_DECIBELS  # 54.4, the path tracer's noise


@pytest.mark.parametrize("fault", list(FAULTS)[:3])
def test_mistakes_under_a_sky_are_seen(fault: str) -> None:
    assert sky_decibels(Form(**FAULTS[fault])) < 40  # 18.0 to 28.9
