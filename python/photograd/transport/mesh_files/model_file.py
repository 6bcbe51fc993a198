"""What every mesh file becomes: shapes, materials and textures, and cameras and lights if any."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from photograd._typed import typed_call
from photograd.errors import SceneError
from photograd.lights import Light
from photograd.transport.material import Material
from photograd.transport.medium import Medium
from photograd.transport.mesh_files.model_camera import ModelCamera
from photograd.transport.shapes import MeshShape, Shape
from photograd.transport.texture import Texture
from photograd.types import Array

Arrays = tuple[Array, Array, Array | None, Array | None]
"""Vertices (V, 3), faces (F, 3), shading normals (V, 3) or None, uv (V, 2) or None."""
MAX_COORDINATE = 1e9


@typed_call
@dataclass(frozen=True, eq=False)
class ModelFile:
    """Shapes of a file in its own world, +Y up by the file's word.

    Attributes:
        shapes: at least one.
        materials: those that the shapes name.
        textures: those that the materials name.
        media: those that fill shapes.
        cameras: of the file, each under a name of its own.
        lights: without surfaces; surfaces that shine are shapes.
    """

    shapes: tuple[Shape, ...]
    materials: Mapping[str, Material]
    textures: Mapping[str, Texture] = field(default_factory=dict)
    media: Mapping[str, Medium] = field(default_factory=dict)
    cameras: tuple[ModelCamera, ...] = ()
    lights: tuple[Light, ...] = ()

    @property
    def box(self) -> Array:
        """(2, 3) lower and upper corner of all shapes."""
        boxes = np.array([shape.box for shape in self.shapes])
        return np.array([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])


def placed_shapes(
    names: UniqueNames,
    name: str,
    arrays: Arrays,
    material: str,
    emission: Any,
    transforms: Sequence[Array],
    note: Callable[[str], None],
) -> list[Shape]:
    """A mesh under each of its transforms (4, 4): moved if there is one, else as instances.

    What has no triangle left, or a transform without volume, is left out with a note.

    Args:
        names: that were given so far.
        name: of the mesh.
        arrays: vertices, faces, normals and texture coordinates.
        material: its name.
        emission: (3,) radiance of the front.
        transforms: world_from_object.
        note: called with sentences.
    """
    usable = []
    for transform in transforms:
        volume = float(np.linalg.det(transform[:3, :3])) if np.isfinite(transform).all() else 0.0
        reach = np.abs(transform).max() if np.isfinite(transform).all() else np.inf
        if not (abs(volume) > 1e-30 and np.isfinite(volume) and reach < MAX_COORDINATE):
            note(f"{name}: a transformation without volume, left out")
            continue
        usable.append((transform, volume))
    made: list[Shape] = []
    together = [transform for transform, volume in usable if volume > 0]
    alone = [
        transform for transform, volume in usable if volume < 0
    ]  # mirrored: wound the other way
    if len(together) > 1:
        made += _shape(names.unique_name(name), arrays, material, emission, tuple(together), note)
    else:
        alone = together + alone
    for transform in alone:
        made += _shape(
            names.unique_name(name), moved(arrays, transform), material, emission, (), note
        )
    return made


def _shape(
    name: str,
    arrays: Arrays,
    material: str,
    emission: Any,
    transforms: tuple[Array, ...],
    note: Callable[[str], None],
) -> list[Shape]:
    vertices, faces, normals, uv = arrays
    try:
        return [MeshShape(name, vertices, faces, material, emission, normals, uv, transforms)]
    except SceneError as failure:
        note(f"{name}: left out: {failure}")
        return []


def moved(arrays: Arrays, world_from_object: Array) -> Arrays:
    """The mesh in the world; a mirrored one is wound the other way: its front stays outside.

    Args:
        arrays: vertices, faces, normals and texture coordinates.
        world_from_object: (4, 4).
    """
    vertices, faces, normals, uv = arrays
    if np.array_equal(world_from_object, np.eye(4)):
        return arrays
    turn = np.asarray(world_from_object[:3, :3], np.float64)
    with np.errstate(over="ignore", invalid="ignore"):
        vertices = (vertices @ turn.T + world_from_object[:3, 3]).astype(np.float32)
    if normals is not None:
        scaled = normals @ np.linalg.inv(turn)  # by the inverse's transpose
        length = np.linalg.norm(scaled, axis=1, keepdims=True)
        normals = (scaled / np.where(length > 0, length, 1)).astype(np.float32)
    if np.linalg.det(turn) < 0:
        faces = faces[:, ::-1]
    return vertices, faces, normals, uv


class UniqueNames:
    """UniqueNames, each given once: `name`, `name (2)`, `name (3)`, ..."""

    def __init__(self) -> None:
        self._taken: set[str] = set()
        self._next: dict[str, int] = {}

    def unique_name(self, name: str) -> str:
        """`name`, with the first number behind it that makes a name not given before."""
        found = name
        while found in self._taken:
            number = self._next.get(name, 2)
            found, self._next[name] = f"{name} ({number})", number + 1
        self._taken.add(found)
        return found
