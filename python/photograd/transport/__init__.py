"""Light transport: scenes of shapes and materials, path traced, with derivatives.

`Scene` says what there is, `PathTracer` draws it; `read_scene` and `builtin` bring scenes from
files and by name. The mathematics is in cpp/photograd/render/path_vertex.h and path_walk.h.
"""

from __future__ import annotations

from photograd.transport.accumulation import Accumulation
from photograd.transport.builtin import BUILTIN, builtin_scene
from photograd.transport.scene import Environment, Material, MeshShape, Scene, SphereShape
from photograd.transport.scene_file import read_scene
from photograd.transport.tracer import PathOptions, PathTracer

__all__ = [
    "BUILTIN",
    "Accumulation",
    "Environment",
    "Material",
    "MeshShape",
    "PathOptions",
    "PathTracer",
    "Scene",
    "SphereShape",
    "builtin_scene",
    "read_scene",
]
