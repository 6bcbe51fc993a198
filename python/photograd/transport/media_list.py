"""The media of a scene as the core takes them, and what of a scene's shapes they need."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from photograd_course.suggest import choose_from

from photograd import bsdf
from photograd._arrays import Arguments
from photograd.bsdf import specular
from photograd.errors import SceneError, message
from photograd.transport.material import Material
from photograd.transport.medium import BOUNDARY, VACUUM, Medium
from photograd.transport.shapes import MeshShape, Shape
from photograd.types import Array

NOTHING, UNCHANGED = -1, -2  # interiors that are no medium, as the core counts them
SOLID = (
    "glass",
    "rough_dielectric",
    "dispersive_glass",
    "dispersive_dielectric",
    "gltf_refraction",
    "gltf_layered_volume",
    "gltf_layered_volume_conserving",
    BOUNDARY,
)
"""Surfaces whose inside is empty unless the shape says otherwise. Others that light can pass are
taken for thin sheets: on both sides is what is around."""


def check_media(
    shapes: Sequence[Shape],
    materials: Mapping[str, Material],
    media: Mapping[str, Medium],
    world: str | None,
) -> None:
    """Raise SceneError for names that do not exist, and interiors that no light could enter.

    Args:
        shapes: of the scene.
        materials: of the scene.
        media: of the scene.
        world: name of the medium around everything, or None.
    """
    for name in (BOUNDARY, VACUUM):
        if name in materials or name in media:
            expected = "another name, this one has a meaning of its own"
            raise SceneError(message("Scene", "materials and media", expected, name))
    if world is not None and world not in media:
        known = choose_from(world, media)
        raise SceneError(message("Scene", "world", "one of the scene's media", world, known))
    for shape in shapes:
        if shape.material == BOUNDARY and shape.emission.any():
            expected = "none, for a boundary cannot be seen"
            raise SceneError(message("Scene", f"{shape.name}.emission", expected, shape.emission))
        if shape.interior is not None:
            _check_interior(shape, shape.interior, materials, media)


def _check_interior(
    shape: Shape, interior: str, materials: Mapping[str, Material], media: Mapping[str, Medium]
) -> None:
    argument = f"{shape.name}.interior"
    if interior != VACUUM and interior not in media:
        known = choose_from(interior, media)
        expected = f"one of the scene's media, or {VACUUM}"
        raise SceneError(message("Scene", argument, expected, interior, known))
    if not is_closed(shape):
        expected = "a closed mesh, counter-clockwise seen from outside"
        remedy = "give it back and sides, or turn its faces around"
        raise SceneError(message("Scene", argument, expected, f"'{shape.name}' is not", remedy))
    if shape.material == BOUNDARY:
        return
    material = materials[shape.material]
    if not (transmits(material.model) or material.has_opacity):
        expected = f"a surface that lets light in, or {BOUNDARY}"
        got = f"'{material.model}'"
        raise SceneError(message("Scene", argument, expected, got))


def transmits(model: str) -> bool:
    """Whether light passes a surface of this model."""
    rough, smooth = bsdf.registry(), specular.registry()
    return rough[model].transmits if model in rough else smooth[model].lobe_count > 1


def is_closed(shape: Shape) -> bool:
    """Whether a shape has an inside: every edge of a mesh is passed once in each direction.

    Vertices at one place count as one. The volume within has to be positive: outside is where
    faces are counter-clockwise.
    """
    if not isinstance(shape, MeshShape):  # spheres and signed distance fields have one
        return True
    points, same = np.unique(shape.vertices, axis=0, return_inverse=True)
    faces = same.reshape(-1)[shape.faces.astype(np.int64)]
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]  # slivers of a welded edge
    edges = np.concatenate([faces[:, [i, (i + 1) % 3]] for i in range(3)])
    forth = edges[:, 0] * len(points) + edges[:, 1]
    back = edges[:, 1] * len(points) + edges[:, 0]
    if not np.array_equal(np.sort(forth), np.sort(back)):
        return False
    corners = points[faces].astype(np.float64) - points[0]
    return float(np.linalg.det(corners).sum()) > 0


class PackedMedia:
    """The media of a scene, numbered, and where they are."""

    def __init__(
        self, media: Mapping[str, Medium], materials: Mapping[str, Material], world: str | None
    ) -> None:
        """Of a scene that has been checked.

        Args:
            media: of the scene.
            materials: of the scene.
            world: name of the medium around everything, or None.
        """
        self.media = media
        self._numbers = {name: number for number, name in enumerate(media)}
        self._materials = materials
        self._world = world
        self.start = {
            f"media.{name}.{key}": value
            for name, medium in media.items()
            for key, value in medium.start.items()
        }

    def core_arguments(self, shapes: Sequence[Shape], owner: Array) -> dict[str, Any] | None:
        """Arguments of the core's `set_media`, or None for a scene of surfaces alone.

        `shapes` are the tracer's, `owner` (S,) says which of them each of the core's is of.
        """
        boundary = np.array([shape.material == BOUNDARY for shape in shapes])
        if not self.media and not boundary.any():
            return None
        interior = np.array([self._interior(shape) for shape in shapes], np.int32)
        grids = [
            None
            if medium.density is None
            else (medium.density.values.shape, medium.density.box_from_world)
            for medium in self.media.values()
        ]
        world = NOTHING if self._world is None else self._numbers[self._world]
        return {
            "interior": interior[owner],
            "boundary": boundary[owner],
            "world": world,
            "grids": grids,
        }

    def _interior(self, shape: Shape) -> int:
        if shape.interior is not None:
            return NOTHING if shape.interior == VACUUM else self._numbers[shape.interior]
        known = self._materials
        solid = shape.material == BOUNDARY or (
            shape.material in known and known[shape.material].model in SOLID
        )
        return NOTHING if solid and is_closed(shape) else UNCHANGED

    def changes(self, step: Mapping[str, Array]) -> list[tuple[Any, ...]]:
        """Rows as those of `rows`, float64, of how params change: any numbers of their shapes.

        Args:
            step: {name: change}.
        """
        found = []
        for name, medium in self.media.items():
            parts = {key: step[f"media.{name}.{key}"] for key in medium.start}
            density = parts.pop("density", None)
            if density is not None:
                density = np.ascontiguousarray(density, np.float64)
            row = np.concatenate([np.reshape(part, -1) for part in parts.values()])
            found.append((medium.phase_name, row.astype(np.float64), density, 0.0))
        return found

    def rows(self, params: Mapping[str, Array], dtype: npt.DTypeLike) -> list[tuple[Any, ...]]:
        """For the core: (phase function, parameters (P,), densities (X, Y, Z) or None, sigma_maj).

        Args:
            params: of the tracer.
            dtype: of the computation.

        Raises:
            ShapeError: params of another shape than at the start.
            RangeError: params that are no medium.
        """
        call = Arguments("PathTracer", dtype)
        found = []
        for name, medium in self.media.items():
            prefix = f"media.{name}."
            values = {
                key: call.array(prefix + key, params[prefix + key], value.shape, finite=False)
                for key, value in medium.start.items()
            }
            row = np.ascontiguousarray(medium.row("PathTracer", prefix, values), dtype)
            density, sigma_maj = values.get("density"), 0.0
            if medium.density is not None and density is not None:
                largest = medium.density.largest("PathTracer", f"{prefix}density", density)
                sigma_maj = float(values["sigma_t"].max()) * largest
                density = np.ascontiguousarray(density)
            found.append((medium.phase_name, row, density, sigma_maj))
        return found

    def named(self, blocks: Mapping[str, Array]) -> dict[str, Array]:
        """The derivatives of "media.I" and "densities.I", under the names of the params.

        Args:
            blocks: derivatives, under the names of blocks of the core.
        """
        gradients: dict[str, Array] = {}
        for i, (name, medium) in enumerate(self.media.items()):
            row, first = blocks[f"media.{i}"], 0
            for key, value in medium.start.items():
                if key == "density":
                    gradients[f"media.{name}.{key}"] = blocks[f"densities.{i}"]
                    continue
                part = row[first : first + value.size]
                gradients[f"media.{name}.{key}"] = part.reshape(value.shape)
                first += value.size
        return gradients
