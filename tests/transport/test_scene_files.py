"""Scenes from files, and everything that can be wrong with one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, IoError, RangeError, SceneError, ShapeError
from photograd.transport import (
    BUILTIN,
    Environment,
    Material,
    MeshShape,
    PathOptions,
    PathTracer,
    Scene,
    SphereShape,
    builtin_scene,
    read_scene,
)
from photograd.transport.scene_node import key_lines
from photograd.transport.shapes import box

from tests.transport.scenes import GRAY, view

TEXT = """\
# A ball on a table.
[camera]
position = [0, 1, 4]
look_at = [0, 0.5, 0]
field_of_view = 40
size = [8, 6]

[environment]
radiance = [0.1, 0.2, 0.3]

[materials.gray]
model = "lambert"
albedo = [0.5, 0.5, 0.5]

[materials.gold]
model = "ggx_metal"
f0 = [1.0, 0.8, 0.4]
roughness = 0.3

[[shapes]]
kind = "box"
center = [0, -0.1, 0]
size = [2, 0.2, 2]
turn = 20
material = "gray"

[[shapes]]
kind = "sphere"
name = "ball"
center = [0, 0.5, 0]
radius = 0.5
material = "gold"

[[shapes]]
kind = "triangles"
vertices = [
    [-1, 2, -1], # a corner
    [1, 2, -1],
    [0, 2, 1]
]
faces = [[0, 1, 2]]
material = "gray"
emission = 3
"""


def write(folder: Path, text: str) -> Path:
    path = folder / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_file_says_what_the_scene_is(tmp_path: Path) -> None:
    scene = read_scene(write(tmp_path, TEXT))
    assert [shape.name for shape in scene.shapes] == ["box 0", "ball", "triangles 2"]
    assert (scene.camera.width, scene.camera.height) == (8, 6)
    assert scene.environment is not None
    np.testing.assert_array_equal(scene.environment.ground, [0.1, 0.2, 0.3])
    assert scene.materials["gold"].row().tolist() == [1.0, 0.8, 0.4, 0.3]
    np.testing.assert_array_equal(scene.shapes[2].emission, [3, 3, 3])
    image = PathTracer(scene).render(spp=4, seed=1).mean
    assert image.shape == (6, 8, 3)
    assert (image > 0).any()


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ("position = [0, 1, 4]", "position = [0, 1]", 3, "camera.position: expected 3 finite"),
        ("position = [0, 1, 4]", "position = [0, 1, nan]", 3, "camera.position"),
        ("position = [0, 1, 4]\n", "", 2, "camera.position: expected a value, got none"),
        ("field_of_view = 40", "field_of_view = 190", 5, "degrees between 0 and 180"),
        ("field_of_view = 40", 'field_of_view = "wide"', 5, "a finite number"),
        ("field_of_view = 40", "fov = 40", 2, "camera.field_of_view"),
        ("field_of_view = 40", "feild_of_view = 40", 5, "camera.feild_of_view: expected a key"),
        ("field_of_view = 40", "feild_of_view = 40", 5, "did you mean 'field_of_view'"),
        ("size = [8, 6]", "size = [8, 6]\nwidth = 3", 7, "camera.width: expected a key that is"),
        ("size = [8, 6]", "size = [8, 0]", 6, "width and height in pixels"),
        ("look_at = [0, 0.5, 0]", "look_at = [0, 9, 4]", 4, "not straight above"),
        ('model = "lambert"', 'model = "lamberd"', 11, "did you mean 'lambert'"),
        ("albedo = [0.5, 0.5, 0.5]", "albedo = [0.5, 0.5]", 13, "albedo: expected shape (3,)"),
        ("albedo = [0.5, 0.5, 0.5]", 'albedo = "red"', 13, "albedo: expected numbers, got 'red'"),
        ("albedo = [0.5, 0.5, 0.5]", "albedo = [1, 2, {}]", 13, "albedo: expected numbers, got [1"),
        ("roughness = 0.3", "rough = 0.3", 15, "exactly ['f0', 'roughness']"),
        ('kind = "box"', 'kind = "cube"', 21, "shapes.0.kind: expected one of"),
        ("turn = 20", "turns = 20", 24, "did you mean 'turn'"),
        ("turn = 20", 'inward = "yes"', 24, "true or false"),
        ("size = [2, 0.2, 2]", "size = [2, 0, 2]", 20, "size: expected finite numbers above 0"),
        ('material = "gold"', 'material = "silver"', 32, "shapes.1.material: expected one of"),
        ("radius = 0.5", "radius = 0", 27, "above 0 m"),
        ("radius = 0.5", "radius = 1e400", 31, "a finite number"),
        ("radius = 0.5", "radius = 1e15", 31, "(numbers below 1e+15)"),
        ("radiance = [0.1, 0.2, 0.3]", f"radiance = {10**400}", 9, "of at least 0, got 1000"),
        ("radiance = [0.1, 0.2, 0.3]", "radiance = -1", 9, "at least 0"),
        ("emission = 3", "emission = [1, 2, -3]", 43, "at least 0"),
        ("faces = [[0, 1, 2]]", "faces = [[0, 1, 3]]", 34, "vertex numbers 0 to 2"),
        ("faces = [[0, 1, 2]]", "faces = [[0, 1, 2.5]]", 41, "rows of three whole numbers"),
        ("    [0, 2, 1]", "    [0, 2, -1]", 34, "a light with an area"),
        ("[environment]", "[enviroment]", 8, "did you mean"),
        ("[environment]", "[[environment]]", 8, "environment: expected a table"),
    ],
)
@pytest.mark.filterwarnings("ignore:.*dropped")
def test_a_mistake_is_named_with_line_and_key(
    tmp_path: Path, old: str, new: str, line: int, words: str
) -> None:
    assert TEXT.count(old) >= 1
    with pytest.raises(SceneError) as caught:
        read_scene(write(tmp_path, TEXT.replace(old, new, 1)))
    text = str(caught.value)
    assert f"line {line}:" in text, text
    assert words in text, text


def test_what_is_no_toml_or_no_file(tmp_path: Path) -> None:
    with pytest.raises(IoError, match="line 1"):
        read_scene(write(tmp_path, "[camera\n"))
    with pytest.raises(IoError, match="expected a file, got none"):
        read_scene(tmp_path / "none.toml")
    (tmp_path / "b.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(IoError):
        read_scene(tmp_path / "b.toml")


def test_lines_of_keys_in_odd_places() -> None:
    text = 'a.b = 1 # x = 2\n[c."d e"]\nf = [\n  [1, 2]\n]\ng = "[h]"\n[[i]]\nj = {k = 1}\n[[i]]\n'
    lines = key_lines(text)
    assert lines["a", "b"] == 1
    assert lines["c", "d e"] == 2
    assert lines["c", "d e", "f"] == 3
    assert lines["c", "d e", "g"] == 6
    assert lines["i", 0, "j"] == 8
    assert lines["i", 1] == 9
    assert len(lines) == 7
    lines = key_lines('a = """\nb = 1\n[c] \\""" \n"""\nd = \'\'\'[\'\'\'\ne = 1\n')
    assert lines == {("a",): 1, ("d",): 5, ("e",): 6}


