"""Triangle meshes and the rays that meet them: what was hit, and where.

The answer to *which* triangle comes from a bounding volume hierarchy in float32, robust at shared
edges; *where* is recomputed in the dtype of the rays (cpp/photograd/geometry/bvh.h).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.errors import SceneError, message
from photograd.types import Array


@typed_call
@dataclass(frozen=True, eq=False)
class Mesh:
    """A triangle mesh in its own object space, meters.

    Attributes:
        vertices: (V, 3) floating point; kept as float32, as the tracer has them.
        faces: (F, 3) integer vertex numbers, counter-clockwise seen from outside; kept as uint32.
        uv: (V, 2) texture coordinates, v downwards, or None; kept as float32.

    Raises:
        DtypeError, ShapeError: other types or shapes.
        RangeError: a negative vertex number.
    """

    vertices: Array
    faces: Array
    uv: Array | None = None

    def __post_init__(self) -> None:
        call = Arguments("Mesh", np.float32)
        for name, columns in (("vertices", 3), ("uv", 2)):
            value = getattr(self, name)
            if value is not None:
                array = call.array(name, value, ("V", columns), floating=True, finite=False)
                object.__setattr__(self, name, array)
        faces = call.array("faces", self.faces, ("F", 3), dtype=np.uint32)
        object.__setattr__(self, "faces", faces)


@dataclass(frozen=True, eq=False)
class Instance:
    """One placement of a mesh.

    Attributes:
        mesh: number of the mesh in the list given to `Bvh`.
        world_from_object: (3, 4) or (4, 4) affine matrix; the identity is faster than any other.
    """

    mesh: int
    world_from_object: Array = field(default_factory=lambda: np.eye(4))


@dataclass(frozen=True, eq=False)
class Hits:
    """Nearest hits of R rays.

    Attributes:
        t: (R,) distance in lengths of the ray's direction; infinite where nothing was hit.
        primitive: (R,) int32 triangle number in its mesh, or -1.
        instance: (R,) int32 instance number, or -1.
        barycentrics: (R, 2) weights u, v of the triangle's second and third corner.
    """

    t: Array
    primitive: npt.NDArray[np.int32]
    instance: npt.NDArray[np.int32]
    barycentrics: Array

    @classmethod
    def empty(cls, count: int, dtype: npt.DTypeLike) -> Hits:
        """Arrays of unwritten memory for `count` rays of `dtype`."""
        return cls(
            np.empty(count, dtype),
            np.empty(count, np.int32),
            np.empty(count, np.int32),
            np.empty((count, 2), dtype),
        )

    @property
    def hit(self) -> npt.NDArray[np.bool_]:
        """(R,) whether anything was hit."""
        return self.primitive >= 0


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Where rays met surfaces, in the dtype of the rays; rows without a hit hold zeros.

    Attributes:
        t: (R,) distance in lengths of the direction, infinite without a hit.
        barycentrics: (R, 2).
        uv: (R, 2) texture coordinates; the barycentrics in a mesh without any.
        position: (R, 3) in the world.
        normal: (R, 3) unit geometric normal of the side from which the corners run
            counter-clockwise, whichever side the ray came from.
    """

    t: Array
    barycentrics: Array
    uv: Array
    position: Array
    normal: Array


class Bvh:
    """Meshes and their instances, ready to be traced; built once, read by any number of calls."""

    def __init__(
        self, meshes: Mesh | Sequence[Mesh], instances: Sequence[Instance] | None = None
    ) -> None:
        """Build the hierarchy.

        Args:
            meshes: one mesh or several.
            instances: placements; None places every mesh once, where it is.

        Raises:
            SceneError: no mesh or instance; vertices that are not finite, vertex numbers out of
                range, triangles without area (each named); a matrix that is not invertible.
            ShapeError: a matrix that is neither (3, 4) nor (4, 4).
        """
        parts = [meshes] if isinstance(meshes, Mesh) else list(meshes)
        if not parts:
            raise SceneError(message("Bvh", "meshes", "at least one mesh", "none"))
        if instances is None:
            instances = [Instance(number) for number in range(len(parts))]
        numbers = np.array([int(instance.mesh) for instance in instances], np.int32)
        call = Arguments("Instance", np.float64)
        matrices = [
            call.array("world_from_object", each.world_from_object, (3, 4), (4, 4), finite=False)[
                :3
            ]
            for each in instances
        ]
        self._core = _core.Bvh(
            [(mesh.vertices, mesh.faces, mesh.uv) for mesh in parts],
            numbers,
            np.array(matrices, np.float64).reshape(-1, 3, 4),
        )

    @property
    def core(self) -> Any:
        """The core's object, for functions of this package."""
        return self._core

    @property
    def bounds(self) -> npt.NDArray[np.float32]:
        """(2, 3) lower and upper corner of everything, in the world."""
        corners: npt.NDArray[np.float32] = self._core.bounds
        return corners

    def trace(
        self,
        origins: Array,
        directions: Array,
        t_min: float | Array = 0.0,
        t_max: float | Array = np.inf,
        *,
        out: Hits | None = None,
    ) -> Hits:
        """Nearest hit of each ray within [t_min, t_max].

        Rays may come in any order. Neighboring camera rays are fastest row by row, as a camera
        makes them; rays in random directions are reordered inside, at the call's own expense. The
        result has the order of the input and the same bits for any number of threads. Which of two
        triangles is named where both are hit at one place (an edge) may depend on the other rays.

        Args:
            origins, directions: (R, 3), float32 (used in place if C-contiguous) or float64;
                directions of any length but zero.
            t_min, t_max: a number, or (R,) of the same dtype; t counts in lengths of the direction.
            out: hits of an earlier call with as many rays, whose arrays are filled and returned;
                fresh memory for millions of rays costs as much as a tenth of their tracing.

        Raises:
            DtypeError, ShapeError: arrays of other or different types or shapes.
            RangeError: rays that are not finite or have no direction, counted.
        """
        call = Arguments("Bvh.trace")
        origins, directions = _rays(call, origins, directions)
        low, high = _interval(call, t_min, t_max)
        hits = Hits.empty(len(origins), origins.dtype) if out is None else out
        results = (hits.t, hits.primitive, hits.instance, hits.barycentrics)
        call.run(self._core.trace, origins, directions, low, high, *results)
        return hits

    def occluded(
        self,
        origins: Array,
        directions: Array,
        t_min: float | Array = 0.0,
        t_max: float | Array = np.inf,
    ) -> npt.NDArray[np.bool_]:
        """Whether anything at all lies within [t_min, t_max] of each ray: (R,) bool.

        Arguments and errors as for `trace`, which it is faster than.
        """
        call = Arguments("Bvh.occluded")
        origins, directions = _rays(call, origins, directions)
        low, high = _interval(call, t_min, t_max)
        blocked: npt.NDArray[np.bool_] = call.run(
            self._core.occluded, origins, directions, low, high
        )
        return blocked

    def surface_points(self, origins: Array, directions: Array, hits: Hits) -> SurfacePoints:
        """Where the rays met the triangles that `trace` named.

        Args:
            origins, directions: (R, 3), the rays that were traced; the dtype may be another one.
            hits: of the same R rays.

        Raises:
            DtypeError, ShapeError: as for `trace`.
            RangeError: numbers that name no triangle of these meshes.
        """
        call = Arguments("Bvh.surface_points")
        origins, directions = _rays(call, origins, directions)
        arguments = (origins, directions, hits.primitive, hits.instance)
        return SurfacePoints(*call.run(self._core.surface_points, *arguments))


