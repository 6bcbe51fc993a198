"""Mesh files and textures in scene files, and mistakes there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.errors import SceneError
from photograd.transport import MeshShape, PathTracer, Scene, read_scene
from PIL import Image

from tests.transport.gltf_samples import core, square

TEXT = """\
[camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
field_of_view = 40
size = [8, 6]

[environment]
radiance = 1

[textures.paint]
file = "paint.png"

[textures.rough]
file = "paint.png"
encoding = "linear"
wrap = "clamp"

[materials.floor]
model = "gltf"
base_color = [1, 1, 1]
metalness = 0
roughness = 1
textures = { base_color = "paint", roughness = ["rough", 1] }
normal_map = "bumps.png"

[[shapes]]
kind = "mesh"
name = "own"
file = "square.glb"
scale = 2
rotate = [0, 0, 90]
translate = [1, 0, 0]

[[shapes]]
kind = "mesh"
file = "square.glb"
material = "floor"
emission = 0.5
instances = [{ translate = [0, 0, -1] }, { translate = [0, 0, -2], scale = [1, 2, 1] }]

[[shapes]]
kind = "rectangle"
corner = [-1, -1, 0]
edge_u = [2, 0, 0]
edge_v = [0, 0, -2]
material = "floor"
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    pixels = np.full((2, 2, 3), 128, np.uint8)
    Image.fromarray(pixels).save(tmp_path / "paint.png")
    Image.fromarray(np.full((1, 1, 3), (128, 128, 255), np.uint8)).save(tmp_path / "bumps.png")
    red = square(**core(baseColorFactor=[1, 0, 0, 1], metallicFactor=0))
    red.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {
        "index": red.image(pixels)
    }
    (tmp_path / "square.glb").write_bytes(red.bytes())
    return tmp_path


def read(folder: Path, text: str) -> Scene:
    (folder / "scene.toml").write_text(text, encoding="utf-8")
    return read_scene(folder / "scene.toml")


def test_meshes_and_textures_from_a_scene_file(folder: Path) -> None:
    scene = read(folder, TEXT)
    first, second = scene.shapes[:2]
    assert isinstance(first, MeshShape)
    assert isinstance(second, MeshShape)
    assert first.name == "own/mesh 0"
    assert first.material == "own/m"
    # The corner (1, 0, 0) is scaled to (2, 0, 0), turned to (0, 2, 0) and moved.
    np.testing.assert_allclose(first.vertices[1], [1, 2, 0], atol=1e-6)
    assert second.material == "floor"
    np.testing.assert_array_equal(second.emission, [0.5] * 3)
    assert len(second.instances) == 2
    np.testing.assert_allclose(second.box, [[0, 0, -2], [1, 2, -1]])
    own = scene.materials["own/m"]
    assert own.values["base_color"].tolist() == [1, 0, 0]
    assert own.textures["base_color"].texture in scene.textures
    floor = scene.materials["floor"]
    assert floor.textures["roughness"].channel == 1
    assert scene.textures["rough"].wrap == ("clamp", "clamp")
    np.testing.assert_allclose(scene.textures["paint"].values, 0.2158605, atol=1e-6)
    np.testing.assert_allclose(scene.textures["rough"].values, 128 / 255, atol=1e-7)
    assert floor.normal_map is not None
    picture = PathTracer(scene).render(spp=2, seed=1).mean
    # Of two samples both may be lost below the horizon of a rough lobe.
    assert (picture.sum(axis=2) > 0).mean() > 0.9


def test_a_scene_needs_no_materials_of_its_own(folder: Path) -> None:
    head, tail = TEXT.split("[textures.paint]")
    own = tail.split("[[shapes]]")[1]
    scene = read(folder, f"{head}[[shapes]]{own}")
    assert list(scene.materials) == ["own/m"]


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ('file = "paint.png"', 'file = "gone.png"', 10, "gone.png"),
        ('encoding = "linear"', 'encoding = "gamma"', 15, "one of srgb, linear"),
        ('wrap = "clamp"', 'warp = "clamp"', 16, "did you mean 'wrap'"),
        ('base_color = "paint"', 'base_color = "pain"', 1, "did you mean 'paint'"),
        ('base_color = "paint"', "base_color = 3", 23, 'a texture\'s name, or ["name", channel]'),
        ('["rough", 1]', '["rough", 5]', 18, "channel 0 to 3"),
        ('normal_map = "bumps.png"', 'normal_map = "gone.png"', 18, "gone.png"),
        ('name = "own"\nfile = "square.glb"', 'file = "gone.glb"', 26, "gone.glb: expected a file"),
        ('name = "own"\nfile = "square.glb"', 'file = "square.fbx"', 26, "a mesh file, got .fbx"),
        ("scale = 2", "scale = -2", 30, "factors above 0"),
        ("rotate = [0, 0, 90]", "rotate = 90", 31, "3 finite numbers"),
        ("rotate = [0, 0, 90]", "turn = 90", 31, "shapes.0.turn: expected a key that is known"),
        ('kind = "rectangle"', 'kind = "mesh"', 41, "shapes.2.file: expected a value"),
    ],
)
def test_a_mistake_is_named_with_line_and_key(
    folder: Path, old: str, new: str, line: int, words: str
) -> None:
    assert TEXT.count(old) >= 1
    with pytest.raises(SceneError) as caught:
        read(folder, TEXT.replace(old, new, 1))
    text = str(caught.value)
    assert words in text, text
    assert f"line {line}:" in text, text