def test_long_keys_and_strings_take_no_time(tmp_path: Path) -> None:
    # Each took minutes: the parser keeps all beginnings of a key, and a search that started over at
    # every quote or space.
    with pytest.raises(IoError, match="dotted keys of at most 16 parts, got 50000"):
        read_scene(write(tmp_path, ".".join("a" * 50_000) + " = 1"))
    text = 'a = """' + '\\"' * 50_000 + '"""\nb = [' + " " * 100_000 + "]\nc = 1\n"
    assert key_lines(text) == {("a",): 1, ("b",): 2, ("c",): 3}


def test_built_in_scenes_are_found_by_name() -> None:
    for name in BUILTIN:
        scene = builtin_scene(name, 4)
        assert scene.camera.width == 4
        assert PathTracer(scene).render(spp=1, seed=1).radiance.any()
    with pytest.raises(SceneError, match="did you mean 'cornell-box'"):
        builtin_scene("cornel-box")


def mesh(**changes: Any) -> MeshShape:
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    given = {"vertices": corners, "faces": np.array([[0, 1, 2], [1, 3, 2]]), **changes}
    return MeshShape(
        "m",
        given["vertices"],
        given["faces"],
        "gray",
        given.get("emission", np.zeros(3)),
        given.get("normals"),
    )


