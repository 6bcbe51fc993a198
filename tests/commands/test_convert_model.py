"""Scenes and meshes, converted to glTF."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from photograd.transport import read_model

from tests.commands.conftest import Photograd

SCENE = """
[camera]
position = [0, 1, 5]
look_at = [0, 0, 0]
field_of_view = 30
size = [8, 8]
[[lights]]
kind = "point"
position = [1, 3, 2]
intensity = [9, 8, 7]
[materials.paint]
model = "gltf_sheen"
base_color = [0.5, 0.25, 0.125]
metalness = 0
roughness = 0.5
sheen_color_factor = [0.75, 0.5, 0.25]
sheen_roughness_factor = 0.5
[[shapes]]
kind = "box"
name = "cube"
center = [0, 0.5, 0]
size = [1, 1, 1]
material = "paint"
"""


def test_a_scene_becomes_gltf(photograd: Photograd, tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text(SCENE, encoding="utf-8")
    done = photograd("convert", tmp_path / "s.toml", tmp_path / "s.glb", "--json")
    assert done.code == 0, done.err
    result = done.result()
    assert (result["shapes"], result["triangles"], result["materials"]) == (1, 12, 1)
    assert result["bytes_out"] == (tmp_path / "s.glb").stat().st_size
    assert result["notes"] == []
    model = read_model(tmp_path / "s.glb")
    assert [type(light).__name__ for light in model.lights] == ["PointLight"]
    np.testing.assert_allclose(np.degrees(model.cameras[0].field_of_view), 30)
    material = model.materials["paint"]
    assert material.model == "gltf_sheen"
    np.testing.assert_array_equal(material.values["base_color"], [0.5, 0.25, 0.125])
    again = photograd("convert", tmp_path / "s.glb", tmp_path / "s.gltf", "--json")
    assert again.code == 0, again.err
    assert again.result()["notes"] == []


def test_what_cannot_be_converted_is_refused(photograd: Photograd, tmp_path: Path) -> None:
    ball = SCENE.replace('"box"', '"sphere"').replace("size = [1, 1, 1]", "radius = 1")
    (tmp_path / "s.toml").write_text(ball, encoding="utf-8")
    done = photograd("convert", tmp_path / "s.toml", tmp_path / "s.glb")
    assert done.code == 1
    assert "shape 'cube' is no mesh" in done.err
    assert not (tmp_path / "s.glb").exists()
    (tmp_path / "m.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert photograd("convert", tmp_path / "m.obj", tmp_path / "m.glb").code == 0
    done = photograd("convert", tmp_path / "m.glb", tmp_path / "m.glb")
    assert done.code == 1
    assert "another file than IN" in done.err
