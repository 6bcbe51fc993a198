"""A mesh whose texture is fitted: closed forms, its adjoint, its files, what it refuses."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, RangeError, SceneError, ShapeError
from photograd.fields import TexturedMesh
from photograd.fields.textured_mesh import MeshPolicy
from photograd.geometry.mesh import Mesh
from photograd.representation import Outputs, RayBatch, RenderOptions
from photograd.transport.mesh_files import read_model, read_textured_mesh
from photograd_course.color import srgb_encode

from tests.fit.mesh_scene import cube, write_obj

SQUARE = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
UV = np.array([[0.0, 1], [1, 1], [1, 0], [0, 0]])  # v downwards: y = 1 is the first row
FACES = np.array([[0, 1, 2], [0, 2, 3]])


def square(texels: Any, z: float = 0.0, pixel_angle: float = 0.0) -> TexturedMesh:
    mesh = Mesh(SQUARE + np.array([0, 0, z]), FACES, UV)
    return TexturedMesh(np.asarray(texels), mesh, MeshPolicy(pixel_angle))


def down(points: Any, height: float = 3.0) -> RayBatch:
    """Rays along -z to points (N, 2)."""
    points = np.asarray(points, np.float64)
    origins = np.concatenate([points, np.full((len(points), 1), height)], axis=1)
    towards = np.tile([0.0, 0, -1], (len(points), 1))
    return RayBatch(origins, towards, np.arange(len(points), dtype=np.uint32))


def drawn(field: TexturedMesh, batch: RayBatch) -> tuple[Outputs, Any]:
    return field.render(batch, seed=0, step=0, options=RenderOptions())


def raw(color: Any) -> Any:
    """Texels whose linear color is `color`."""
    return np.log(np.asarray(color) / (1 - np.asarray(color)))


def test_texels_lie_where_the_coordinates_say() -> None:
    colors = np.random.default_rng(1).uniform(0.1, 0.9, (2, 4, 3))
    field = square(raw(colors))
    x, y = np.meshgrid(-1 + (np.arange(4) + 0.5) / 2, [0.5, -0.5])
    outputs, _ = drawn(field, down(np.stack([x, y], -1).reshape(-1, 2)))
    np.testing.assert_allclose(outputs.color.reshape(2, 4, 3), colors, rtol=1e-6)
    np.testing.assert_allclose(outputs.depth, 3.0, rtol=1e-6)
    assert outputs.opacity is not None
    assert outputs.opacity.tolist() == [1.0] * 8


def test_the_nearest_surface_is_seen_from_either_side_and_nothing_beside_it() -> None:
    field = square(np.zeros((2, 2, 3)), z=1.0)
    above, below = down([[0.3, 0.2], [4, 0]]), down([[0.3, 0.2], [4, 0]], height=0.0)
    below = RayBatch(below.origins, -below.directions, below.pixel)
    for batch, distance in ((above, 2.0), (below, 1.0)):
        outputs, _ = drawn(field, batch)
        np.testing.assert_array_equal(outputs.color, [[0.5] * 3, [0] * 3])
        np.testing.assert_allclose(outputs.depth, [distance, 0])


def test_from_afar_a_texture_is_its_mean() -> None:
    colors = np.random.default_rng(2).uniform(0.1, 0.9, (8, 8, 3))
    # A texel is 0.25 m, so that a pixel of 0.01 covers 8 of them at 200 m.
    near, far = down([[0.1, 0.3]], height=10.0), down([[0.1, 0.3]], height=200.0)
    field = square(raw(colors), pixel_angle=0.01)
    np.testing.assert_allclose(drawn(field, far)[0].color[0], colors.mean((0, 1)), rtol=1e-6)
    assert np.array_equal(drawn(field, near)[0].color, drawn(square(raw(colors)), near)[0].color)
    context = drawn(field, down([[0.1, 0.3]], height=50.0))[1]
    np.testing.assert_allclose(context.level, 1.0, atol=1e-5)  # 0.5 m are two texels


@pytest.mark.parametrize("seed", range(4))
def test_the_adjoint_is_the_transpose_of_the_derivative(seed: int) -> None:
    field = TexturedMesh.example(seed=seed)
    batch, g = field.example_batch(seed=seed), np.random.default_rng(seed)
    place, v = field.params["texels"], g.normal(size=(6, 7, 3))
    d = Outputs(g.normal(size=(60, 3)), g.normal(size=60), g.normal(size=60))
    outputs, context = drawn(field, batch)
    assert 0.2 < len(context.hit) / 60 < 0.9  # some rays pass by
    assert {*np.floor(context.level)} == {0, 1}  # between all three of the mip map
    gradient = field.render_backward(context, d)["texels"]
    h, ends = 1e-5, []
    for sign in (1, -1):
        field.params = {"texels": place + sign * h * v}
        ends.append(drawn(field, batch)[0].color)
    forward = ((ends[0] - ends[1]) / (2 * h) * d.color).sum()
    assert abs(forward) > 1e-2
    np.testing.assert_allclose((v * gradient).sum(), forward, rtol=1e-7)
    # The lookup is linear in the colors: with dT/dtexel = T (1 - T) taken out, it is a transpose.
    color = 1 / (1 + np.exp(-place))
    found = (gradient / (1 - color)).sum()
    np.testing.assert_allclose(found, (outputs.color * d.color).sum(), rtol=1e-12)


def test_a_picture_of_nothing_has_no_gradient() -> None:
    outputs, context = drawn(field := square(np.ones((3, 3, 3))), down([[5, 5], [6, 6]]))
    assert not any(a.any() for a in (outputs.color, outputs.opacity, outputs.depth))  # type: ignore[union-attr]
    gradient = field.render_backward(context, Outputs(np.ones((2, 3))))
    assert gradient["texels"].shape == (3, 3, 3)
    assert not gradient["texels"].any()


def test_what_is_no_textured_mesh_is_refused() -> None:
    texels, mesh = np.zeros((2, 2, 3)), Mesh(SQUARE, FACES, UV)
    with pytest.raises(DtypeError, match="TexturedMesh: texels: expected float32 or float64"):
        TexturedMesh(np.zeros((2, 2, 3), int), mesh)
    for shape in ((2, 2), (2, 2, 4), (0, 2, 3)):
        with pytest.raises(ShapeError, match="TexturedMesh: texels"):
            TexturedMesh(np.zeros(shape), mesh)
    with pytest.raises(RangeError, match=r"mesh.uv: .*in \[0, 1\], got none"):
        TexturedMesh(texels, Mesh(SQUARE, FACES))
    for bad in (2.0, np.nan):
        with pytest.raises(RangeError, match=r"mesh.uv: .*in \[0, 1\], got others"):
            TexturedMesh(texels, Mesh(SQUARE, FACES, bad * UV))
    for angle in (-0.1, np.inf, np.nan):
        with pytest.raises(RangeError, match="MeshPolicy: pixel_angle"):
            MeshPolicy(angle)
    with pytest.raises(RangeError, match="load_state: state: expected this mesh's"):
        square(texels).load_state(square(texels, z=1.0).state())


def test_shapes_of_a_file_share_the_texture(tmp_path: Path) -> None:
    path = write_obj(tmp_path / "cube.obj", cube())
    again = read_textured_mesh(path)
    assert np.array_equal(again.mesh.vertices[again.mesh.faces], cube().vertices[cube().faces])
    np.testing.assert_allclose(again.mesh.uv[again.mesh.faces], cube().uv[cube().faces], atol=1e-6)  # type: ignore[index]
    assert again.shape == (1, 1, 3)
    text = path.read_text(encoding="utf-8")
    lines = text.replace("f ", "usemtl first\nf ", 1).splitlines()
    lines.insert(len(lines) - 6, "usemtl second")
    lines.insert(0, "mtllib cube.mtl")
    (tmp_path / "cube.mtl").write_text("newmtl first\nnewmtl second\n", encoding="utf-8")
    path.write_text("\n".join(lines), encoding="utf-8")
    both = read_textured_mesh(path).mesh
    assert both.uv is not None
    corners = both.uv[both.faces]
    first, second = corners[:6], corners[6:]
    assert len(both.faces) == 12
    assert first[..., 0].max() < 0.5 < second[..., 0].min()  # neither touches the other's square
    assert both.uv.min() > 0


@pytest.mark.parametrize(
    ("old", "new", "error", "words"),
    [
        ("/", "//", SceneError, "texture coordinates of every shape, got none of"),
        ("vt 0", "vt 7", RangeError, r"texture coordinates in \[0, 1\], got others of"),
    ],
)
def test_a_file_without_such_coordinates_is_refused(
    tmp_path: Path, old: str, new: str, error: Any, words: str
) -> None:
    path = write_obj(tmp_path / "cube.obj", cube())
    text = path.read_text(encoding="utf-8").replace(old, new)
    if new == "//":
        text = "\n".join(w for w in text.splitlines() if not w.startswith("vt"))
        text = "\n".join(
            " ".join(part.split("//")[0] for part in line.split()) for line in text.splitlines()
        )
    path.write_text(text, encoding="utf-8")
    with pytest.raises(error, match=words):
        read_textured_mesh(path)


def test_it_is_exported_as_gltf_with_its_texture(tmp_path: Path) -> None:
    colors = np.random.default_rng(3).uniform(0.05, 0.95, (5, 4, 3)).astype(np.float32)
    field = TexturedMesh(raw(colors).astype(np.float32), cube())
    path = tmp_path / "mesh.glb"
    (said,) = field.export(path, None)
    assert "KHR_materials_unlit" in said
    data = path.read_bytes()
    root = json.loads(data[20 : 20 + struct.unpack_from("<I", data, 12)[0]])
    assert root["materials"][0]["extensions"] == {"KHR_materials_unlit": {}}
    with pytest.warns(UserWarning, match="KHR_materials_unlit"):
        model = read_model(path)
    (shape,), (texture,) = model.shapes, model.textures.values()
    assert np.array_equal(shape.vertices, cube().vertices)  # type: ignore[union-attr]
    assert np.array_equal(shape.uv, cube().uv)  # type: ignore[union-attr,arg-type]
    stored = srgb_encode(texture.values[..., :3])
    np.testing.assert_allclose(stored, srgb_encode(colors), atol=0.51 / 255)
    field.export(tmp_path / "mesh.npz", None)
    with np.load(tmp_path / "mesh.npz") as archive:
        assert {"texels", "vertices", "faces", "uv", "box"} <= {*archive.files}
