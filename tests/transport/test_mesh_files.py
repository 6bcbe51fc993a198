"""Mesh files become shapes: every format, every layout of numbers, and what is wrong with files."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import SceneError
from photograd.transport import ModelFile, PathTracer, default_scene, read_model

from tests.transport.gltf_samples import CORNERS, FACES, UV, Glb, square

PYRAMID = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
SIDES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def read(folder: Path, data: bytes | str, name: str = "m.glb") -> tuple[ModelFile, list[str]]:
    """The model and the warnings of a file with this content."""
    path = folder / name
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        model = read_model(path)
    return model, [str(warning.message) for warning in caught]


def corners(model: ModelFile) -> Any:
    """(F, 3, 3) of all triangles, in an order of their own."""
    found = np.concatenate([shape.vertices[shape.faces] for shape in model.shapes])
    # Each triangle starts with its smallest corner; the turn stays.
    first = [int(np.lexsort(t.T[::-1])[0]) for t in found]
    turned = np.array([np.roll(t, -k, axis=0) for t, k in zip(found, first, strict=True)])
    return turned[np.lexsort(turned.reshape(len(turned), 9).T[::-1])]


def obj() -> str:
    lines = [f"v {x} {y} {z}" for x, y, z in PYRAMID]
    return "\n".join(lines + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in SIDES]) + "\n"


def ply() -> str:
    head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    head += "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    rows = [f"{x} {y} {z}" for x, y, z in PYRAMID] + [f"3 {a} {b} {c}" for a, b, c in SIDES]
    return head + "\n".join(rows) + "\n"


def stl() -> bytes:
    rows = np.zeros(4, np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]))
    rows["v"] = PYRAMID[SIDES]
    return b"\0" * 80 + np.uint32(4).tobytes() + rows.tobytes()


def pyramid_glb() -> bytes:
    glb = Glb()
    glb.node(glb.mesh(PYRAMID.astype(np.float32), SIDES.astype(np.uint8), None))
    return glb.bytes()


FORMATS = {"m.glb": pyramid_glb, "m.obj": obj, "m.ply": ply, "m.stl": stl}


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_gives_the_same_triangles(tmp_path: Path, name: str) -> None:
    model, told = read(tmp_path, FORMATS[name](), name)
    assert told == []
    np.testing.assert_array_equal(corners(model), corners(read(tmp_path, obj(), "o.obj")[0]))
    assert len(corners(model)) == 4
    np.testing.assert_array_equal(model.box, [[0, 0, 0], [1, 1, 1]])
    tracer = PathTracer(default_scene(model, "pyramid", 16))
    first = [tracer.path(pixel, 0, seed=1)[0]["shape"] for pixel in (0, 16 * 8 + 8)]
    assert first == [-1, 0]  # sky in the corner, the pyramid in the middle


def test_polygons_and_texture_coordinates_of_plain_files(tmp_path: Path) -> None:
    text = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    text += "usemtl red\nf 1/1 2/2 3/3 4/4\n"
    (tmp_path / "m.mtl").write_text("newmtl red\nKd 0.8 0.1 0.2\n")
    model, told = read(tmp_path, text, "m.obj")
    assert told == []
    assert len(corners(model)) == 2
    assert model.materials["red"].values["albedo"] == pytest.approx([0.8, 0.1, 0.2], abs=0.003)
    shape = model.shapes[0]
    at = dict(zip(map(tuple, shape.vertices.tolist()), shape.uv.tolist(), strict=True))
    assert at[0.0, 0.0, 0.0] == [0.0, 1.0]  # v points down
    assert at[1.0, 1.0, 0.0] == [1.0, 0.0]
    head = ply().replace("element face 4", "element face 1").split("3 0 2 1")[0]
    quad, told = read(tmp_path, head + "4 0 1 3 2\n", "q.ply")
    assert told == []
    assert len(corners(quad)) == 2


def test_normals_of_plain_files(tmp_path: Path) -> None:
    tilted = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0.6 0 0.8\nvn 0 0.6 0.8\nf 1//1 2//2 3//3\n"
    head = ply().split("element face")[0].replace("vertex 4", "vertex 3")
    head += "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n"
    head += "property list uchar int vertex_index\nend_header\n"
    rows = "0 0 0 0 0 1\n1 0 0 0.6 0 0.8\n0 1 0 0 0.6 0.8\n3 0 1 2\n"
    for name, text in (("m.obj", tilted), ("m.ply", head + rows)):
        shape = read(tmp_path, text, name)[0].shapes[0]
        at = dict(zip(map(tuple, shape.vertices.tolist()), shape.normals.tolist(), strict=True))
        assert at[1.0, 0.0, 0.0] == pytest.approx([0.6, 0, 0.8])
        assert at[0.0, 1.0, 0.0] == pytest.approx([0, 0.6, 0.8])
    assert read(tmp_path, obj(), "n.obj")[0].shapes[0].normals is None


def test_places_in_the_tree_of_nodes(tmp_path: Path) -> None:
    glb = Glb()
    mesh = glb.mesh()
    half = np.sqrt(0.5)
    parent = glb.node(mesh, translation=[0, 0, 5])
    parent["children"] = [1]
    glb.json["nodes"].append(
        {"mesh": mesh, "rotation": [0, half, 0, half], "scale": [2, 1, 1], "translation": [1, 0, 0]}
    )
    model, _ = read(tmp_path, glb.bytes())
    assert len(model.shapes) == 1  # a mesh, twice in the scene
    parts = [CORNERS @ m[:3, :3].T + m[:3, 3] for m in model.shapes[0].instances]
    np.testing.assert_allclose(parts[0], CORNERS + np.array([0, 0, 5]))
    # x turns to -z about y; scaled before, moved after, and by the parent.
    expected = np.stack([0 * CORNERS[:, 0] + 1, CORNERS[:, 1], 5 - 2 * CORNERS[:, 0]], axis=1)
    np.testing.assert_allclose(parts[1], expected, atol=1e-12)
    matrix = np.eye(4)
    matrix[:3, 3], matrix[0, 0] = [3, 2, 1], -1.0
    mirrored = Glb()
    mirrored.node(mirrored.mesh(), matrix=matrix.T.reshape(-1).tolist())
    model, _ = read(tmp_path, mirrored.bytes())
    first = model.shapes[0].vertices[model.shapes[0].faces[0]]
    assert np.cross(first[1] - first[0], first[2] - first[0])[2] > 0  # the front stays in front
    np.testing.assert_array_equal(model.box, [[2, 2, 1], [3, 3, 1]])


def test_layouts_of_numbers(tmp_path: Path) -> None:
    strip = Glb()
    strip.node(strip.mesh(CORNERS[[0, 1, 3, 2]], None, mode=5))
    fan = Glb()
    fan.node(fan.mesh(CORNERS, None, mode=6))
    plain, _ = read(tmp_path, square().bytes())
    # The strip cuts the square along its other diagonal; the normals must agree all the same.
    for glb in (strip, fan):
        model, _ = read(tmp_path, glb.bytes())
        t = corners(model)
        normals = np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])
        np.testing.assert_array_equal(normals, [[0, 0, 1]] * 2)
    np.testing.assert_array_equal(corners(model), corners(plain))
    packed = Glb()
    mesh = packed.mesh(uv=None)
    part = packed.json["meshes"][mesh]["primitives"][0]
    coordinates = packed.accessor(np.array([[0, 255], [255, 255], [255, 0], [51, 0]], np.uint8))
    packed.json["accessors"][coordinates]["normalized"] = True
    part["attributes"]["TEXCOORD_0"] = coordinates
    packed.node(mesh)
    model, _ = read(tmp_path, packed.bytes())
    expected = np.array([[0, 1], [1, 1], [1, 0], [0.2, 0]], np.float32)
    np.testing.assert_array_equal(model.shapes[0].uv, expected)


def test_interleaved_and_sparse_accessors(tmp_path: Path) -> None:
    glb = Glb()
    rows = np.zeros((4, 5), np.float32)
    rows[:, :3], rows[:, 3:] = CORNERS, UV
    view = glb.view(rows.tobytes())
    glb.json["bufferViews"][view]["byteStride"] = 20
    for start, kind in ((0, "VEC3"), (12, "VEC2")):
        glb.json["accessors"].append(
            {
                "bufferView": view,
                "byteOffset": start,
                "componentType": 5126,
                "count": 4,
                "type": kind,
            }
        )
    glb.json["accessors"][0]["sparse"] = {
        "count": 1,
        "indices": {
            "bufferView": glb.view(np.array([2], np.uint8).tobytes()),
            "componentType": 5121,
        },
        "values": {"bufferView": glb.view(np.array([7, 8, 9], np.float32).tobytes())},
    }
    faces = glb.accessor(FACES.reshape(-1))
    attributes = {"POSITION": 0, "TEXCOORD_0": 1}
    glb.json["meshes"].append({"primitives": [{"attributes": attributes, "indices": faces}]})
    glb.node(0)
    model, _ = read(tmp_path, glb.bytes())
    np.testing.assert_array_equal(model.shapes[0].vertices[[0, 1, 3]], CORNERS[[0, 1, 3]])
    np.testing.assert_array_equal(model.shapes[0].vertices[2], [7, 8, 9])
    np.testing.assert_array_equal(model.shapes[0].uv, UV)


def test_useless_triangles_are_counted_and_dropped(tmp_path: Path) -> None:
    glb = Glb()
    vertices = np.concatenate([CORNERS, [[np.nan, 0, 0], [2, 0, 0], [np.inf, 1, 1]]])
    faces = np.array([[0, 1, 2], [0, 2, 4], [0, 1, 5], [3, 3, 3], [1, 2, 6]], np.uint16)
    glb.node(glb.mesh(vertices.astype(np.float32), faces, None))
    flat = glb.mesh(np.zeros((3, 3), np.float32), None, None)
    glb.node(flat)
    glb.node(glb.mesh(), scale=[1, 1, 0])
    model, told = read(tmp_path, glb.bytes())
    assert len(corners(model)) == 1
    text = "\n".join(told)
    assert "mesh 0: dropped 2 with corners that are not finite and 2 without area of 5" in text
    assert "mesh 1: left out" in text
    assert "mesh 2: a transformation without volume, left out" in text
    only = Glb()
    only.node(only.mesh(np.zeros((3, 3), np.float32), None, None))
    with pytest.raises(SceneError, match="triangles in the scene, got none"):
        read(tmp_path, only.bytes())


def test_what_no_solid_could_be_is_drawn(tmp_path: Path) -> None:
    # Three triangles at one edge, one of them twice and once turned round; a vertex of none.
    vertices = np.concatenate([CORNERS, [[0.5, 0.5, 1], [9, 9, 9]]]).astype(np.float32)
    faces = np.array([[0, 2, 1], [0, 2, 3], [0, 2, 4], [4, 2, 0], [0, 2, 4]], np.uint16)
    glb = Glb()
    glb.node(glb.mesh(vertices, faces, None))
    model, told = read(tmp_path, glb.bytes())
    assert told == []
    assert len(corners(model)) == 5
    assert model.box[1].tolist() == [1, 1, 1]  # what no triangle has does not count
    picture = PathTracer(default_scene(model, "odd", 16)).render(spp=4, seed=1).mean
    assert np.ptp(picture) > 0.05
