"""Meshes of a file as one, for a fit to start from."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from photograd_course.color import srgb_encode

from photograd._typed import typed_call
from photograd.errors import RangeError, SceneError, message
from photograd.fields.layered_picture import Unwrapped
from photograd.fields.mesh_surface import MeshSurface
from photograd.fields.surface import without_seams
from photograd.fields.surface_texels import raw_texels
from photograd.fields.textured_mesh import TexturedMesh
from photograd.fields.textured_surface import TexturedSurface
from photograd.geometry.mesh import Mesh
from photograd.transport.mesh_files.model_file import ModelFile
from photograd.transport.mesh_files.read import read_model
from photograd.transport.shapes import MeshShape
from photograd.types import Array

COLOR_PARAMETERS = ("base_color", "albedo", "tint")
"""Of materials, whose texture is that of the file's color."""
MARGIN = 1 / 64
"""Around the texture of each of several shapes, in sizes of its square."""


@typed_call
def read_textured_mesh(path: str | Path) -> TexturedMesh:
    """The shapes of a mesh file with one gray texture; `read_model` says which files.

    Several shapes, and instances of one, share the texture: each has a square of it.

    Args:
        path: of the file.

    Raises:
        IoError, RangeError, SceneError: what `read_model` raises.
        SceneError: a shape without texture coordinates.
        RangeError: texture coordinates outside of [0, 1].
    """
    parts: list[tuple[Array, Array, Array]] = []
    for shape, moved in _instances(path):
        if shape.uv is None:
            expected, got = "texture coordinates of every shape", f"none of '{shape.name}'"
            remedy = "unwrap the mesh in a modeler"
            raise SceneError(message("read_textured_mesh", f"{path}", expected, got, remedy))
        if not bool(((shape.uv >= 0) & (shape.uv <= 1)).all()):
            expected, got = "texture coordinates in [0, 1]", f"others of '{shape.name}'"
            remedy = "unwrap the mesh, so that no texture repeats"
            raise RangeError(message("read_textured_mesh", f"{path}", expected, got, remedy))
        parts.append((moved, shape.faces, shape.uv))
    side = math.ceil(math.sqrt(len(parts)))
    margin = MARGIN if side > 1 else 0.0
    vertices, faces, uv, count = [], [], [], 0
    for number, (moved, corners, flat) in enumerate(parts):
        cell = np.array([number % side, number // side])
        vertices.append(moved)
        faces.append(corners.astype(np.int64) + count)
        uv.append((cell + margin + (1 - 2 * margin) * flat) / side)
        count += len(moved)
    mesh = Mesh(
        np.concatenate(vertices), np.concatenate(faces), np.concatenate(uv).astype(np.float32)
    )
    return TexturedMesh.of_mesh(mesh)


@typed_call
def read_mesh_surface(path: str | Path) -> MeshSurface:
    """The shapes of a mesh file as one mesh of gray vertices; `read_model` says which files.

    Vertices at one position, as at a seam of texture coordinates, become one.

    Args:
        path: of the file.

    Raises:
        IoError, RangeError, SceneError: what `read_model` raises.
        SceneError: no mesh, a triangle without area, or an edge of three faces or more.
    """
    vertices: list[Array] = []
    faces: list[Array] = []
    count = 0
    for shape, moved in _instances(path):
        vertices.append(moved)
        faces.append(shape.faces.astype(np.int64) + count)
        count += len(moved)
    if not vertices:
        raise SceneError(message("read_mesh_surface", f"{path}", "a mesh", "none"))
    mesh = Mesh(np.concatenate(vertices), np.concatenate(faces))
    return MeshSurface.of_mesh(*without_seams(mesh))


@typed_call
def read_textured_surface(path: str | Path) -> TexturedSurface:
    """The one shape of a mesh file with its color texture, and its opacity where it has one.

    Vertices at one position become one; the texture may have a seam there. What the texture holds
    comes back to the bit: it is read as display values, and raw numbers hold these.

    Args:
        path: of the file; `read_model` says which.

    Raises:
        IoError, RangeError, SceneError: what `read_model` raises.
        SceneError: several shapes, one without a texture of its color, one that is not manifold.
        RangeError: texture coordinates outside of [0, 1].
    """
    model = read_model(path)
    shapes = list(_instances(path, model))
    expected = "one shape with a texture of its color"
    if len(shapes) != 1:
        got, remedy = f"{len(shapes)} shapes", "join them in a modeler"
        raise SceneError(message("read_textured_surface", f"{path}", expected, got, remedy))
    shape, vertices = shapes[0]
    uses = model.materials[shape.material].textures
    color = next((uses[key] for key in COLOR_PARAMETERS if key in uses), None)
    if color is None or shape.uv is None:
        raise SceneError(message("read_textured_surface", f"{path}", expected, "none"))
    if not bool(((shape.uv >= 0) & (shape.uv <= 1)).all()):
        remedy = "unwrap the mesh, so that no texture repeats"
        got = "others"
        where = "texture coordinates in [0, 1]"
        raise RangeError(message("read_textured_surface", f"{path}", where, got, remedy))
    linear = model.textures[color.texture].values.astype(np.float64)
    rgba = np.ones((*linear.shape[:2], 4))
    rgba[..., :3] = srgb_encode(linear)
    opacity = uses.get("alpha")
    if opacity is not None:
        rgba[..., 3] = model.textures[opacity.texture].values[..., opacity.channel]
    welded, faces = without_seams(Mesh(vertices, shape.faces))
    vertex = np.zeros(len(vertices), np.uint32)
    vertex[shape.faces] = faces
    unwrapped = Unwrapped(shape.uv.astype(np.float64), shape.faces, vertex)
    texels = raw_texels(rgba, None if opacity is None else 1.0)
    return TexturedSurface.of_mesh(welded, unwrapped, texels, smoothness=0.0)


def _instances(
    path: str | Path, model: ModelFile | None = None
) -> Iterator[tuple[MeshShape, Array]]:
    """Each mesh of a file, with its vertices (V, 3) in the world, once an instance."""
    for shape in (model or read_model(path)).shapes:
        if not isinstance(shape, MeshShape):
            continue
        for instance in shape.instances or (np.eye(4),):
            moved = shape.vertices @ instance[:3, :3].T + instance[:3, 3]
            yield shape, moved.astype(np.float32)
