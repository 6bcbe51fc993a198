"""Meshes and materials from one file format to glTF, for `photograd convert`."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

from photograd.transport.mesh_files import SUFFIXES, ModelFile, read_model, save_gltf
from photograd.transport.mesh_files.gltf_save import WRITABLE
from photograd.transport.scene import Scene
from photograd.transport.scene_file import read_scene
from photograd.transport.shapes import MeshShape

READABLE = (".toml", *SUFFIXES)
__all__ = ["READABLE", "WRITABLE", "convert_model"]


def convert_model(source: Path, target: Path) -> dict[str, Any]:
    """Read a scene or a mesh file, write it as glTF; returns what the command reports.

    Raises:
        IoError, SceneError, RangeError: as for `read_scene`, `read_model` and `save_gltf`.
    """
    with warnings.catch_warnings(record=True) as reading:
        warnings.simplefilter("always")
        model: Scene | ModelFile = (
            read_scene(source) if source.suffix.lower() == ".toml" else read_model(source)
        )
    with warnings.catch_warnings(record=True) as writing:
        warnings.simplefilter("always")
        save_gltf(model, target)
    notes = [{"reading": source.name, "note": f"{told.message}"} for told in reading]
    notes += [{"writing": target.name, "note": f"{told.message}"} for told in writing]
    meshes = [shape for shape in model.shapes if isinstance(shape, MeshShape)]
    return {
        "shapes": len(model.shapes),
        "triangles": sum(len(mesh.faces) for mesh in meshes),
        "materials": len(model.materials),
        "textures": len(model.textures),
        "bytes_in": source.stat().st_size,
        "bytes_out": target.stat().st_size,
        "out": target,
        "notes": notes,
    }
