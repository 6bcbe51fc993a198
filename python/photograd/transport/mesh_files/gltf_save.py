"""Scenes as glTF files: meshes, instances, materials with their extensions, textures, interiors;
cameras, and lights without surfaces.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from photograd_course.atomic_io import atomic_write

from photograd._gltf_bytes import GltfBytes
from photograd._typed import typed_call
from photograd.errors import IoError, SceneError, message
from photograd.transport.medium import BOUNDARY, VACUUM
from photograd.transport.mesh_files.gltf_cameras import gltf_camera
from photograd.transport.mesh_files.gltf_lights import LIGHTS, gltf_light
from photograd.transport.mesh_files.gltf_material_writer import (
    BODIES,
    WRITTEN,
    attenuation,
    gltf_material,
)
from photograd.transport.mesh_files.gltf_texture_writer import SLOTS, TextureWriter
from photograd.transport.mesh_files.model_camera import ModelCamera, camera_changes
from photograd.transport.mesh_files.model_changes import changes
from photograd.transport.mesh_files.model_file import ModelFile
from photograd.transport.mesh_files.read import read_model
from photograd.transport.motion import moves
from photograd.transport.scene import Scene
from photograd.transport.shapes import MeshShape

WRITABLE = (".glb", ".gltf")
_SURROUNDINGS = ("shutter", "environment", "world")
_REASONS = 8


@typed_call
def save_gltf(model: Scene | ModelFile, path: Path) -> None:
    """Write the meshes of a scene as .glb, or as .gltf with everything in one file.

    Cameras are written without the number of their pixels, of lights those that glTF knows: point,
    spot up to 90 degrees, and directional. The file is read back. A UserWarning says what is not
    written (other lights and what else surrounds the shapes), and every number, model or texture
    that comes back changed: textures have eight bits a channel, and some models are another one's
    special case.

    Args:
        model: the scene, or what `read_model` returned.
        path: ends in .glb or .gltf.

    Raises:
        IoError: another ending, or a file that cannot be written.
        SceneError: shapes, materials or interiors that glTF cannot express, or shapes that move;
            names them all.
    """
    suffix = path.suffix.lower()
    if suffix not in WRITABLE:
        expected = "a name that ends in .glb or .gltf"
        raise IoError(message("save_gltf", "path", expected, path.name))
    whole = _as_file(model)
    reasons = list(_unsupported(whole))
    if reasons:
        got = "; ".join(reasons[:_REASONS])
        got += f"; and {len(reasons) - _REASONS} more" if len(reasons) > _REASONS else ""
        raise SceneError(message("save_gltf", "model", "what glTF can express", got))
    file = _file(whole)
    atomic_write(path, file.glb() if suffix == ".glb" else file.gltf())
    for text in (*_not_written(model), *_come_back(whole, path)):
        warnings.warn(f"{path.name}: {text}", UserWarning, stacklevel=2)


def _as_file(model: Scene | ModelFile) -> ModelFile:
    """What is written, if all shapes and materials can be."""
    cameras = (ModelCamera.of(model.camera),) if isinstance(model, Scene) else model.cameras
    lights = tuple(light for light in model.lights if gltf_light(light) is not None)
    return ModelFile(model.shapes, model.materials, model.textures, model.media, cameras, lights)


def _unsupported(model: ModelFile) -> Iterator[str]:
    """What glTF cannot say, with its name."""
    for shape in model.shapes:
        if not isinstance(shape, MeshShape):
            yield f"shape '{shape.name}' is no mesh"
        if moves(shape):
            yield f"shape '{shape.name}' moves while the shutter is open"
        if shape.material == BOUNDARY:
            yield f"shape '{shape.name}' is a boundary of media"
            continue
        medium = model.media.get(shape.interior or "")
        if medium is not None and (medium.albedo is not None or medium.density is not None):
            yield f"medium '{shape.interior}' does more than absorb"
        model_of = model.materials[shape.material].model
        if medium is not None and model_of not in BODIES:
            yield f"shape '{shape.name}' of '{model_of}' has an interior"
    for name in sorted({shape.material for shape in model.shapes} - {BOUNDARY}):
        material = model.materials[name]
        if material.model not in WRITTEN:
            yield f"material '{name}' of the model '{material.model}'"
            continue
        for parameter in material.textures:
            if parameter not in SLOTS:
                yield f"material '{name}' with a texture of {parameter}"


def _file(model: ModelFile) -> GltfBytes:
    file = GltfBytes()
    textures = TextureWriter(file, model.textures)
    nodes: list[dict[str, Any]] = []
    numbers: dict[object, int] = {}
    for shape in model.shapes:
        assert isinstance(shape, MeshShape)
        key = shape.material, tuple(shape.emission), shape.emission_texture, shape.interior
        if key not in numbers:
            numbers[key] = file.entry("materials", _material(model, shape, textures))
        attributes = {"POSITION": file.attribute(shape.vertices, bounds=True)}
        if shape.normals is not None:
            attributes["NORMAL"] = file.attribute(shape.normals)
        if shape.uv is not None:
            attributes["TEXCOORD_0"] = file.attribute(shape.uv)
        part = {
            "attributes": attributes,
            "indices": file.indices(shape.faces),
            "material": numbers[key],
        }
        mesh = file.entry("meshes", {"name": shape.name, "primitives": [part]})
        nodes += [
            {"mesh": mesh, "matrix": instance.T.ravel().tolist()} for instance in shape.instances
        ]
        nodes += [] if shape.instances else [{"mesh": mesh}]
    nodes += _camera_and_light_nodes(file, model)
    file.root |= {"nodes": nodes, "scenes": [{"nodes": list(range(len(nodes)))}], "scene": 0}
    used = {name for entry in file.root["materials"] for name in entry.get("extensions", ())}
    used |= set(file.root.get("extensions", ()))
    if used:
        file.root["extensionsUsed"] = sorted(used)
    return file


def _camera_and_light_nodes(file: GltfBytes, model: ModelFile) -> list[dict[str, Any]]:
    """Nodes of cameras and lights."""
    nodes: list[dict[str, Any]] = []
    for camera in model.cameras:
        entry, matrix = gltf_camera(camera)
        nodes.append({"camera": file.entry("cameras", entry), "matrix": matrix})
    lights = [made for light in model.lights if (made := gltf_light(light)) is not None]
    if lights:
        file.root["extensions"] = {LIGHTS: {"lights": [entry for entry, _ in lights]}}
    nodes += [
        {"extensions": {LIGHTS: {"light": number}}, "matrix": matrix}
        for number, (_, matrix) in enumerate(lights)
    ]
    return nodes


def _material(model: ModelFile, shape: MeshShape, textures: TextureWriter) -> dict[str, Any]:
    """An entry of the table of materials."""
    material = model.materials[shape.material]
    written = gltf_material(material)
    textures.material(written, material)
    entry: dict[str, Any] = {"name": shape.material, "pbrMetallicRoughness": written.core}
    if material.has_opacity:
        written.core["baseColorFactor"][3] = float(material.values["alpha"])
        entry["alphaMode"] = "BLEND" if material.alpha_cutoff is None else "MASK"
        if material.alpha_cutoff is not None:
            entry["alphaCutoff"] = float(material.alpha_cutoff)
    if material.normal_map is not None:
        entry["normalTexture"] = textures.normal_map(material.normal_map)
    if material.occlusion is not None:
        entry["occlusionTexture"] = textures.occlusion(material.occlusion)
    if shape.emission.any():
        # A power of two, so that the product is exact.
        strength = max(1.0, 2.0 ** np.ceil(np.log2(shape.emission.max())))
        entry["emissiveFactor"] = (shape.emission / strength).tolist()
        if strength > 1:
            written.extensions["emissive_strength"] = {"emissiveStrength": strength}
        if shape.emission_texture is not None:
            entry["emissiveTexture"] = {"index": textures.color(shape.emission_texture)}
    if shape.interior not in (None, VACUUM):
        written.extensions["volume"] |= attenuation(model.media[str(shape.interior)])
    if written.extensions:
        named = {f"KHR_materials_{name}": node for name, node in written.extensions.items()}
        entry["extensions"] = named
    return entry


def _not_written(model: Scene | ModelFile) -> list[str]:
    """One line about what surrounds the shapes, and those of a camera beside its axis."""
    found = [
        f"lights[{i}] ({type(light).__name__})"
        for i, light in enumerate(model.lights)
        if gltf_light(light) is None
    ]
    if isinstance(model, Scene):
        found = [name for name in _SURROUNDINGS if getattr(model, name) is not None] + found
        found += ["lens"] if model.lens.radius > 0 else []
    told = [f"not written: {', '.join(found)}"] if found else []
    return told + (camera_changes(model.camera) if isinstance(model, Scene) else [])


def _come_back(model: ModelFile, path: Path) -> list[str]:
    """What reading the file says, and what has changed."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = read_model(path)
    return [f"read back: {warning.message}" for warning in caught] + changes(model, found)
