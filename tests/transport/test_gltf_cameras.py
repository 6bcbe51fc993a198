"""Cameras of glTF files: their images, invalid files, and images of files that are written."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import Error, SceneError
from photograd.lights import DirectionalLight, PointLight, SpotLight
from photograd.transport import (
    Environment,
    Material,
    ModelCamera,
    ModelFile,
    PathTracer,
    Scene,
    default_scene,
    read_scene,
)
from photograd.transport.builtin import camera_at
from photograd.transport.shapes import box, rectangle

from tests.transport.gltf_samples import Glb, square
from tests.transport.test_gltf_save import json_of, written
from tests.transport.test_mesh_files import read

pytestmark = pytest.mark.usefixtures("core")
HALF = float(np.sqrt(0.5))


def camera(**lens: Any) -> dict[str, Any]:
    return {"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1, **lens}}


def seen_square(*cameras: dict[str, Any], **place: Any) -> Glb:
    glb = square()
    for entry in cameras:
        glb.seen(entry, **place)
    return glb


def test_a_camera_sees_what_its_file_says(tmp_path: Path) -> None:
    glb = seen_square(camera(aspectRatio=2.0), rotation=[HALF, 0, 0, HALF], translation=[0, 0, 1])
    # Its parent stands at (4, 0, 0) and scales: local (x, y, z) is at (2 x + 4, 3 y, 3 z).
    glb.json["scenes"][0]["nodes"].pop()
    glb.json["nodes"].append({"children": [1], "scale": [2, 3, 3], "translation": [4, 0, 0]})
    glb.json["scenes"][0]["nodes"].append(2)
    model, told = read(tmp_path, glb.bytes())
    assert told == []
    (found,) = model.cameras
    view = found.fitted(64)
    assert (view.width, view.height) == (64, 32)
    np.testing.assert_allclose(view.position, [4, 0, 3])
    # A quarter turn about X: -Z is +Y now, and +Y is +Z.
    np.testing.assert_allclose(view.forward, [0, 1, 0], atol=1e-15)
    up, right = np.tan(0.4), 2 * np.tan(0.4)
    corners = np.array([[4 - right, 1, 3 + up], [4 + right, 1, 3 + up], [4, 1, 3 - up], [4, 1, 3]])
    pixels, depth = view.project(corners)
    np.testing.assert_allclose(pixels, [[0, 0], [64, 0], [32, 32], [32, 16]], atol=1e-12)
    np.testing.assert_allclose(depth, 1)
    high = found.camera(20, 40)  # other pixels than the file would have: yfov holds
    np.testing.assert_allclose(high.project(corners)[0][2:], [[10, 40], [10, 20]], atol=1e-12)
    assert replace(found, aspect=0.5).fitted(64).width == 32
    assert replace(found, aspect=None).fitted(64).width == 64


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"perspective": {"znear": 1}}, "cameras[0]: perspective: expected a member 'yfov'"),
        (camera(yfov=0), "perspective: yfov: expected radians between 0 and pi, got 0"),
        (camera(yfov=3.2), "perspective: yfov: expected radians between 0 and pi, got 3.2"),
        (camera(yfov="x"), "perspective: yfov: expected a number, got str"),
        (camera(aspectRatio=0), "perspective: aspectRatio: expected a number above 0"),
        ({"type": "fisheye"}, "cameras[0]: type: expected perspective or orthographic"),
        ({"type": None}, "cameras[0]: expected a member 'type'"),
        ({"perspective": None}, "cameras[0]: expected a member 'perspective'"),
    ],
)
def test_what_is_no_camera_is_refused_by_place(tmp_path: Path, change: Any, words: str) -> None:
    with pytest.raises(Error) as caught:
        read(tmp_path, seen_square(camera() | change).bytes())
    assert "m.glb: cameras[0]" in str(caught.value)
    assert words in str(caught.value)


def test_numbers_of_cameras_that_do_not_exist(tmp_path: Path) -> None:
    glb = seen_square(camera())
    for number, table in ((1, True), (-1, True), (0, False)):
        glb.json["nodes"][1]["camera"] = number
        if not table:
            del glb.json["cameras"]
        with pytest.raises(OSError, match=r"m\.glb: nodes\[1\]: camera: expected"):
            read(tmp_path, glb.bytes())


def test_cameras_that_have_no_counterpart_are_named(tmp_path: Path) -> None:
    flat = {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 1, "zfar": 2}}
    model, told = read(tmp_path, seen_square(flat).bytes())
    assert told == ["m.glb: cameras[0]: orthographic: not supported, left out"]
    assert model.cameras == ()
    out = "nodes[1]: a camera that is mirrored, sheared or out of reach, left out"
    shear = np.eye(4)
    shear[0, 1] = 0.5
    for place in (
        {"scale": [1, 1, -1]},
        {"scale": [1, 0, 1]},
        {"translation": [2e9, 0, 0]},
        {"matrix": shear.T.ravel().tolist()},
    ):
        model, told = read(tmp_path, seen_square(camera(), **place).bytes())
        assert told == [f"m.glb: {out}"]
        assert model.cameras == ()


def stage() -> Scene:
    """A cube on a floor under a point, a spot, a directional and an area light."""
    paint = Material("gltf", {"base_color": [0.6, 0.5, 0.3], "metalness": 0.5, "roughness": 0.5})
    shapes = (
        rectangle("floor", [-3, 0, 3], [6, 0, 0], [0, 0, -6], "m"),
        box("cube", [0, 0.5, 0], [1, 1, 1], "m", turn=20.0),
        rectangle("lamp", [-0.5, 3, -0.5], [1, 0, 0], [0, 0, 1], "lamp", [4.0, 3.0, 2.0]),
    )
    lights = (
        PointLight([1.5, 2.0, 0.5], [3.0, 2.0, 1.0]),
        SpotLight([-2.0, 2.5, 1.0], [1.0, -1.2, -0.4], [1.0, 4.0, 9.0], float(np.cos(0.5)), 0.4),
        DirectionalLight([0.3, 1.0, 0.4], [0.2, 0.3, 0.4]),
    )
    view = camera_at([1.0, 2.0, 5.0], [0.0, 0.5, 0.0], 40.0, 24, 16)
    return Scene("stage", shapes, {"m": paint, "lamp": paint}, view, lights=lights)


def test_a_scene_comes_back_with_its_camera_and_lights(tmp_path: Path) -> None:
    before = stage()
    for name in ("m.glb", "m.gltf"):
        model, said = written(before, tmp_path / name)
        assert said == []
        after = default_scene(model, "m", 24)
        assert (after.camera.width, after.camera.height) == (24, 16)
        pictures = [PathTracer(s).render(spp=8, seed=3).mean for s in (before, after)]
        assert (pictures[0] > 0).mean() > 0.5
        assert np.ptp(pictures[0]) > 0.2
        np.testing.assert_allclose(pictures[1], pictures[0], rtol=1e-5)  # measured: the same bits
        for without in range(3):  # each of them is seen
            lights = after.lights[:without] + after.lights[without + 1 :]
            dark = PathTracer(replace(after, lights=lights)).render(spp=8, seed=3).mean
            assert dark.mean() < 0.97 * pictures[0].mean()
    entry = json_of(tmp_path / "m.glb")["cameras"][0]
    assert entry["perspective"]["znear"] > 0
    assert entry["perspective"]["aspectRatio"] == 1.5
    again, said = written(model, tmp_path / "again.glb")
    assert said == []
    np.testing.assert_allclose(
        again.cameras[0].world_from_camera, before.camera.world_from_camera, atol=1e-15
    )


def test_what_a_file_cannot_say_of_a_camera_is_named(tmp_path: Path) -> None:
    scene = stage()
    for change, words in (
        ({"fx": 30.0}, "camera: fx: 30.0 is read back as 21.97"),
        ({"cx": 13.0}, "camera: cx: 13.0 is read back as 12.0"),
        ({"cy": 3.0}, "camera: cy: 3.0 is read back as 8.0"),
    ):
        odd = replace(scene, camera=replace(scene.camera, **change))
        _, said = written(odd, tmp_path / "m.glb")
        assert len(said) == 1
        assert words in said[0]


def test_whose_view_and_whose_light() -> None:
    scene = stage()
    cameras = tuple(replace(ModelCamera.of(scene.camera), name=name) for name in ("near", "far"))
    full = ModelFile(scene.shapes, scene.materials, cameras=cameras, lights=scene.lights)
    own = default_scene(full, "m", 24)
    assert (len(own.shapes), len(own.lights), own.environment) == (3, 3, None)
    np.testing.assert_allclose(own.camera.position, [1, 2, 5])
    far = replace(cameras[1], world_from_camera=np.eye(4))
    two = replace(full, cameras=(cameras[0], far))
    np.testing.assert_array_equal(
        default_scene(two, "m", 24, camera="far").camera.position, [0] * 3
    )
    # In the studio nothing of the file's is left but its shapes.
    studio = default_scene(full, "m", 24, camera="studio")
    assert (len(studio.shapes), len(studio.lights)) == (4, 0)
    assert isinstance(studio.environment, Environment)
    assert studio.camera.width == studio.camera.height == 24
    # A shape alone that shines is still seen in the studio; with a camera it is a scene.
    for model, shapes in (
        (replace(full, cameras=(), lights=()), 4),
        (replace(full, lights=()), 3),
        (replace(full, shapes=full.shapes[:2], lights=()), 3),
        (replace(full, cameras=()), 3),
    ):
        assert len(default_scene(model, "m", 24).shapes) == shapes
    with pytest.raises(SceneError, match="camera: expected a camera of the file, got fra"):
        default_scene(full, "m", camera="fra")


SCENE = """\
[camera]
file = "m.glb"
size = [24, 16]
[[shapes]]
kind = "mesh"
name = "all"
file = "m.glb"
lights = true
"""


def test_a_scene_file_takes_camera_and_lights(tmp_path: Path) -> None:
    before = stage()
    written(before, tmp_path / "m.glb")
    file = tmp_path / "s.toml"
    file.write_text(SCENE, encoding="utf-8")
    scene = read_scene(file)
    assert [type(x) for x in scene.lights] == [type(x) for x in before.lights]
    pictures = [PathTracer(s).render(spp=4, seed=3).mean for s in (before, scene)]
    np.testing.assert_allclose(pictures[1], pictures[0], rtol=1e-4)
    moved = "rotate = [0, 90, 0]\nscale = 2\ninstances = [{}, { translate = [0, 5, 0] }]\n"
    file.write_text(SCENE + moved, encoding="utf-8")
    point, spot, sun, higher = read_scene(file).lights[:4]
    assert isinstance(point, PointLight)
    assert isinstance(spot, SpotLight)
    assert isinstance(sun, DirectionalLight)
    assert isinstance(higher, PointLight)
    # A quarter turn about Y takes (x, y, z) to (z, y, -x); the numbers of the light stay.
    np.testing.assert_allclose(point.position, [1.0, 4.0, -3.0], atol=1e-12)
    np.testing.assert_allclose(higher.position, [1.0, 9.0, -3.0], atol=1e-12)
    np.testing.assert_array_equal(point.intensity, [3.0, 2.0, 1.0])
    axis = np.array([-0.4, -1.2, -1.0])
    np.testing.assert_allclose(spot.axis, axis / np.linalg.norm(axis), atol=1e-12)
    np.testing.assert_allclose(sun.direction @ [0.4, 1.0, -0.3], np.sqrt(1.25), rtol=1e-12)
    file.write_text(SCENE.replace("lights = true\n", ""), encoding="utf-8")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        assert read_scene(file).lights == ()
    told = "m.glb: its lights are left out; lights = true brings them"
    assert [str(w.message) for w in caught] == [told]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("size", 'name = "up"\nsize', "line 3: camera.name: expected a camera of m.glb: camera"),
        ("[24, 16]", "[24, 0.5]", "line 3: camera.size: expected width and height"),
        ('"m.glb"', '"n.glb"', "line 2: camera.file: expected a .glb or .gltf with a persp"),
        ('"m.glb"', '"gone.glb"', "gone.glb"),
        ("size", "aperture = 1\nsize", "line 3: camera.aperture: expected a key that is known"),
        ("lights = true", "lights = 1", "line 8: shapes.0.lights: expected true or false"),
        (
            "lights = true",
            "lights = true\nclosing = { translate = [1, 0, 0] }",
            "line 9: shapes.0.closing: expected no motion of a file whose lights are wanted",
        ),
    ],
)
def test_a_mistake_is_named_with_line_and_key(
    tmp_path: Path, old: str, new: str, words: str
) -> None:
    written(stage(), tmp_path / "m.glb")
    (tmp_path / "n.glb").write_bytes(square().bytes())
    file = tmp_path / "s.toml"
    file.write_text(SCENE.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        read_scene(file)
    assert words in str(caught.value)
