"""Light gathered from the frame and the sky: closed forms, other estimators, and paths."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, RangeError
from photograd.frame import (
    FrameOptions,
    FrameScene,
    ScreenRaySettings,
    ShadowSettings,
    draw_shadow_maps,
    draw_surfaces,
    frame_graph,
    gather,
    reflect,
    reflectance_pdf,
    sample_reflectance,
    sky_lights,
)
from photograd.frame.against import compare_with_paths
from photograd.frame.gathering import nearest_shadow
from photograd.transport import Material, Scene
from photograd.transport.builtin import builtin_scene
from photograd.transport.scene import Environment
from photograd.transport.shapes import rectangle

from tests.frame import scenes

pytestmark = pytest.mark.usefixtures("core")
EVEN = Environment([0.5, 0.7, 0.9], [0.5, 0.7, 0.9], [0.5, 0.7, 0.9])
SKY = np.array([0.5, 0.7, 0.9])
GLOSSY = Material("ggx_metal", {"roughness": 0.4, "f0": [0.9, 0.6, 0.3]})
ALBEDO = np.array([0.6, 0.5, 0.4])


def surfaces(scene: Scene) -> tuple[FrameScene, Any]:
    ready = FrameScene(scene, dtype=np.float64)
    return ready, draw_surfaces(ready, scene.camera, "opaque")[1]


@pytest.mark.parametrize("material", [scenes.GRAY, GLOSSY], ids=["lambert", "metal"])
def test_samples_are_those_of_the_reflectance(material: Material) -> None:
    """weight pdf = f cos: what a directional light of that direction is reflected as."""
    ready, shown = surfaces(scenes.room(None, material))
    u = np.random.default_rng(1).uniform(0, 1, (64, 96, 3))
    found = sample_reflectance(ready, shown, u)
    chosen = found.wi.any(axis=-1) & shown.covered
    assert chosen.sum() > 0.95 * shown.covered.sum()
    np.testing.assert_allclose(np.linalg.norm(found.wi[chosen], axis=-1), 1.0, rtol=1e-12)
    again = reflectance_pdf(ready, shown, found.wi)
    np.testing.assert_allclose(again[chosen], found.pdf[chosen], rtol=1e-9)
    value = np.zeros_like(found.weight)
    reflect(ready, shown, found.wi, np.ones_like(found.wi), value)
    expected = found.weight * found.pdf[..., None]
    np.testing.assert_allclose(value[chosen], expected[chosen], rtol=1e-9, atol=1e-12)
    assert not found.wi[~shown.covered].any()


def gathered(scene: Scene, samples: int = 16, sky_directions: int = 0, light: Any = None) -> Any:
    ready, shown = surfaces(scene)
    light = np.zeros_like(shown.position) if light is None else light(shown)
    rays = ScreenRaySettings(length=6.0, thickness=10.0, steps=96)
    return shown, gather(ready, shown, light, rays, samples=samples, sky_directions=sky_directions)


@pytest.mark.parametrize("visibility", ["occlusion", "horizon", "directional", "shadow_maps"])
@pytest.mark.parametrize("samples", [0, 8])
def test_an_even_sky_without_occluders_is_exact(visibility: Any, samples: int) -> None:
    """A matte floor sends on albedo times the sky: B34 and B42."""
    scene = replace(scenes.room(None), shapes=(scenes.floor(),), environment=EVEN)
    options = FrameOptions(
        sky_directions=64,
        sky_visibility=visibility,
        gather_samples=samples,
        shadows=ShadowSettings(size=64),
    )
    graph = frame_graph(FrameScene(scene, dtype=np.float64), options)
    found = graph.run({"camera": scene.camera}, ["gbuffer", "sky_light", "gathered"])
    covered = found["gbuffer"].covered
    radiance = (found["sky_light"] + found["gathered"])[covered]
    # The directions of the sky are a rule with 64 points; where both are weighted, it is smaller.
    np.testing.assert_allclose(radiance.mean(axis=0), ALBEDO * SKY, rtol=0.01)
    np.testing.assert_allclose(radiance, np.broadcast_to(ALBEDO * SKY, radiance.shape), rtol=0.15)


def test_matte_samples_of_an_even_sky_are_exact_each() -> None:
    scene = replace(scenes.room(None), shapes=(scenes.floor(),), environment=EVEN)
    shown, found = gathered(scene, samples=4, sky_directions=0)
    assert not found.any()
    # One direction of the sky weighs nothing beside many of the reflectance.
    _, found = gathered(scene, samples=512, sky_directions=1)
    covered = found[shown.covered]
    np.testing.assert_allclose(covered, np.broadcast_to(ALBEDO * SKY, covered.shape), rtol=0.02)


def corner() -> Scene:
    """A floor before a long wall 1 m high."""
    floor = rectangle(
        "floor", [-9.0, 0.0, 3.0], [18.0, 0.0, 0.0], [0.0, 0.0, -3.0], "gray", [0] * 3
    )
    wall = rectangle("wall", [-9.0, 0.0, 0.0], [18.0, 0.0, 0.0], [0.0, 1.0, 0.0], "gray", [0] * 3)
    # All of the wall that matters is in the picture: rays see nothing beside it.
    wide = replace(scenes.camera(192, 128), fx=60.0, fy=60.0)
    return Scene("corner", (floor, wall), {"gray": scenes.GRAY}, wide)


def test_a_wall_lights_the_floor_as_its_form_factor_says() -> None:
    """A floor at the distance z from a wall of radiance 1: albedo (1 - z / sqrt(z^2 + h^2)) / 2."""

    def glows(shown: Any) -> Any:
        on_wall = shown.covered & (shown.position[..., 1] > 1e-6)
        return np.where(on_wall[..., None], 1.0, np.zeros((1, 1, 3)))

    shown, found = gathered(corner(), samples=64, light=glows)
    z, around = shown.position[..., 2], np.abs(shown.position[..., 0]) < 0.5
    on_floor = shown.covered & around & (np.abs(shown.position[..., 1]) < 1e-6)
    on_floor &= (z > 0.1) & (z < 1.1)
    truth = 0.5 * (1 - z / np.sqrt(z * z + 1))
    ratio = (found[..., 0] / ALBEDO[0] / np.maximum(truth, 1e-9))[on_floor]
    assert on_floor.sum() > 200
    # Single pixels have the noise of 64 samples; strips of one distance have the mean.
    rows = [ratio[np.abs(z[on_floor] - at) < 0.05].mean() for at in np.arange(0.15, 1.1, 0.1)]
    assert np.abs(np.array(rows) - 1).max() < 0.1


def test_all_samples_share_the_sky_with_its_directions() -> None:
    """A glossy floor under an uneven sky: the sum does not depend on who samples how much."""
    sky = Environment([0.2, 0.4, 1.0], [1.2, 0.9, 0.6], [0.1, 0.1, 0.1])
    scene = replace(scenes.room(None, GLOSSY), shapes=(scenes.floor(),), environment=sky)
    sums = []
    for directions, samples in ((512, 0), (64, 64), (16, 256)):
        options = FrameOptions(
            sky_directions=directions, sky_visibility="none", gather_samples=samples
        )
        graph = frame_graph(FrameScene(scene, dtype=np.float64), options)
        found = graph.run({"camera": scene.camera}, ["gbuffer", "sky_light", "gathered"])
        both = found["sky_light"] + found["gathered"]
        sums.append(both[found["gbuffer"].covered].mean(axis=0))
    np.testing.assert_allclose(sums[1], sums[2], rtol=0.01)
    np.testing.assert_allclose(sums[0], sums[2], rtol=0.03)


def test_light_that_is_sent_on_twice_comes_nearer_to_paths() -> None:
    """All light of a room under a sky: with gathering, the frame is nearer to the truth."""
    sky = Environment([0.6, 0.8, 1.0], [0.9, 0.9, 0.9], [0.2, 0.2, 0.2])
    scene = replace(scenes.room(None), environment=sky, camera=scenes.camera(48, 32))
    common = FrameOptions(
        sky_directions=48,
        sky_visibility="shadow_maps",
        supersampling=2,
        shadows=ShadowSettings(size=256),
        screen_rays=ScreenRaySettings(length=2.0, thickness=1.0, steps=32),
    )
    errors = {}
    for samples in (0, 16):
        options = replace(common, gather_samples=samples)
        one, whole = compare_with_paths(scene, options, spp=128, max_depth=4)
        errors[samples] = whole.rms
        assert one.rms < 0.025
    assert errors[16] < 0.8 * errors[0]


def test_specular_metal_shows_what_the_frame_shows() -> None:
    """A mirror before a glowing wall: reflections in screen space are pixels of the picture."""
    mirror = Material("mirror", {"reflectance": [0.9, 0.8, 0.7]})
    scene = corner()
    scene = replace(
        scene,
        shapes=(replace(scene.shapes[0], material="mirror"), scene.shapes[1]),
        materials={"gray": scenes.GRAY, "mirror": mirror},
    )

    def glows(shown: Any) -> Any:
        return np.where((shown.position[..., 1:2] > 1e-6), [[[0.5, 1.0, 2.0]]], 0.0)

    shown, found = gathered(scene, samples=1, light=glows)
    on_floor = shown.covered & (np.abs(shown.position[..., 1]) < 1e-6)
    lit = on_floor & found.any(axis=-1)
    assert lit.sum() > 200
    np.testing.assert_allclose(
        found[lit], np.broadcast_to([0.45, 0.8, 1.4], found[lit].shape), rtol=0.02
    )
    # The reflection of the eye sees the wall up to its height.
    eye = scene.camera.position
    z = shown.position[..., 2]
    rises = eye[1] * z / np.maximum(eye[2] - z, 1e-9)  # where the reflected ray meets z = 0
    assert lit[on_floor & (rises < 0.9) & (np.abs(shown.position[..., 0]) < 1)].mean() > 0.9
    beyond = on_floor & (rises > 1.1)
    assert beyond.any()
    assert not lit[beyond].any()


def test_where_maps_tell_what_hides_the_sky_the_depths_of_the_frame_do_not() -> None:
    """A ray behind a ball is stopped by it, or not, as thick as surfaces are thought to be."""
    ready, shown = surfaces(replace(scenes.room(None), environment=EVEN))
    sky, settings = sky_lights(ready, 16), ShadowSettings(size=64)
    shadows = draw_shadow_maps(ready, sky, settings)

    def sky_alone(thickness: float, maps: bool, light: Any) -> Any:
        def visible(wi: Any) -> Any:
            return nearest_shadow(shown, wi, sky, shadows, settings)

        rays = ScreenRaySettings(length=3.0, thickness=thickness, steps=32)
        asked = visible if maps else None
        return gather(ready, shown, light, rays, samples=2, sky_directions=16, sky_visibility=asked)

    dark = np.zeros_like(shown.position)
    thin, thick = (sky_alone(by, True, dark) for by in (0.01, 50.0))
    np.testing.assert_array_equal(thin, thick)
    np.testing.assert_array_equal(thin, sky_alone(0.01, True, None))
    assert thin.any()
    assert np.abs(sky_alone(0.01, False, None) - sky_alone(50.0, False, None)).max() > 0.1


def test_mistakes_are_named() -> None:
    ready, shown = surfaces(scenes.room(None))
    rays = ScreenRaySettings()
    with pytest.raises(RangeError, match="gather: samples"):
        gather(ready, shown, np.zeros_like(shown.position), rays, samples=0)
    with pytest.raises(RangeError, match="sample_reflectance: u"):
        sample_reflectance(ready, shown, np.full((64, 96, 3), 1.0))
    with pytest.raises(DtypeError, match="ScreenRaySettings: steps"):
        ScreenRaySettings(steps=1.5)  # type: ignore[arg-type]


def test_the_sky_in_smooth_metal_is_that_of_paths() -> None:
    """Balls of clay and copper under a low sun: directions of the sky alone show as spots."""
    scene = builtin_scene("evening", 64)
    shapes = tuple(shape for shape in scene.shapes if shape.material != "glass")
    scene = replace(scene, shapes=shapes)
    errors = []
    for samples in (0, 8):
        options = FrameOptions(
            sky_directions=96,
            sky_visibility="shadow_maps",
            supersampling=2,
            shadows=ShadowSettings(size=512),
            gather_samples=samples,
        )
        (found,) = compare_with_paths(scene, options, spp=128, max_depth=2)
        errors.append(found.rms)
    assert errors[1] < 0.025
    assert errors[0] > 2 * errors[1]
