"""Fog in closed form, beside its formula and beside paths through a homogeneous medium."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.frame import FrameOptions, FrameScene, add_fog, draw_surfaces, frame_graph
from photograd.transport import Material, PathOptions, PathTracer, Scene
from photograd.transport.builtin import builtin_scene
from photograd.transport.medium import Medium

from tests.frame import scenes

pytestmark = pytest.mark.usefixtures("core")
COLOR = np.array([0.3, 0.4, 0.5])


def glowing() -> Scene:
    """A floor and a box that emit; without a ball, whose triangles lie inside of it."""
    scene = scenes.room(None)
    shapes = [
        replace(shape, emission=np.array([0.4 + 0.3 * k, 0.8, 1.0 - 0.3 * k]))
        for k, shape in enumerate(scene.shapes[:2])
    ]
    return replace(scene, shapes=tuple(shapes), camera=scenes.camera(48, 32))


def test_it_is_the_formula_along_each_ray() -> None:
    scene = glowing()
    surfaces = draw_surfaces(FrameScene(scene, dtype=np.float64), scene.camera, "opaque")[1]
    away = surfaces.position - scene.camera.position
    distance = np.sqrt((away * away).sum(axis=-1))
    found = add_fog(surfaces.emission, surfaces.depth, scene.camera, 0.4, COLOR)
    clear = np.where(surfaces.covered, np.exp(-0.4 * distance), 0.0)[..., None]
    expected = clear * surfaces.emission + (1 - clear) * COLOR
    np.testing.assert_allclose(found, expected, rtol=1e-9)
    flat = np.exp(-0.4 * surfaces.depth)[..., None]  # depth taken for distance
    wrong = flat * surfaces.emission + (1 - flat) * COLOR
    assert np.abs(wrong - found).max() > 0.01
    np.testing.assert_array_equal(
        add_fog(surfaces.emission, surfaces.depth, scene.camera, 0.0, COLOR), surfaces.emission
    )


def test_it_is_multiplicative_along_a_ray() -> None:
    """Fog of half the density, twice, is the fog."""
    scene = glowing()
    surfaces = draw_surfaces(FrameScene(scene, dtype=np.float64), scene.camera, "opaque")[1]
    args = (surfaces.depth, scene.camera)
    half = add_fog(surfaces.emission, *args, 0.2, COLOR)
    twice = add_fog(half, *args, 0.2, COLOR)
    np.testing.assert_allclose(twice, add_fog(surfaces.emission, *args, 0.4, COLOR), rtol=1e-12)


def test_paths_through_a_medium_that_absorbs_see_the_same() -> None:
    scene, sigma = glowing(), 0.35
    black = (0.0, 0.0, 0.0)
    options = FrameOptions(fog=sigma, fog_color=black, supersampling=4, surface_points=0)
    frame = frame_graph(FrameScene(scene), options).run({"camera": scene.camera}, ["radiance"])
    foggy = replace(scene, media={"fog": Medium(sigma)}, world="fog")
    truth = PathTracer(foggy).render(spp=64, seed=0, options=PathOptions(max_depth=1)).mean
    assert truth.std() > 0.05
    difference = np.abs(frame["radiance"] - truth)
    assert np.median(difference) < 0.01 * truth.mean()  # other samples of the pixels
    assert abs(frame["radiance"].mean() / truth.mean() - 1) < 0.005
    clear = frame_graph(FrameScene(scene), replace(options, fog=0.0)).run({"camera": scene.camera})
    assert np.abs(clear["radiance"] - truth).mean() > 0.3 * truth.mean()


def test_light_as_bright_as_the_fog_stays_as_it_is() -> None:
    """As in a medium that scatters all light, between black walls that shine alike."""
    scene = builtin_scene("furnace-box", 16)
    black = {name: Material("lambert", {"albedo": [0.0] * 3}) for name in scene.materials}
    scene = replace(scene, materials=black)
    options = FrameOptions(fog=0.35, fog_color=(1.0, 1.0, 1.0), surface_points=0)
    found = frame_graph(FrameScene(scene), options).run({"camera": scene.camera}, ["radiance"])
    np.testing.assert_allclose(found["radiance"], 1.0, rtol=1e-6)
    foggy = replace(scene, media={"fog": Medium(0.35, 1.0)}, world="fog")
    truth = PathTracer(foggy).render(spp=64, seed=0, options=PathOptions(max_depth=200)).mean
    assert abs(truth.mean() - 1) < 0.01  # the mean of 16,384 paths


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"sigma_t": -1.0}, "add_fog: sigma_t"),
        ({"color": [-1.0, 0.0, 0.0]}, "add_fog: color"),
        ({"depth": np.zeros((32, 48))}, "add_fog: depth"),
    ],
)
def test_what_is_no_fog_is_refused(wrong: dict[str, Any], said: str) -> None:
    given: dict[str, Any] = {"depth": np.ones((32, 48)), "sigma_t": 0.5, "color": COLOR} | wrong
    with pytest.raises(RangeError, match=said):
        add_fog(np.ones((32, 48, 3)), camera=scenes.camera(48, 32), **given)
