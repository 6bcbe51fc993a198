"""Triangulated surfaces before they are painted, and what can be done with any of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from photograd.errors import ShapeError, message
from photograd.scenes.description import SceneMesh
from photograd.types import FloatArray


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles in double precision, counter-clockwise seen from outside.

    Attributes:
        vertices: (V, 3) float64, metres.
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
        """Turned by a (3, 3) `rotation` about the origin, then shifted `by` metres."""
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
    points = np.asarray(points, dtype=np.float64)
    if points.ndim != 3 or points.shape[2] != 3 or min(points.shape[:2]) < 2:
        expected = "shape (M, N, 3) with M, N >= 2"
        raise ShapeError(message("from_grid", "points", expected, points.shape))
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
