"""Shapes of a scene: triangle meshes, spheres, signed distance fields; rectangles and boxes.

A ray meets a signed distance field by steps of the distance (cpp/photograd/geometry/sdf_solid.h)
[Hart1996]: no triangles, and smooth at any distance; the normal is the gradient of the distance.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.errors import RangeError, SceneError, message
from photograd.geometry.sdf import Body
from photograd.geometry.sdf import Shape as SdfNode
from photograd.transport.shape_checks import (
    checked_closing_instances,
    checked_color,
    checked_instance,
    usable_triangles,
)
from photograd.transport.texture import TextureUse
from photograd.types import Array


@typed_call
@dataclass(frozen=True, eq=False)
class MeshShape:
    """A triangle mesh in the world.

    Triangles without area, or with corners that are not finite, are dropped with a warning that
    counts them.

    Attributes:
        name: unique in its scene.
        vertices: (V, 3) floating point, meters; kept as float32.
        faces: (F, 3) integers, counter-clockwise seen from the side that emits.
        material: name of one of the scene's materials, or `medium.BOUNDARY`: it is not seen.
        emission: (3,) radiance of the front; 0 for all that does not shine.
        normals: (V, 3) shading normals of any length, or None for flat triangles.
        uv: (V, 2) texture coordinates, v downwards, or None.
        instances: world_from_object, (4, 4) each, of instances of this mesh; without any, it
            stands once, where its vertices are. All shine and reflect alike, and are kept in
            memory once.
        emission_texture: the texture that scales `emission`, three channels of it, or None.
        interior: name of the medium that fills the mesh, which has to be closed, or
            `medium.VACUUM`. None: nothing in glass, and whatever is around in other surfaces.
        closing_instances: world_from_object of each of `instances` (of the mesh itself, where there
            are none) when the shutter closes: in between, each point moves straight on. None of
            them: it stands still.

    Raises:
        DtypeError, ShapeError: arrays of other types or shapes.
        RangeError: vertex numbers out of range, negative emission, or an instance that mirrors or
            flattens.
        SceneError: no triangle is left; for a shape that shines, a light without area.
    """

    name: str
    vertices: Array
    faces: Array
    material: str
    emission: Array = field(default_factory=lambda: np.zeros(3))
    normals: Array | None = None
    uv: Array | None = None
    instances: tuple[Array, ...] = ()
    emission_texture: TextureUse | None = None
    interior: str | None = None
    closing_instances: tuple[Array, ...] = ()

    def __post_init__(self) -> None:
        call = Arguments("MeshShape", np.float32)
        name = self.name
        vertices = call.array(
            f"{name}.vertices", self.vertices, ("V", 3), floating=True, finite=False
        )
        faces = call.array(f"{name}.faces", self.faces, ("F", 3), dtype=np.int64)
        if faces.size and not (int(faces.min()) >= 0 and int(faces.max()) < len(vertices)):
            expected = f"vertex numbers 0 to {len(vertices) - 1}"
            got = f"{int(faces.min())} to {int(faces.max())}"
            raise RangeError(message("MeshShape", f"{name}.faces", expected, got))
        emission = checked_color("MeshShape", f"{name}.emission", self.emission)
        vertices, faces = usable_triangles(self.name, vertices, faces)
        if not len(faces):
            shines = bool(emission.any())
            expected = "a light with an area" if shines else "a triangle with an area"
            raise SceneError(message("MeshShape", f"{self.name}.faces", expected, "none"))
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "faces", np.ascontiguousarray(faces, np.uint32))
        object.__setattr__(self, "emission", emission)
        for key, columns in (("normals", 3), ("uv", 2)):
            if getattr(self, key) is not None:
                rows = call.array(
                    f"{name}.{key}", getattr(self, key), ("V", columns), floating=True
                )
                object.__setattr__(self, key, np.array(rows))
        object.__setattr__(
            self, "instances", tuple(checked_instance(self.name, m) for m in self.instances)
        )
        closing = checked_closing_instances(self.name, self.instances, self.closing_instances)
        object.__setattr__(self, "closing_instances", closing)

    @property
    def box(self) -> Array:
        """(2, 3) lower and upper corner of all instances at all times, meters."""
        corners = self.vertices[self.faces.reshape(-1)].astype(np.float64)
        if not self.instances and not self.closing_instances:
            return np.array([corners.min(axis=0), corners.max(axis=0)])
        ends = np.array([corners.min(axis=0), corners.max(axis=0)])
        matrices = (*(self.instances or (np.eye(4),)), *self.closing_instances)
        eight = np.array([[ends[i, 0], ends[j, 1], ends[k, 2]] for i, j, k in np.ndindex(2, 2, 2)])
        world = np.concatenate([eight @ m[:3, :3].T + m[:3, 3] for m in matrices])
        return np.array([world.min(axis=0), world.max(axis=0)])


@typed_call
@dataclass(frozen=True, eq=False)
class SphereShape:
    """A perfect sphere; its outside emits.

    Attributes:
        name: unique in its scene.
        center: (3,) meters.
        radius: meters, above 0.
        material, interior: as for `MeshShape`.
        emission: (3,) radiance.
        closing: (3,) the center when the shutter closes, meters: it moves there straight on. None
            stands still.

    Raises:
        RangeError, ShapeError: numbers that are not finite, a radius of 0, negative emission.
    """

    name: str
    center: Array
    radius: float
    material: str
    emission: Array = field(default_factory=lambda: np.zeros(3))
    interior: str | None = None
    closing: Array | None = None

    def __post_init__(self) -> None:
        call = Arguments("SphereShape", np.float64)
        for key in ("center", "closing"):
            given = getattr(self, key)
            if key == "closing" and given is None:
                continue
            point = call.array(f"{self.name}.{key}", given, (3,))
            object.__setattr__(self, key, point)
        emission = checked_color("SphereShape", f"{self.name}.emission", self.emission)
        if not (np.isfinite(self.radius) and np.float32(self.radius) > 0):
            expected = "above 0 m (a light needs an area)" if emission.any() else "above 0 m"
            raise RangeError(message("SphereShape", f"{self.name}.radius", expected, self.radius))
        object.__setattr__(self, "emission", emission)

    @property
    def box(self) -> Array:
        """(2, 3) lower and upper corner at all times, meters."""
        ends = np.array([self.center, self.center if self.closing is None else self.closing])
        return np.array([ends.min(axis=0) - self.radius, ends.max(axis=0) + self.radius])


@typed_call
@dataclass(frozen=True, eq=False)
class SdfShape:
    """What `photograd.geometry.sdf` builds, with a surface.

    Attributes:
        name: unique in its scene.
        body: a tree of spheres, boxes, tori, ... and of what combines them, in meters of the world.
            It is closed, so that it may be of glass, or filled with a medium. It must end on all
            sides: planes only cut.
        material, interior: as for `MeshShape`. Materials with textures need coordinates, which a
            body has none of.
        emission: 0. Where on such a surface a light sample would go is not known in closed form.

    Raises:
        SceneError: a body that is none, is empty, has no end or nests too deeply; one that shines.
        RangeError: negative emission.
    """

    name: str
    body: SdfNode
    material: str
    emission: Array = field(default_factory=lambda: np.zeros(3))
    interior: str | None = None
    ready: Body = field(init=False, repr=False)
    box: Array = field(init=False, repr=False)
    """(2, 3) lower and upper corner of a box around the body, meters."""

    def __post_init__(self) -> None:
        if not isinstance(self.body, SdfNode):
            expected = "a shape of photograd.geometry.sdf"
            got = type(self.body).__name__
            raise SceneError(message("SdfShape", f"{self.name}.body", expected, got))
        emission = checked_color("SdfShape", f"{self.name}.emission", self.emission)
        if emission.any():
            expected, remedy = "0", "let a mesh or a sphere shine"
            raise SceneError(
                message("SdfShape", f"{self.name}.emission", expected, emission, remedy)
            )
        object.__setattr__(self, "emission", emission)
        object.__setattr__(self, "ready", Body(self.body))
        object.__setattr__(self, "box", self.ready.box)


Shape = MeshShape | SphereShape | SdfShape


def rectangle(
    name: str, corner: Any, edge_u: Any, edge_v: Any, material: str, emission: Any = (0, 0, 0)
) -> MeshShape:
    """A parallelogram of two triangles; its front is the side of edge_u x edge_v.

    A texture stands upright on the front: u grows along edge_u, v against edge_v.

    Args:
        name, material, emission: as for `MeshShape`.
        corner: (3,) meters.
        edge_u, edge_v: (3,) from the corner to its neighbors.
    """
    start, u, v = (np.asarray(x, np.float64) for x in (corner, edge_u, edge_v))
    vertices = np.array([start, start + u, start + u + v, start + v])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    uv = np.array([[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]])
    return MeshShape(name, vertices, faces, material, np.asarray(emission, np.float64), uv=uv)


def box(
    name: str,
    center: Any,
    size: Any,
    material: str,
    emission: Any = (0, 0, 0),
    *,
    turn: float = 0.0,
    inward: bool = False,
) -> MeshShape:
    """A closed box of twelve triangles.

    Args:
        name, material, emission: as for `MeshShape`.
        center, size: (3,) meters.
        turn: degrees around +Y, counter-clockwise seen from above.
        inward: whether the inside is the front: a room.

    Raises:
        RangeError: a size that is not positive.
    """
    extent = Arguments("box", np.float64).array(f"{name}.size", size, (3,), above=0.0)
    corners = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
    angle = np.radians(turn)
    c, s = np.cos(angle), np.sin(angle)
    world_from_object = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    vertices = (0.5 * corners * extent) @ world_from_object.T + np.asarray(center, np.float64)
    faces: Array = np.array(
        [
            [0, 1, 3],
            [0, 3, 2],
            [4, 6, 7],
            [4, 7, 5],
            [0, 4, 5],
            [0, 5, 1],
            [2, 3, 7],
            [2, 7, 6],
            [0, 2, 6],
            [0, 6, 4],
            [1, 5, 7],
            [1, 7, 3],
        ]
    )
    if inward:
        faces = faces[:, ::-1]
    return MeshShape(name, vertices, faces, material, np.asarray(emission, np.float64))
