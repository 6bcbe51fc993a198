"""Light transport: scenes of shapes and materials, path traced, with derivatives.

`Scene` says what there is, `PathTracer` draws it; `read_scene`, `read_model` (mesh files) and
`builtin` bring scenes from files and by name; `recover` finds in pictures what a scene is made of.
The mathematics is in cpp/photograd/render/path_vertex.h and path_walk.h.
"""

from __future__ import annotations

from photograd.transport.accumulation import Accumulation
from photograd.transport.builtin import BUILTIN, builtin_scene
from photograd.transport.lens import Lens
from photograd.transport.mesh_files import ModelFile, model_scene, read_model
from photograd.transport.recovery import (
    Recovery,
    RecoveryOptions,
    RecoveryResult,
    Target,
    Unknown,
    recover,
    scene_with,
)
from photograd.transport.scene import Environment, Material, MeshShape, Scene, SphereShape
from photograd.transport.scene_file import read_scene
from photograd.transport.texture import NormalMap, Texture, TextureUse, read_texture
from photograd.transport.tracer import PathOptions, PathTracer

__all__ = [
    "BUILTIN",
    "Accumulation",
    "Environment",
    "Lens",
    "Material",
    "MeshShape",
    "ModelFile",
    "NormalMap",
    "PathOptions",
    "PathTracer",
    "Recovery",
    "RecoveryOptions",
    "RecoveryResult",
    "Scene",
    "SphereShape",
    "Target",
    "Texture",
    "TextureUse",
    "Unknown",
    "builtin_scene",
    "model_scene",
    "read_model",
    "read_scene",
    "read_texture",
    "recover",
    "scene_with",
]