def drop_degenerate(vertices: Array, faces: Array) -> Array:
    """The rows of `faces` (F, 3) whose triangles have an area; vertices (V, 3) are left alone.

    A triangle counts as flat where twice its area is at most 1e-9 of its longest edge squared, as
    `Bvh` has it.
    """
    corners = np.asarray(vertices, np.float32).astype(np.float64)[np.asarray(faces)]
    first, second, third = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = np.cross(second - first, third - first)
    edges = np.stack([second - first, third - first, third - second])
    longest = np.square(edges).sum(axis=-1).max(axis=0)
    kept: Array = np.asarray(faces)[np.square(normal).sum(axis=-1) > 1e-18 * longest**2]
    return kept


def _rays(call: Arguments, origins: Array, directions: Array) -> tuple[Array, Array]:
    starts = call.array("origins", origins, ("R", 3), finite=False)
    return starts, call.array("directions", directions, ("R", 3), finite=False)


def _interval(call: Arguments, t_min: float | Array, t_max: float | Array) -> tuple[Array, Array]:
    low, high = (
        call.array(name, value, (), ("R",), finite=False, low=-np.inf).reshape(-1)
        for name, value in (("t_min", t_min), ("t_max", t_max))
    )
    return low, high


# The point of a mesh that is nearest to a point.


@typed_call
def nearest_on_mesh(points: Any, mesh: Mesh) -> tuple[Array, Array]:
    """Distances (N,) and nearest points (N, 3) of points (N, 3), by a look at every triangle.

    Where the foot of the perpendicular lies in the triangle, it is the nearest point; otherwise one
    of the three edges has it.

    Raises:
        ShapeError, RangeError: points that are not (N, 3) or not finite.
    """
    rows = Arguments("nearest_on_mesh", np.float64).array("points", points, ("N", 3))
    if not len(rows):
        return np.zeros(0), np.zeros((0, 3))
    corners = mesh.vertices.astype(np.float64)[mesh.faces]
    step = max(1, 100_000 // len(corners))  # pairs at a time: 2.4 MB a vector
    parts = [_nearest(rows[i : i + step], corners) for i in range(0, len(rows), step)]
    distance, nearest = (np.concatenate(part) for part in zip(*parts, strict=True))
    return distance, nearest


def _nearest(points: Array, corners: Array) -> tuple[Array, Array]:
    p = points[:, None]
    a, b, c = (corners[None, :, k] for k in range(3))
    candidates = [_on_segment(p, *edge) for edge in ((a, b), (b, c), (c, a))]
    ab, ac = b - a, c - a
    normal = np.cross(ab, ac)
    square = (normal**2).sum(axis=-1)
    v = (np.cross(p - a, ac) * normal).sum(axis=-1) / square  # weight of b
    w = (np.cross(ab, p - a) * normal).sum(axis=-1) / square  # weight of c
    foot = a + v[..., None] * ab + w[..., None] * ac
    inside = (v >= 0) & (w >= 0) & (v + w <= 1)
    candidates.append(np.where(inside[..., None], foot, np.inf))
    gaps = np.array([((q - p) ** 2).sum(axis=-1) for q in candidates])  # (4, N, F)
    least = gaps.swapaxes(0, 1).reshape(len(points), -1).argmin(axis=1)
    kind, face = np.divmod(least, len(corners))
    row = np.arange(len(points))
    point = np.array(candidates)[kind, row, face]
    return np.sqrt(gaps[kind, row, face]), point


def _on_segment(p: Array, a: Array, b: Array) -> Array:
    along = b - a
    share = ((p - a) * along).sum(axis=-1) / (along**2).sum(axis=-1)
    point: Array = a + share.clip(0.0, 1.0)[..., None] * along
    return point
