"""Triangulated surfaces before they are painted: from nets, heights, lathes and tubes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from photograd_course.checks import require_integer, require_number

from photograd._arrays import Arguments
from photograd.errors import RangeError, message
from photograd.scenes.curves import smooth_curve, untwisted_frames
from photograd.scenes.description import SceneMesh
from photograd.types import FloatArray


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles in double precision, counter-clockwise seen from outside.

    Attributes:
        vertices: (V, 3) float64, meters.
        faces: (F, 3) int64.
        uv: (V, 2) float64; u right and v down, both in 0..1.
    """

    vertices: FloatArray
    faces: npt.NDArray[np.int64]
    uv: FloatArray

    def moved(
        self,
        by: tuple[float, float, float] = (0.0, 0.0, 0.0),
        *,
        rotation: FloatArray | None = None,
    ) -> Surface:
        """Turned by a (3, 3) `rotation` about the origin, then shifted `by` meters."""
        turned = self.vertices if rotation is None else self.vertices @ rotation.T
        return Surface(turned + np.asarray(by), self.faces, self.uv)

    def painted(self, albedo: npt.NDArray[np.floating]) -> SceneMesh:
        """The mesh in single precision, with an albedo as `SceneMesh` takes it."""
        return SceneMesh(
            self.vertices.astype(np.float32),
            self.faces.astype(np.uint32),
            np.asarray(albedo, dtype=np.float32),
            self.uv.astype(np.float32),
        )


def joined(surfaces: list[Surface]) -> Surface:
    """One surface of several, in their order."""
    starts = np.cumsum([0] + [len(surface.vertices) for surface in surfaces[:-1]])
    faces = [surface.faces + start for surface, start in zip(surfaces, starts, strict=True)]
    return Surface(
        np.concatenate([surface.vertices for surface in surfaces]),
        np.concatenate(faces),
        np.concatenate([surface.uv for surface in surfaces]),
    )


def from_grid(
    points: FloatArray, *, closed_rows: bool = False, closed_columns: bool = False
) -> Surface:
    """The surface through a net of points: u along a row, v from row to row.

    Seen from outside, u runs to the right and v downwards. A closed net gets its first row (or
    column) once more at the end, the very same numbers, with v (or u) = 1, so that a texture has
    its seam there and the surface has no gap. Where the points of a row coincide, as in a pole,
    the triangles without area are left out.

    Args:
        points: (M, N, 3), at least two rows and two columns.
        closed_rows: whether the last row is followed by the first.
        closed_columns: whether the last column is followed by the first.

    Raises:
        ShapeError: points not (M, N, 3) with M, N >= 2.
    """
    call = Arguments("from_grid", np.float64)
    points = call.array("points", points, ("M", "N", 3), finite=False, min_length=2)
    if closed_rows:
        points = np.concatenate([points, points[:1]])
    if closed_columns:
        points = np.concatenate([points, points[:, :1]], axis=1)
    rows, columns = points.shape[:2]
    index = np.arange(rows * columns).reshape(rows, columns)
    here, right = index[:-1, :-1], index[:-1, 1:]
    below, across = index[1:, :-1], index[1:, 1:]
    triangles = [np.stack([here, below, across], -1), np.stack([here, across, right], -1)]
    faces = np.stack(triangles, axis=2).reshape(-1, 3)
    v, u = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 1, columns), indexing="ij")
    vertices = points.reshape(-1, 3)
    return Surface(vertices, _with_area(vertices, faces), np.stack([u, v], -1).reshape(-1, 2))


