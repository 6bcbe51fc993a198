"""What bodies of glTF files swallow: KHR_materials_volume as an interior medium."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.transport import Environment, PathOptions, PathTracer, Scene, read_scene
from photograd.transport.builtin import camera_at
from photograd.transport.shapes import box

from tests.transport.gltf_samples import Glb, core
from tests.transport.test_gltf_materials import clear
from tests.transport.test_mesh_files import read

pytestmark = pytest.mark.usefixtures("core")
COLOR = [0.5, 0.25, 1.0]
VOLUME = {"thicknessFactor": 1, "attenuationDistance": 0.5, "attenuationColor": COLOR}


def body(volume: dict[str, Any], *, closed: bool = True) -> Glb:
    """A cube of 1 m of clear glass, or five of its sides."""
    cube = box("cube", [0, 0, 0], [1, 1, 1], "m")
    glb = Glb()
    entries = core(metallicFactor=0, roughnessFactor=0) | clear(volume=volume)
    faces = np.asarray(cube.faces, np.uint16)
    number = glb.material(name="m", **entries)
    vertices = np.asarray(cube.vertices, np.float32)
    glb.node(glb.mesh(vertices, faces if closed else faces[:-2], None, material=number))
    return glb


def test_the_color_of_light_after_a_distance(tmp_path: Path) -> None:
    model, told = read(tmp_path, body(VOLUME).bytes())
    assert told == []
    (shape,) = model.shapes
    assert shape.interior == "m"
    np.testing.assert_allclose(model.media["m"].sigma_t, -np.log(COLOR) / 0.5, rtol=1e-12)
    assert model.media["m"].albedo is None
    # Straight through a meter, twice the distance, with what is mirrored inside; the sky is 1.
    a, R = np.square(COLOR), 0.04
    expected = R + (1 - R) ** 2 * a / (1 - R * a)
    camera = camera_at([0, 0, 5], [0, 0, 0], 0.01, 1, 1)
    scene = Scene(
        "s", model.shapes, model.materials, camera, Environment.constant(1.0), media=model.media
    )
    options = PathOptions(max_depth=40, sampler="independent")
    found = PathTracer(scene, dtype=np.float64).render(spp=4096, seed=1, options=options)
    error = found.standard_error[0, 0]
    assert (error < 0.02).all()
    assert (np.abs(found.mean[0, 0] - expected) < 4 * error + 1e-6).all()


@pytest.mark.parametrize(
    "volume",
    [
        {"thicknessFactor": 1},
        {"thicknessFactor": 1, "attenuationDistance": 2},
        {"thicknessFactor": 1, "attenuationColor": COLOR},
        VOLUME | {"attenuationColor": [1, 1, 1]},
        VOLUME | {"thicknessFactor": 0},
    ],
)
def test_what_swallows_nothing_has_no_medium(tmp_path: Path, volume: dict[str, Any]) -> None:
    model, told = read(tmp_path, body(volume).bytes())
    assert told == []
    assert not model.media
    assert model.shapes[0].interior is None


def test_what_cannot_be_filled_is_named(tmp_path: Path) -> None:
    model, told = read(tmp_path, body(VOLUME, closed=False).bytes())
    assert not model.media
    assert any("an open mesh has no inside: attenuation left out" in text for text in told), told

    model, told = read(tmp_path, body(VOLUME | {"attenuationDistance": -1}).bytes())
    assert not model.media
    assert any("attenuationDistance: -1.0, left out" in text for text in told), told

    glb = body(VOLUME)
    veil = glb.material(alphaMode="BLEND", **core(baseColorFactor=[1, 1, 1, 0.5]))
    glb.node(glb.mesh(material=veil))
    model, told = read(tmp_path, glb.bytes())
    assert list(model.media) == ["m"]
    assert not any("left out" in text for text in told), told


def test_a_scene_file_takes_the_media_of_its_models(tmp_path: Path) -> None:
    (tmp_path / "cube.glb").write_bytes(body(VOLUME).bytes())
    text = """
[camera]
size = [2, 2]
position = [0, 0, 5]
look_at = [0, 0, 0]
field_of_view = 10
[environment]
radiance = [1, 1, 1]
[materials.paint]
model = "lambert"
albedo = [0.5, 0.5, 0.5]
[[shapes]]
kind = "mesh"
name = "own"
file = "cube.glb"
[[shapes]]
kind = "mesh"
name = "painted"
file = "cube.glb"
material = "paint"
"""
    (tmp_path / "s.toml").write_text(text, encoding="utf-8")
    scene = read_scene(tmp_path / "s.toml")
    assert set(scene.media) == {"own/m"}
    interiors = {shape.name.split("/")[0]: shape.interior for shape in scene.shapes}
    assert interiors == {"own": "own/m", "painted": None}
    assert PathTracer(scene).render(spp=1, seed=1).mean.shape == (2, 2, 3)
