"""glTF 2.0 files as shapes, materials, textures, cameras and lights [Khronos2021]."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from photograd._json_node import JsonNode
from photograd.errors import IoError, SceneError, message
from photograd.transport.mesh_files.accessor import read_floats, read_indices
from photograd.transport.mesh_files.container import NAME, Container, open_container, whole
from photograd.transport.mesh_files.gltf_cameras import read_cameras
from photograd.transport.mesh_files.gltf_interior import filled_shapes
from photograd.transport.mesh_files.gltf_lights import LIGHTS, read_lights
from photograd.transport.mesh_files.gltf_materials import FileMaterial, read_material
from photograd.transport.mesh_files.model_file import ModelFile, UniqueNames, placed_shapes
from photograd.transport.mesh_files.nodes import placed_nodes, transforms_of_meshes
from photograd.transport.mesh_files.pictures import TRANSFORM, Pictures
from photograd.transport.shapes import MeshShape, Shape
from photograd.types import Array

DRACO = "KHR_draco_mesh_compression"
READABLE = (TRANSFORM, "KHR_mesh_quantization", LIGHTS)
"""Extensions that a file may require, besides those of materials, which are noted one by one."""
_LEFT_OUT = {"animations": "the rest position is drawn", "skins": "the rest position is drawn"}
_TRIANGLES, _STRIP, _FAN = 4, 5, 6


def read_gltf(path: Path, note: Callable[[str], None]) -> ModelFile:
    """Everything in the file's first scene that can be drawn; `note` takes what cannot.

    Args:
        path: of the file.
        note: called with sentences.

    Raises:
        IoError: a missing or damaged file, or compressed geometry.
        RangeError: numbers that are not finite.
        SceneError: nothing to draw.
    """
    container = open_container(path)
    _check_required(container)
    for key, instead in _LEFT_OUT.items():
        if key in container.root:
            note(f"{path.name}: {key}: not supported; {instead}")
    if "extensions" in container.root:
        for name, _ in container.root["extensions"].members():  # variants of materials
            if name != LIGHTS:
                note(f"{path.name}: extensions: {name[:60]}: not supported, left out")
    pictures = Pictures(container, note)
    materials: dict[str, FileMaterial] = {}
    numbered: dict[int, str] = {}
    names, titles = UniqueNames(), UniqueNames()
    shapes: list[Shape] = []
    nodes = placed_nodes(container)
    cameras, lights = read_cameras(container, nodes, note), read_lights(container, nodes, note)
    for number, transforms in transforms_of_meshes(nodes).items():
        meshes = container.entries("meshes")
        if number >= len(meshes):
            raise IoError(message(NAME, "meshes", f"a mesh {number}", f"{len(meshes)} meshes"))
        mesh = meshes[number]
        title = mesh["name"].text() if "name" in mesh else f"mesh {number}"
        for part in mesh["primitives"].items():
            wanted = whole(part, 0, 1 << 31, "material") if "material" in part else -1
            if wanted not in numbered:
                label, made = _material(container, wanted, pictures, note)
                numbered[wanted] = names.unique_name(label)
                materials[numbered[wanted]] = made
            name = numbered[wanted]
            arrays = _arrays(container, part, materials[name], note)
            if arrays is not None:
                made = materials[name]
                placed = placed_shapes(titles, title, arrays, name, made.emission, transforms, note)
                shapes += [_glowing(shape, made, note) for shape in placed]
    if not shapes:
        raise SceneError(message(NAME, f"{path}", "triangles in the scene", "none"))
    used = {name: made.material for name, made in materials.items()}
    asked = {use.texture for material in used.values() for use in material.textures.values()}
    asked |= {
        made.emission_texture.texture
        for made in materials.values()
        if made.emission_texture is not None
    }
    textures = {name: pictures.textures[name] for name in pictures.textures if name in asked}
    filled, media = filled_shapes(shapes, materials, note)
    return ModelFile(filled, used, textures, media, cameras, lights)


def _glowing(shape: Shape, made: FileMaterial, note: Callable[[str], None]) -> Shape:
    """The shape with the texture of its light, if it has coordinates for it."""
    if made.emission_texture is None or not isinstance(shape, MeshShape):
        return shape
    if shape.uv is None:
        note(f"{shape.name}: emissiveTexture without texture coordinates, left out")
        return shape
    return replace(shape, emission_texture=made.emission_texture)


def _check_required(container: Container) -> None:
    root = container.root
    if "extensionsRequired" not in root:
        return
    for node in root["extensionsRequired"].items():
        name = node.text()
        if name == DRACO:
            remedy = "save it without compression: there is no decoder for it here"
            raise IoError(message(NAME, node.where, "plain geometry", name, remedy))
        if name not in READABLE and not name.startswith("KHR_materials_"):
            remedy = "save it without"
            raise IoError(message(NAME, node.where, "extensions that are known", name[:60], remedy))


def _material(
    container: Container, number: int, pictures: Pictures, note: Callable[[str], None]
) -> tuple[str, FileMaterial]:
    """Name and material; -1 is the one of primitives that name none."""
    if number < 0:
        node = JsonNode(NAME, f"{container.path.name}: default material", {})
        return "default", read_material(node, pictures, note)
    materials = container.entries("materials")
    if number >= len(materials):
        got = f"{len(materials)} materials"
        raise IoError(message(NAME, "materials", f"a material {number}", got))
    node = materials[number]
    name = node["name"].text() if "name" in node else f"material {number}"
    return name, read_material(node, pictures, note)


def _arrays(
    container: Container, part: JsonNode, material: FileMaterial, note: Callable[[str], None]
) -> tuple[Array, Array, Array | None, Array | None] | None:
    """Vertices, faces, normals and texture coordinates of a primitive; None without surface."""
    mode = whole(part, 0, 6, "mode", _TRIANGLES)
    if mode < _TRIANGLES:
        note(f"{part.where}: points or lines, left out")
        return None
    attributes = part["attributes"]
    vertices = read_floats(container, attributes["POSITION"], 3)
    count = len(vertices)
    indices = read_indices(container, part["indices"]) if "indices" in part else np.arange(count)
    if len(indices) and int(indices.max()) >= count:
        expected = f"vertex numbers below {count}"
        raise IoError(message(NAME, f"{part.where}: indices", expected, int(indices.max())))
    faces = _faces(indices, mode)
    if not len(faces):
        note(f"{part.where}: no triangle, left out")
        return None
    for key in ("COLOR_0", "JOINTS_0"):
        if key in attributes:
            note(f"{part.where}: {key}: not supported, left out")
    if "targets" in part:
        note(f"{part.where}: targets: not supported, left out")
    normals = _attribute(container, attributes, "NORMAL", 3, count, note)
    coordinates = material.coordinates
    uv = _attribute(container, attributes, f"TEXCOORD_{coordinates.set}", 2, count, note)
    return vertices, faces, normals, None if uv is None else coordinates.apply(uv)


def _attribute(
    container: Container,
    attributes: JsonNode,
    key: str,
    width: int,
    count: int,
    note: Callable[[str], None],
) -> Array | None:
    """(V, width), or None if absent or unusable."""
    if key not in attributes:
        return None
    rows = read_floats(container, attributes[key], width)
    if len(rows) != count:
        expected = f"{count} rows, one a vertex"
        raise IoError(message(NAME, f"{attributes.where}: {key}", expected, len(rows)))
    if not np.isfinite(rows).all():
        note(f"{attributes.where}: {key}: NaN or infinity, left out")
        return None
    return rows


def _faces(indices: Array, mode: int) -> Array:
    """(F, 3); of a strip every second triangle runs the other way."""
    if mode == _TRIANGLES:
        return indices[: len(indices) // 3 * 3].reshape(-1, 3)
    if len(indices) < 3:
        return np.empty((0, 3), np.int64)
    if mode == _FAN:
        first = np.full(len(indices) - 2, indices[0])
        return np.stack([first, indices[1:-1], indices[2:]], axis=1)
    faces = np.stack([indices[:-2], indices[1:-1], indices[2:]], axis=1)
    faces[1::2] = faces[1::2, [1, 0, 2]]
    return faces
