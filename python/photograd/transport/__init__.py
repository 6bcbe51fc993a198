"""Light transport: scenes of shapes and materials, path traced, with derivatives.

`Scene` says what there is, `PathTracer` draws it; `read_scene`, `read_model` (mesh files) and
`builtin` bring scenes from files and by name; `recover` finds in pictures what a scene is made of.
The mathematics is in cpp/photograd/render/path/tracer.h and cpp/photograd/render/path/adjoint.h.
"""

from __future__ import annotations

from photograd.transport.accumulation import Accumulation
from photograd.transport.builtin import BUILTIN, builtin_scene
from photograd.transport.density_files import read_density
from photograd.transport.derivative import add_derivative_samples, derivative_image, direction_of
from photograd.transport.inverse import (
    InverseRendering,
    Parameter,
    RecoveryOptions,
    RecoveryResult,
    Target,
    recover,
    scene_with,
)
from photograd.transport.lens import Lens, Shutter
from photograd.transport.material import Material
from photograd.transport.medium import BOUNDARY, VACUUM, DensityGrid, Medium
from photograd.transport.mesh_files import (
    ModelCamera,
    ModelFile,
    default_scene,
    read_model,
    save_gltf,
)
from photograd.transport.occlusion_map import bake_ambient_occlusion
from photograd.transport.particles import (
    Emitted,
    IrradianceSensor,
    ParticleOptions,
    PhotonMap,
    emit_particles,
    trace_light,
)
from photograd.transport.path_options import PathOptions
from photograd.transport.scene import Environment, Scene
from photograd.transport.scene_file import read_scene
from photograd.transport.shapes import MeshShape, SdfShape, SphereShape
from photograd.transport.texture import NormalMap, OcclusionMap, Texture, TextureUse, read_texture
from photograd.transport.tracer import PathTracer

__all__ = [
    "BOUNDARY",
    "BUILTIN",
    "VACUUM",
    "Accumulation",
    "DensityGrid",
    "Emitted",
    "Environment",
    "InverseRendering",
    "IrradianceSensor",
    "Lens",
    "Material",
    "Medium",
    "MeshShape",
    "ModelCamera",
    "ModelFile",
    "NormalMap",
    "OcclusionMap",
    "Parameter",
    "ParticleOptions",
    "PathOptions",
    "PathTracer",
    "PhotonMap",
    "RecoveryOptions",
    "RecoveryResult",
    "Scene",
    "SdfShape",
    "Shutter",
    "SphereShape",
    "Target",
    "Texture",
    "TextureUse",
    "add_derivative_samples",
    "bake_ambient_occlusion",
    "builtin_scene",
    "default_scene",
    "derivative_image",
    "direction_of",
    "emit_particles",
    "read_density",
    "read_model",
    "read_scene",
    "read_texture",
    "recover",
    "save_gltf",
    "scene_with",
    "trace_light",
]
