"""Files of colored meshes: .ply and .glb."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from photograd_course.atomic_io import atomic_write
from photograd_course.color import srgb_decode

from photograd._gltf_bytes import GltfBytes
from photograd.errors import IoError, message
from photograd.fitting.isosurface import ColoredMesh

MESHES = (".ply", ".glb")
UNLIT = "KHR_materials_unlit"
_VERTEX = np.dtype(
    [
        *((name, "<f4") for name in ("x", "y", "z", "nx", "ny", "nz")),
        *((name, "u1") for name in ("red", "green", "blue")),
    ]
)
_FACE = np.dtype([("count", "u1"), ("vertex_indices", "<i4", 3)])


def write_colored_mesh(path: Path, mesh: ColoredMesh) -> None:
    """Write a mesh with the colors of its vertices, whole or not at all; +Y is up, in meters.

    A .ply file has display colors of 8 bits, a .glb file linear ones in float32 and a material that
    shows them as they are (KHR_materials_unlit), since the light is in them.

    Args:
        path: ends in .ply or .glb.
        mesh: as `extract_mesh` returns it.

    Raises:
        IoError: another end of the name, or the file cannot be written.
    """
    suffix = path.suffix.lower()
    if suffix not in MESHES:
        expected = f"a name that ends in {' or '.join(MESHES)}"
        raise IoError(message("write_colored_mesh", "path", expected, path.name))
    atomic_write(path, _ply(mesh) if suffix == ".ply" else _glb(mesh))


def _ply(mesh: ColoredMesh) -> bytes:
    vertex, face = np.empty(len(mesh.vertices), _VERTEX), np.empty(len(mesh.faces), _FACE)
    rows = np.concatenate([mesh.vertices, mesh.normals], axis=1)
    for k, name in enumerate(("x", "y", "z", "nx", "ny", "nz")):
        vertex[name] = rows[:, k]
    for k, name in enumerate(("red", "green", "blue")):
        vertex[name] = np.rint(255.0 * mesh.colors[:, k].astype(np.float64))
    face["count"], face["vertex_indices"] = 3, mesh.faces
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertex)}"]
    lines += [f"property float {name}" for name in ("x", "y", "z", "nx", "ny", "nz")]
    lines += [f"property uchar {name}" for name in ("red", "green", "blue")]
    lines += [f"element face {len(face)}", "property list uchar int vertex_indices"]
    header = "\n".join([*lines, "end_header\n"]).encode("ascii")
    return header + vertex.tobytes() + face.tobytes()


def _glb(mesh: ColoredMesh) -> bytes:
    file = GltfBytes()
    material = {
        "name": "radiance",
        "pbrMetallicRoughness": {"metallicFactor": 0.0},
        "extensions": {UNLIT: {}},
    }
    part = {
        "attributes": {
            "POSITION": file.attribute(mesh.vertices, bounds=True),
            "NORMAL": file.attribute(mesh.normals),
            "COLOR_0": file.attribute(srgb_decode(mesh.colors.astype(np.float64))),
        },
        "indices": file.indices(mesh.faces),
        "material": file.entry("materials", material),
    }
    node = {"mesh": file.entry("meshes", {"name": "mesh", "primitives": [part]})}
    file.root |= {"nodes": [node], "scenes": [{"nodes": [0]}], "scene": 0}
    file.root["extensionsUsed"] = [UNLIT]
    return file.glb()