def test_useless_triangles_are_counted_and_dropped() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, np.nan], [2, 0, 0]])
    faces = np.array([[0, 1, 2], [1, 3, 2], [0, 1, 4], [0, 0, 0]])
    with pytest.warns(UserWarning, match="1 with corners that are not finite and 2 without area"):
        shape = mesh(vertices=vertices, faces=faces)
    assert shape.faces.tolist() == [[0, 1, 2]]
    scene = Scene(
        "s",
        (shape,),
        {"gray": GRAY},
        view(8, (0.3, 0.3, 2), (0.3, 0.3, 0)),
        Environment.constant(1.0),
    )
    image = PathTracer(scene).render(spp=8, seed=1, options=PathOptions("bsdf")).mean
    assert image.min() == pytest.approx(0.5, rel=1e-5)  # the triangle is hit
    with (
        pytest.warns(UserWarning, match="2 without area of 2"),
        pytest.raises(SceneError, match="a light with an area, got none"),
    ):
        mesh(vertices=np.zeros((4, 3)), emission=np.ones(3))


@pytest.mark.parametrize(
    ("changes", "error", "words"),
    [
        ({"vertices": np.zeros((4, 2))}, ShapeError, "shape (V, 3)"),
        ({"vertices": np.zeros((4, 3), int)}, DtypeError, "floating point"),
        ({"faces": np.zeros((1, 3))}, DtypeError, "integers"),
        ({"faces": np.zeros((3,), int)}, ShapeError, "shape (F, 3)"),
        ({"faces": np.array([[0, 1, 4]])}, RangeError, "0 to 3, got 0 to 4"),
        ({"faces": np.array([[0, 1, -1]])}, RangeError, "got -1 to 1"),
        ({"emission": np.array([1.0, -1.0, 0.0])}, RangeError, "at least 0"),
        ({"emission": np.array([np.inf, 0, 0])}, RangeError, "finite"),
        ({"normals": np.zeros((3, 3))}, ShapeError, "m.normals"),
    ],
)
def test_wrong_meshes_are_refused(changes: dict[str, Any], error: Any, words: str) -> None:
    with pytest.raises(error) as caught:
        mesh(**changes)
    assert words in str(caught.value)


def test_wrong_spheres_materials_and_scenes_are_refused() -> None:
    with pytest.raises(RangeError, match="a light needs an area"):
        SphereShape("s", np.zeros(3), 0.0, "gray", np.ones(3))
    with pytest.raises(ShapeError, match="center"):
        SphereShape("s", np.zeros(2), 1.0, "gray")
    with pytest.raises(RangeError, match="exactly"):
        Material("lambert", {})
    ball = SphereShape("s", np.zeros(3), 1.0, "gray")
    with pytest.raises(SceneError, match="two of the name 's'"):
        Scene("x", (ball, ball), {"gray": GRAY}, view())
    with pytest.raises(SceneError, match="at least one"):
        Scene("x", (), {"gray": GRAY}, view())
    with pytest.raises(SceneError, match="one of the scene's materials, got gray"):
        Scene("x", (ball,), {"white": GRAY}, view())
    with pytest.raises(RangeError, match="size: expected finite numbers above 0"):
        box("b", [0, 0, 0], [1, -1, 1], "gray")