def _with_area(vertices: FloatArray, faces: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Triangles whose corners are three different points, also in single precision."""
    a, b, c = (vertices.astype(np.float32)[faces[:, k]] for k in range(3))
    same = (a == b).all(axis=1) | (b == c).all(axis=1) | (c == a).all(axis=1)
    return np.asarray(faces[~same])


def rotation_about(axis: str, angle: float) -> FloatArray:
    """(3, 3) turn by `angle` degrees, counter-clockwise seen against the axis "x", "y" or "z"."""
    first, second = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    cosine, sine = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    matrix = np.eye(3)
    matrix[first, first] = matrix[second, second] = cosine
    matrix[first, second], matrix[second, first] = -sine, sine
    return matrix


# A block of land: heights on a square net, with upright sides and a flat bottom.


def net_points(count: int, half_size: float) -> FloatArray:
    """(count, count, 2) positions (x, z) of a net: rows towards +Z, columns towards +X."""
    line = np.linspace(-half_size, half_size, count)
    x, z = np.meshgrid(line, line)
    return np.stack([x, z], axis=-1)


def land_block(
    heights: FloatArray, half_size: float, floor: float, *, layers: int = 24
) -> tuple[Surface, Surface]:
    """The top, and the sides with the bottom; together they are watertight.

    Args:
        heights: (M, M) meters at `net_points(M, half_size)`, M >= 2.
        half_size: meters from the middle to each side.
        floor: height of the bottom, below all heights.
        layers: number of faces between top and bottom.

    Returns:
        Two surfaces. The top keeps the order of `heights`: vertex row * M + column.

    Raises:
        ShapeError, RangeError, DtypeError: heights not square, not finite or not above the floor.
    """
    call = Arguments("land_block", np.float64)
    heights = call.array("heights", heights, ("M", "M"), min_length=2)
    require_number("land_block", "half_size", half_size, least=0.0, open_ends=True)
    if not bool((heights > floor).all()):
        expected = f"heights above the floor at {floor:g}"
        raise RangeError(message("land_block", "heights", expected, float(heights.min())))
    plan = net_points(len(heights), half_size)
    top = np.stack([plan[..., 0], heights, plan[..., 1]], axis=-1)
    bottom = top.copy()
    bottom[..., 1] = floor
    share = np.linspace(0.0, 1.0, layers + 1)[:, None, None]
    edge_top, edge_bottom = _edge(top), _edge(bottom)
    # Written so that both ends are the very numbers of top and bottom.
    walls = (1.0 - share) * edge_top + share * edge_bottom
    walls[..., [0, 2]] = edge_top[:, [0, 2]]
    sides = from_grid(walls, closed_columns=True)
    return from_grid(top), joined([sides, from_grid(bottom[::-1])])


def _edge(points: FloatArray) -> FloatArray:
    """The net's outermost points (4 M - 4, 3), to the right as seen from outside, from (-X, +Z)."""
    front, right = points[-1, :-1], points[:0:-1, -1]
    back, left = points[0, :0:-1], points[:-1, 0]
    return np.concatenate([front, right, back, left])


# Solids turned on a lathe, and profiles for them.


def lathe(profile: FloatArray, *, columns: int = 96) -> Surface:
    """The solid that a profile sweeps around the +Y axis.

    Args:
        profile: (M, 2) of (radius, height), from top to bottom on the outside, both ends on the
            axis (radius 0). A vessel starts on the floor inside, rises along the inner wall and
            comes down outside. u runs around, v along the profile.
        columns: number of faces around, at least 3.

    Raises:
        ShapeError, RangeError, DtypeError: not (M, 2), negative radii, ends off the axis, fewer
            than 3 columns.
    """
    require_integer("lathe", "columns", columns, least=3)
    call = Arguments("lathe", np.float64)
    profile = call.array("profile", profile, ("M", 2), min_length=3)
    radius, height = profile.T
    if float(radius.min()) < 0.0:
        raise RangeError(message("lathe", "profile", "radii of at least 0", radius.min()))
    if radius[0] != 0.0 or radius[-1] != 0.0:
        got = f"radii {radius[0]:g} and {radius[-1]:g}"
        raise RangeError(message("lathe", "profile", "both ends on the axis", got))
    angle = 2.0 * np.pi * np.arange(columns) / columns
    ring = np.stack([np.sin(angle), np.zeros(columns), np.cos(angle)], axis=-1)
    points = radius[:, None, None] * ring
    points[..., 1] = height[:, None]
    return from_grid(points, closed_columns=True)


def rounded_profile(corners: list[tuple[float, float]], *, count: int = 96) -> FloatArray:
    """A profile (count, 2) for `lathe` through `corners` (radius, height), both ends on the axis.

    A corner given twice stays sharp; all others are rounded.
    """
    profile = smooth_curve(np.array(corners, dtype=np.float64), count)
    profile[:, 0] = np.clip(profile[:, 0], 0.0, None)
    profile[[0, -1], 0] = 0.0
    return profile


# Tubes along curves: wires, handles, branches.


_CAP_RINGS = 4


def tube(
    curve: FloatArray, radius: float | FloatArray, *, sides: int = 16, closed: bool = False
) -> Surface:
    """A round tube, watertight: closed upon itself, or with half a ball at both ends.

    u runs around, v along the curve. The curve is expected to bend by less than 1 / radius.

    Args:
        curve: (N, 3), neighbors different.
        radius: meters, one number or (N,).
        sides: number of faces around, at least 3.
        closed: whether the last point is followed by the first.

    Raises:
        ShapeError, RangeError, DtypeError: a curve that `untwisted_frames` refuses, radii of
            another count or not positive, fewer than 3 sides.
    """
    require_integer("tube", "sides", sides, least=3)
    tangents, normals = untwisted_frames(curve, closed=closed)
    centers = np.asarray(curve, dtype=np.float64)
    call = Arguments("tube", np.float64)
    radii = call.array("radius", radius, (), (len(centers),), above=0.0)
    radii = np.broadcast_to(radii, len(centers)).copy()
    if not closed:
        centers, radii, tangents, normals = _with_caps(centers, radii, tangents, normals)
    angle = 2.0 * np.pi * np.arange(sides) / sides
    # Seen from outside with the curve running down, the right-hand side is normal x tangent.
    across = np.cross(normals, tangents)
    ring = np.cos(angle)[:, None] * normals[:, None] + np.sin(angle)[:, None] * across[:, None]
    points = centers[:, None] + radii[:, None, None] * ring
    return from_grid(points, closed_rows=closed, closed_columns=True)


def _with_caps(
    centers: FloatArray, radii: FloatArray, tangents: FloatArray, normals: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Rings of half a ball before the first and after the last, down to a pole of radius 0."""
    angle = 0.5 * np.pi * np.arange(_CAP_RINGS) / _CAP_RINGS
    rise, shrink = np.cos(angle), np.sin(angle)
    start = centers[0] - radii[0] * rise[:, None] * tangents[0]
    end = (centers[-1] + radii[-1] * rise[:, None] * tangents[-1])[::-1]
    index = np.pad(np.arange(len(centers)), _CAP_RINGS, mode="edge")
    all_radii = np.concatenate([radii[0] * shrink, radii, radii[-1] * shrink[::-1]])
    return np.concatenate([start, centers, end]), all_radii, tangents[index], normals[index]
