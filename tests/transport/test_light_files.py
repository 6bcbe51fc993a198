"""Lights in scene files: what they become, and everything that can be wrong with one."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import SceneError
from photograd.images.exr import encode_exr
from photograd.images.write import write_radiance
from photograd.lights import EnvironmentMap, Light, SpotLight, SunLight
from photograd.transport import PathTracer, builtin_scene, read_scene

TEXT = """\
[camera]
position = [0, 1, 4]
look_at = [0, 0.5, 0]
field_of_view = 40
size = [8, 6]
[materials.gray]
model = "lambert"
albedo = [0.5, 0.5, 0.5]
[[shapes]]
kind = "sphere"
center = [0, 0.5, 0]
radius = 0.5
material = "gray"
"""
LIGHTS = """\
[[lights]]
kind = "point"
position = [0, 3, 1]
intensity = 10
[[lights]]
kind = "spot"
position = [0, 3, 0]
axis = [0, -2, 0]
intensity = [3, 2, 1]
angle = 60
softness = 0.5
[[lights]]
kind = "directional"
direction = [1, 2, 0]
irradiance = 2
[[lights]]
kind = "ambient"
radiance = 0.1
[[lights]]
kind = "sky"
zenith = 0.3
horizon = 0.2
ground = 0.1
[[lights]]
kind = "sun"
direction = [0, 1, 1]
radiance = 100
angle = 2
[[lights]]
kind = "rectangle"
corner = [-1, 2, -1]
edge_x = [2, 0, 0]
edge_y = [0, 0, 2]
radiance = 1
[[lights]]
kind = "sphere"
center = [2, 1, 0]
radius = 0.2
radiance = 3
[[lights]]
kind = "triangle"
a = [-2, 2, 0]
b = [-2, 2, 1]
c = [-2, 1, 0]
radiance = 3
[[lights]]
kind = "environment"
image = "sky.exr"
turn = 90
scale = 2
uniform_share = 0.1
"""
FIRST = 1 + TEXT.count("\n")  # line of the first light


def write(folder: Path, lights: str, image: Any = None) -> Path:
    pixels = np.random.default_rng(1).random((4, 8, 3)) if image is None else image
    (folder / "sky.exr").write_bytes(encode_exr(np.asarray(pixels, np.float32), half=False))
    path = folder / "scene.toml"
    path.write_text(TEXT + lights, encoding="utf-8")
    return path


def test_every_kind_is_read(tmp_path: Path) -> None:
    scene = read_scene(write(tmp_path, LIGHTS))
    assert [type(light).__name__ for light in scene.lights] == [
        "PointLight",
        "SpotLight",
        "DirectionalLight",
        "ConstantLight",
        "SkyLight",
        "SunLight",
        "QuadLight",
        "SphereLight",
        "TriangleLight",
        "EnvironmentMap",
    ]
    spot, sun, sky = scene.lights[1], scene.lights[5], scene.lights[9]
    assert isinstance(spot, SpotLight)
    assert spot.cos_outer == pytest.approx(0.5)
    np.testing.assert_allclose(spot.axis, [0, -1, 0])
    np.testing.assert_array_equal(spot.intensity, [3, 2, 1])
    assert isinstance(sun, SunLight)
    assert sun.height == pytest.approx(1 - np.cos(np.radians(2)))
    assert isinstance(sky, EnvironmentMap)
    plain = np.random.default_rng(1).random((4, 8, 3)).astype(np.float32)
    np.testing.assert_allclose(sky.texels, 2 * plain)
    assert sky.uniform_share == 0.1
    # What the middle of the picture shows has come from +Z to +X.
    np.testing.assert_allclose(sky.world_from_map @ [0, 0, 1], [1, 0, 0], atol=1e-15)
    tracer = PathTracer(scene)
    assert (tracer.render(spp=4, seed=1).mean > 0).any()
    for i, light in enumerate(scene.lights):
        assert any(name.startswith(f"lights.{i}.") for name in tracer.params), light
    assert set(dataclasses.asdict(spot)) >= {"position", "axis", "intensity"}


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ('kind = "point"', 'kind = "pint"', 1, "lights.0.kind: expected one of"),
        ('kind = "point"', "kind = 3", 1, "lights.0.kind: expected a string"),
        ("intensity = 10", "intensity = -1", 3, "lights.0.intensity: expected a radiance"),
        ("intensity = 10", "intensity = nan", 3, "lights.0.intensity"),
        ("intensity = 10\n", "", 0, "lights.0.intensity: expected a value, got none"),
        ("intensity = 10", "intensity = 10\npower = 3", 4, "lights.0.power: expected a key that"),
        ("position = [0, 3, 1]", "position = [0, 3]", 2, "3 finite numbers"),
        (
            "axis = [0, -2, 0]",
            "axis = [0, 0, 0]",
            4,
            "lights.1: SpotLight: axis: expected a direction",
        ),
        ("angle = 60", "angle = 190", 9, "lights.1.angle: expected degrees"),
        ("softness = 0.5", "softness = 0", 4, "softness: expected a number in (0, 1]"),
        ("direction = [1, 2, 0]", 'direction = "up"', 13, "3 finite numbers"),
        ("edge_y = [0, 0, 2]", "edge_y = [0, 0, 0]", 28, "edges of some length"),
        ("edge_y = [0, 0, 2]", "edge_y = [1, 0, 2]", 28, "perpendicular edges"),
        ("radius = 0.2", "radius = 0", 34, "radius: expected a positive number"),
        ("c = [-2, 1, 0]", "c = [-2, 2, 2]", 39, "corners that span an area"),
        ('image = "sky.exr"', 'image = "sky.png"', 47, "lights.9.image: expected a name"),
        ('image = "sky.exr"', 'image = "none.exr"', 45, "lights.9"),
        ("scale = 2", "scale = -2", 49, "lights.9.scale: expected a number of at least 0"),
        ("uniform_share = 0.1", "uniform_share = 2", 45, "uniform_share: expected a number in"),
    ],
)
def test_a_mistake_is_named_with_line_and_key(
    tmp_path: Path, old: str, new: str, line: int, words: str
) -> None:
    assert LIGHTS.count(old) >= 1
    with pytest.raises(SceneError) as caught:
        read_scene(write(tmp_path, LIGHTS.replace(old, new, 1)))
    text = str(caught.value)
    assert f"line {FIRST + line}:" in text, text
    assert words in text, text


@pytest.mark.parametrize(
    ("image", "words"),
    [
        (np.full((4, 8, 3), np.nan), "finite"),
        (np.full((4, 8, 3), -1.0), "numbers from 0 to 1e30"),
        (np.ones((4, 4, 3)), "expected shape (H, 2 H, 3)"),
        (np.ones((8, 4, 3)), "expected shape (H, 2 H, 3)"),
    ],
)
def test_pictures_that_are_no_environment_are_refused(
    tmp_path: Path, image: Any, words: str
) -> None:
    with pytest.raises(SceneError, match=r"lights\.9") as caught:
        read_scene(write(tmp_path, LIGHTS, image))
    assert f"line {FIRST + 45}:" in str(caught.value)
    assert words in str(caught.value)


@pytest.mark.parametrize("suffix", [".hdr", ".pfm"])
def test_maps_of_other_formats_are_the_same_light(tmp_path: Path, suffix: str) -> None:
    pixels = np.random.default_rng(2).random((4, 8, 3)).astype(np.float32) * np.float32(1e4)
    expected = read_scene(write(tmp_path, LIGHTS, pixels)).lights[9]
    write_radiance(tmp_path / f"sky{suffix}", pixels)
    path = write(tmp_path, LIGHTS.replace("sky.exr", f"sky{suffix}"))
    found = read_scene(path).lights[9]
    assert isinstance(expected, EnvironmentMap)
    assert isinstance(found, EnvironmentMap)
    largest = expected.texels.max(axis=-1, keepdims=True)
    bound = largest / 256 if suffix == ".hdr" else 0 * largest
    assert (np.abs(found.texels - expected.texels) <= bound).all()
    path.write_text(path.read_text("utf-8").replace(f"sky{suffix}", "sky.png"), "utf-8")
    with pytest.raises(SceneError, match=r"a name that ends in \.exr or \.hdr or \.pfm"):
        read_scene(path)


def test_lights_are_tables(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"tables \[\[lights\]\]"):
        read_scene(write(tmp_path, '[lights]\nkind = "point"\n'))


def test_the_evening_has_a_sun() -> None:
    scene = builtin_scene("evening", 8)
    (light,) = scene.lights
    assert isinstance(light, Light)
    w = np.array([[0.62, 0.26, 0.44], [-0.62, 0.26, -0.44]])
    w /= np.linalg.norm(w, axis=1, keepdims=True)
    toward, away = light.L(np.zeros((2, 3)), w)
    assert (toward > 100 * away).all()
    assert 0.1 < PathTracer(scene).render(spp=64, seed=1).mean.mean() < 1
