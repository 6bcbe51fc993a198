"""Lit surfaces beside paths of two segments; deferred beside forward; masks and layers."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import SceneError
from photograd.frame import (
    FrameOptions,
    FrameScene,
    ShadowSettings,
    delta_lights,
    draw_shadow_maps,
    draw_surfaces,
    frame_graph,
    light_surfaces,
)
from photograd.frame.against import compare_with_paths
from photograd.frame.lighting import light_forward
from photograd.transport import Material, PathOptions, PathTracer, Texture, TextureUse
from photograd.transport.builtin import builtin_scene
from photograd.transport.scene import Environment
from photograd.transport.shapes import rectangle

from tests.frame import scenes

pytestmark = pytest.mark.usefixtures("core")
GLOSSY = Material("ggx_metal", {"roughness": 0.4, "f0": [0.9, 0.6, 0.3]})
SMALL = ShadowSettings(size=256)


def lit(scene: Any, dtype: Any = np.float64, shadows: bool = True) -> tuple[Any, Any]:
    ready = FrameScene(scene, dtype=dtype, sphere_divisions=64)
    visible = draw_surfaces(ready, scene.camera, "opaque", "mask")[1]
    lights = delta_lights(ready)
    maps = draw_shadow_maps(ready, lights, SMALL) if shadows else {}
    return visible, light_surfaces(ready, visible, lights, maps, SMALL)


@pytest.mark.parametrize("light", scenes.LIGHTS)
def test_a_matte_floor_has_the_radiance_of_its_formula(light: str) -> None:
    source = scenes.LIGHTS[light]
    scene = replace(scenes.room(source), shapes=(scenes.floor(),))
    visible, found = lit(scene, shadows=False)
    points = visible.position[visible.covered]
    sample = source.sample(points, np.full((len(points), 2), 0.5))
    cosine = np.maximum(sample.direction[:, 1:2], 0.0)
    radiance = np.where(sample.pdf[:, None] > 0, sample.radiance, 0.0)
    expected = np.array([0.6, 0.5, 0.4]) / np.pi * cosine * radiance
    np.testing.assert_allclose(found[visible.covered], expected, rtol=1e-10, atol=1e-14)
    assert found.any()


@pytest.mark.parametrize("material", [scenes.GRAY, GLOSSY], ids=["lambert", "metal"])
def test_paths_of_two_segments_see_the_same(material: Material) -> None:
    scene = scenes.room(scenes.LIGHTS["point"], material)
    _, found = lit(scene)
    truth = PathTracer(scene).render(spp=64, seed=0, options=PathOptions(max_depth=2)).mean
    difference = np.abs(found - truth).max(axis=-1)
    # What remains are edges, of which paths see a pixel's mean.
    assert np.median(difference) < 2e-3 * truth.mean()
    assert np.mean(difference > 0.1 * truth.mean()) < 0.08
    assert found.any()


def test_forward_and_deferred_shading_make_one_picture() -> None:
    scene = scenes.room(scenes.LIGHTS["point"], GLOSSY)
    ready = FrameScene(scene)
    lights = delta_lights(ready)
    maps = draw_shadow_maps(ready, lights, SMALL)
    visible = draw_surfaces(ready, scene.camera, "opaque", "mask")[1]
    deferred = light_surfaces(ready, visible, lights, maps, SMALL)
    forward, shaded = light_forward(ready, scene.camera, lights, maps, SMALL)
    np.testing.assert_allclose(forward, deferred, atol=1e-5)
    assert shaded > visible.covered.sum()  # of hidden surfaces, too


def checker(size: int, low: float) -> Any:
    texels = np.indices((size, size)).sum(axis=0) % 2
    return Texture(np.where(texels, 1.0, low)[..., None].astype(np.float32), ("clamp", "clamp"))


def with_uv(shape: Any) -> Any:
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], np.float32)
    return replace(shape, uv=corners[: len(shape.vertices)])


def sheet(material: str, z: float) -> Any:
    """A square that faces the camera."""
    flat = rectangle(f"at {z}", [-1, -0.2, z], [2, 0, 0], [0, 2, 0], material, [0, 0, 0])
    return with_uv(flat)


def test_masks_are_looked_through_and_cast_shadows_with_holes() -> None:
    mask = Material(
        "lambert",
        {"albedo": [0.0, 0.0, 0.0], "alpha": 1.0},
        {"alpha": TextureUse("holes")},
        alpha_cutoff=0.5,
    )
    scene = scenes.room(scenes.LIGHTS["directional"])
    scene = replace(
        scene,
        shapes=(scenes.floor(), sheet("mask", 0.3), sheet("mask", -0.6)),
        materials={"gray": scenes.GRAY, "mask": mask},
        textures={"holes": checker(4, 0.0)},
    )
    frame = frame_graph(FrameScene(scene), FrameOptions(sky_directions=0, shadows=SMALL))
    found = frame.run({"camera": scene.camera}, ["radiance"])["radiance"]
    # A mask that reflects nothing: light is sent on once, through as many holes as there are.
    truth = PathTracer(scene).render(spp=64, seed=0, options=PathOptions(max_depth=8)).mean
    assert np.median(np.abs(found - truth)) < 5e-3 * truth.mean()
    assert np.mean(np.abs(found - truth) > 0.2 * truth.mean()) < 0.2


def test_layers_that_cover_in_part_are_peeled_whatever_their_order() -> None:
    veils = {
        name: Material("lambert", {"albedo": color, "alpha": 0.5})
        for name, color in {"red": [0.8, 0.1, 0.1], "blue": [0.1, 0.1, 0.8]}.items()
    }
    scene = scenes.room(scenes.LIGHTS["directional"])
    pictures = []
    for shapes in (("red", 0.3), ("blue", 0.1)), (("blue", 0.1), ("red", 0.3)):
        sheets = tuple(sheet(name, z) for name, z in shapes)
        one = replace(
            scene, shapes=(scenes.floor(), *sheets), materials={"gray": scenes.GRAY, **veils}
        )
        graph = frame_graph(FrameScene(one), FrameOptions(sky_directions=0, shadows=SMALL))
        pictures.append(graph.run({"camera": one.camera}, ["radiance"])["radiance"])
    np.testing.assert_array_equal(pictures[0], pictures[1])
    light = scenes.LIGHTS["directional"]
    toward = np.asarray(light.direction)
    facing, above = (np.asarray(light.irradiance) / np.pi * toward[k] for k in (2, 1))
    red, blue = (veils[name].values["albedo"] for name in veils)
    expected = 0.5 * facing * red + 0.25 * facing * blue + 0.25 * above * [0.6, 0.5, 0.4]
    np.testing.assert_allclose(pictures[0][32, 48], expected, rtol=1e-5)


def test_the_light_of_the_cornell_box_is_that_of_paths() -> None:
    scene = builtin_scene("cornell-box", 48)
    options = FrameOptions(surface_points=9, supersampling=3, shadows=SMALL)
    direct, whole = compare_with_paths(scene, options, spp=256, max_depth=8)
    assert (direct.technique, whole.technique) == ("direct light", "all light")
    assert direct.rms < 0.025
    assert whole.rms > 2 * direct.rms  # what is sent on twice is not there


def test_a_sky_seen_through_shadow_maps_is_that_of_paths() -> None:
    sky = Environment([0.6, 0.8, 1.0], [0.9, 0.9, 0.9], [0.2, 0.2, 0.2])
    scene = replace(scenes.room(None), environment=sky, camera=scenes.camera(48, 32))
    options = FrameOptions(
        sky_directions=48, sky_visibility="shadow_maps", supersampling=2, shadows=SMALL
    )
    (found,) = compare_with_paths(scene, options, spp=128, max_depth=2)
    assert found.technique == "sky light"
    assert found.rms < 0.02


def test_what_a_rasterizer_cannot_draw_is_named() -> None:
    with pytest.raises(SceneError, match="a signed distance function"):
        FrameScene(builtin_scene("carved", 16))
    with pytest.raises(SceneError, match=r"FrameScene: scene\.shapes: .*which moves"):
        FrameScene(builtin_scene("thrown", 16))
