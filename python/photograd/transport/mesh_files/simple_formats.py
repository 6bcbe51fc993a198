"""What .obj, .ply and .stl files have in common: parts with arrays, and a gray of their own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from photograd.errors import IoError, SceneError, message
from photograd.transport.material import Material
from photograd.transport.mesh_files.container import NAME
from photograd.transport.mesh_files.model_file import Arrays, ModelFile, UniqueNames, placed_shapes
from photograd.transport.shapes import Shape
from photograd.transport.texture import Texture
from photograd.types import Array

Note = Callable[[str], None]
GRAY = Material("lambert", {"albedo": [0.7, 0.7, 0.7]})
"""Of surfaces whose file says nothing about their color."""


def model_of_meshes(
    path: Path,
    meshes: list[tuple[str, Arrays, str]],
    materials: dict[str, Material],
    textures: dict[str, Texture],
    note: Note,
) -> ModelFile:
    """A file of parts (name, arrays, material), with the materials that are used.

    Args:
        path: of the file, for errors.
        meshes: the parts.
        materials: by name.
        textures: by name.
        note: called with sentences.

    Raises:
        IoError: faces that name no vertex.
        SceneError: no triangle.
    """
    names = UniqueNames()
    shapes: list[Shape] = []
    for name, arrays, material in meshes:
        vertices, faces, normals, uv = arrays
        if not len(faces):
            continue
        if int(faces.min()) < 0 or int(faces.max()) >= len(vertices):
            got = f"{int(faces.min())} to {int(faces.max())}"
            expected = f"vertex numbers below {len(vertices)}"
            raise IoError(message(NAME, f"{path}: faces of {name}", expected, got))
        shapes += placed_shapes(
            names, name, (vertices, faces, normals, uv), material, np.zeros(3), [np.eye(4)], note
        )
    if not shapes:
        raise SceneError(message(NAME, f"{path}", "a triangle with an area", "none"))
    used = {shape.material: materials[shape.material] for shape in shapes}
    asked = {use.texture for made in used.values() for use in made.textures.values()}
    return ModelFile(tuple(shapes), used, {name: textures[name] for name in asked})


def finite_or_none(rows: Array | None) -> Array | None:
    """The rows, if they are there and finite."""
    return rows if rows is not None and bool(np.isfinite(rows).all()) else None
