"""Scenes from mesh files: .glb and .gltf with their materials, .obj, .ply and .stl.

`read_model` reads one; `default_scene` puts it under a light and before a camera, its own if the
file has them; `save_gltf` writes a scene's shapes and materials, its camera and its lights.
`read_textured_mesh` makes one mesh of all shapes, whose texture is to be fitted, and
`read_mesh_surface` one whose vertices are; `read_textured_surface` keeps the texture of a shape.
"""

from __future__ import annotations

from photograd.transport.mesh_files.as_field import (
    read_mesh_surface,
    read_textured_mesh,
    read_textured_surface,
)
from photograd.transport.mesh_files.gltf_save import save_gltf
from photograd.transport.mesh_files.model_camera import ModelCamera
from photograd.transport.mesh_files.model_file import ModelFile
from photograd.transport.mesh_files.read import SUFFIXES, read_model
from photograd.transport.mesh_files.stl import write_stl
from photograd.transport.mesh_files.studio import STUDIO, default_scene

__all__ = [
    "STUDIO",
    "SUFFIXES",
    "ModelCamera",
    "ModelFile",
    "default_scene",
    "read_mesh_surface",
    "read_model",
    "read_textured_mesh",
    "read_textured_surface",
    "save_gltf",
    "write_stl",
]
