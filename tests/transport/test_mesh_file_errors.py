"""What can be wrong with a mesh file, and what is said about it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import Error, IoError, SceneError
from photograd.transport import read_model

from tests.transport.gltf_samples import Glb, core, square
from tests.transport.test_mesh_files import corners, read


def damaged(change: str) -> bytes:
    """A square with one thing wrong."""
    glb = square(**core(baseColorFactor=[1, 0, 0, 1]))
    json, part = glb.json, glb.json["meshes"][0]["primitives"][0]
    changes: dict[str, Any] = {
        "version": lambda: json["asset"].update(version="1.0"),
        "cycle": lambda: json["nodes"][0].update(children=[0]),
        "two parents": lambda: json["scenes"][0]["nodes"].append(0),
        "view": lambda: json["accessors"][0].update(bufferView=99),
        "count": lambda: json["accessors"][0].update(count=5),
        "huge": lambda: json["accessors"][0].update(count=2**31 - 1),
        "zeros": lambda: json["accessors"][0].update(sparse_zeros(glb, 2**28 - 10)),
        "kind": lambda: json["accessors"][0].update(type="VEC9"),
        "component": lambda: json["accessors"][0].update(componentType=5124),
        "indices": lambda: part.update(indices=glb.accessor(np.array([0, 1, 4], np.uint16))),
        "no position": lambda: part["attributes"].pop("POSITION"),
        "color": lambda: json["materials"][0].update(core(baseColorFactor=[1, 0])),
        "number": lambda: json["materials"][0].update(core(roughnessFactor="rough")),
        "quaternion": lambda: json["nodes"][0].update(rotation=[0, 0, 0, 0]),
        "material": lambda: part.update(material=7),
        "draco": lambda: json.update(extensionsRequired=["KHR_draco_mesh_compression"]),
        "meshopt": lambda: json.update(extensionsRequired=["EXT_meshopt_compression"]),
        "buffer": lambda: json["bufferViews"][0].update(buffer=1),
        "no scene": lambda: json["scenes"][0].update(nodes=[]),
    }
    changes[change]()
    return glb.bytes()


def sparse_zeros(glb: Glb, count: int) -> dict[str, Any]:
    """Entries of an accessor without a view: zeros, but for one row."""
    indices = {"bufferView": glb.view(np.uint16(0).tobytes()), "componentType": 5123}
    values = {"bufferView": glb.view(np.zeros(3, np.float32).tobytes())}
    sparse = {"count": 1, "indices": indices, "values": values}
    return {"bufferView": None, "count": count, "sparse": sparse}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("version", "asset: version: expected 2.0, got 1.0"),
        ("cycle", "nodes[0]: expected a tree of nodes"),
        ("two parents", "nodes[0]: expected a tree of nodes"),
        ("view", "accessors[0]: bufferView: expected a whole number from 0 to"),
        ("count", "accessors[0]: expected numbers inside of the buffer view, got 5 rows of 12"),
        ("huge", "accessors[0]: expected at most 268,435,456 vertices"),
        ("zeros", "accessors[0]: expected at most 268,435,456 bytes more than the file is"),
        ("kind", "accessors[0]: type"),
        ("component", "accessors[0]: componentType"),
        ("indices", "primitives[0]: indices: expected vertex numbers below 4, got 4"),
        ("no position", "primitives[0]: attributes: expected a member 'POSITION'"),
        ("color", "materials[0]: pbrMetallicRoughness: baseColorFactor: expected numbers of shape"),
        ("number", "roughnessFactor: expected a number, got str"),
        ("quaternion", "nodes[0]: rotation: expected a quaternion of length 1"),
        ("material", "materials: expected a material 7, got 1 materials"),
        ("draco", "got KHR_draco_mesh_compression (save it without compression"),
        ("meshopt", "got EXT_meshopt_compression"),
        ("buffer", "bufferViews[0]: buffer: expected a whole number from 0 to 0"),
        ("no scene", "expected triangles in the scene, got none"),
    ],
)
def test_a_damaged_file_is_refused_by_place(tmp_path: Path, change: str, words: str) -> None:
    with pytest.raises(Error) as caught:
        read(tmp_path, damaged(change))
    assert isinstance(caught.value, IoError | SceneError)
    assert words in str(caught.value)
    assert "m.glb" in str(caught.value) or change == "material"


def test_other_files_are_refused(tmp_path: Path) -> None:
    whole = square().bytes()
    for name, data, words in (
        ("m.fbx", whole, "a mesh file, got .fbx"),
        ("m.glb", whole[:-20], "a whole .glb of version 2"),
        ("m.glb", b"", "which begins with 'glTF'"),
        ("m.gltf", b"{", "JSON in UTF-8"),
        ("m.gltf", b"[" * 100_000, "JSON in UTF-8"),
        ("m.gltf", b"[]", "expected an object"),
        ("m.ply", b"ply\nformat ascii 1.0\nend_header\n", "an element 'vertex'"),
        ("m.obj", b"v 0 0 0\nv 1 0 0\n", "a triangle with an area"),
        ("m.stl", b"solid x\n", "a triangle with an area"),
    ):
        with pytest.raises((IoError, SceneError)) as caught:
            read(tmp_path, data, name)
        assert words in str(caught.value), str(caught.value)
    with pytest.raises(IoError, match=r"gone\.glb: expected a file, got none"):
        read_model(tmp_path / "gone.glb")


def test_buffers_beside_the_file_stay_in_its_folder(tmp_path: Path) -> None:
    glb = square()
    glb.bytes()
    for uri, words in (
        ("m.bin", ""),
        ("gone.bin", "buffers[0]: uri"),
        ("../m.bin", "expected a file in"),
        ("https://example.org/m.bin", "expected a file in"),
        ("data:;base64,***", "base64"),
    ):
        glb.json["buffers"] = [{"byteLength": len(glb.data), "uri": uri}]
        (tmp_path / "m.bin").write_bytes(glb.data)
        text = json.dumps(glb.json)
        if not words:
            assert len(corners(read(tmp_path, text, "m.gltf")[0])) == 2
            continue
        with pytest.raises(IoError) as caught:
            read(tmp_path, text, "m.gltf")
        assert words in str(caught.value)


def test_zeros_of_sparse_accessors_are_counted_together(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    glb = square()
    glb.json["accessors"][0].update(sparse_zeros(glb, 100))
    part = glb.json["meshes"][0]["primitives"][0]
    part["attributes"]["TEXCOORD_0"] = part["attributes"]["NORMAL"] = 0
    monkeypatch.setenv("PHOTOGRAD_MAX_EXPANSION", "2400")
    with pytest.raises(IoError, match="at most 2,400 bytes more than the file is long, got 3,600"):
        read(tmp_path, glb.bytes())
    monkeypatch.setenv("PHOTOGRAD_MAX_EXPANSION", "3600")
    with pytest.raises(IoError, match="expected 2 components, got 3"):
        read(tmp_path, glb.bytes())
