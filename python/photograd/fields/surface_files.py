"""A mesh that shines by itself as a .glb file: colors of its vertices, or a texture."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from photograd_course.atomic_io import atomic_write

from photograd._gltf_bytes import GltfBytes
from photograd.types import Array

UNLIT = "KHR_materials_unlit"
SAMPLER = {"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071}
"""Of a glTF file: linear, between levels of the mip map as well, clamped at the edges."""


def write_glowing_mesh(
    path: Path,
    vertices: Array,
    faces: Array,
    *,
    colors: Array | None = None,
    uv: Array | None = None,
    pixels: Array | None = None,
) -> None:
    """Write one mesh.

    Args:
        path: of the file.
        vertices: (V, 3) meters, written as float32.
        faces: (F, 3) vertex numbers.
        colors: (V, 3) linear, of the vertices.
        uv: (V, 2) texture coordinates, v downwards.
        pixels: (H, W, 3 or 4) bytes of the texture, sRGB; of four channels the last is opacity,
            which is blended.

    Raises:
        IoError: the file cannot be written.
    """
    file = GltfBytes()
    surface: dict[str, Any] = {"metallicFactor": 0.0}
    attributes = {"POSITION": file.attribute(vertices, bounds=True)}
    if uv is not None:
        attributes["TEXCOORD_0"] = file.attribute(uv)
    if colors is not None:
        attributes["COLOR_0"] = file.attribute(colors)
    if pixels is not None:
        texture = {
            "source": file.image("radiance", pixels),
            "sampler": file.entry("samplers", SAMPLER),
        }
        surface["baseColorTexture"] = {"index": file.entry("textures", texture)}
    material: dict[str, Any] = {
        "name": "radiance",
        "pbrMetallicRoughness": surface,
        "doubleSided": True,
        "extensions": {UNLIT: {}},
    }
    if pixels is not None and pixels.shape[2] == 4:
        material["alphaMode"] = "BLEND"
    part = {
        "attributes": attributes,
        "indices": file.indices(faces),
        "material": file.entry("materials", material),
    }
    node = {"mesh": file.entry("meshes", {"name": "mesh", "primitives": [part]})}
    file.root |= {"nodes": [node], "scenes": [{"nodes": [0]}], "scene": 0}
    file.root["extensionsUsed"] = [UNLIT]
    atomic_write(path, file.glb())
