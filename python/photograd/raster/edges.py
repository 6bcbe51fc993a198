"""The edges of a mesh, and which of them are silhouettes for a camera."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.types import Array, FloatArray


@typed_call
@dataclass(frozen=True, eq=False)
class MeshEdges:
    """Edges of a triangle mesh, each once. It depends on the faces alone; make it once for a mesh.

    Attributes:
        ends: (E, 2) uint32 vertex numbers.
        opposite: (E, 2) int32, the third vertices of the two faces at the edge. -1 twice where
            there are not two: at a border, and where three faces or more meet.
        inner: (E,) int32, the third vertex of the first face at the edge; -1 where three or more
            meet, whose silhouette has no inside.
        borders: number of edges with one face.
        crowded: number of edges with three faces or more.
    """

    ends: npt.NDArray[np.uint32]
    opposite: npt.NDArray[np.int32]
    inner: npt.NDArray[np.int32]
    borders: int
    crowded: int

    @classmethod
    def of(cls, faces: Array, vertices: Array | None = None) -> MeshEdges:
        """The edges of triangles; those of one vertex twice are left out.

        Args:
            faces: (F, 3) vertex numbers.
            vertices: (V, 3); vertices at exactly one position count as one, as they do where
                texture coordinates have a seam. None goes by the numbers alone.

        Raises:
            DtypeError, ShapeError, RangeError: arrays of other types or shapes, numbers that name
                no vertex.
        """
        call = Arguments("MeshEdges.of", np.float64)
        faces = call.array("faces", faces, ("F", 3), dtype=np.int64, low=0)
        if vertices is not None:
            vertices = call.array("vertices", vertices, ("V", 3), min_length=1)
            high = len(vertices) - 1
            faces = call.array("faces", faces, ("F", 3), dtype=np.int64, low=0, high=high)
            faces = _first_of_each_position(vertices)[faces]
        # A face with one vertex twice has no area, and would make a border look like an inner edge.
        faces = faces[(faces != np.roll(faces, -1, axis=1)).all(axis=1)]
        corners = np.roll(faces, -1, axis=1), np.roll(faces, -2, axis=1)
        pairs = np.sort(np.stack(corners, axis=-1).reshape(-1, 2), axis=1)
        ends, number = np.unique(pairs, axis=0, return_inverse=True)
        number = number.reshape(-1)
        count = np.bincount(number, minlength=len(ends))
        order = np.argsort(number, kind="stable")
        first = np.cumsum(count) - count
        corner = faces.reshape(-1)[order]
        opposite = np.full((len(ends), 2), -1, np.int32)
        two = count == 2
        opposite[two] = corner[first[two, None] + np.arange(2)]
        return cls(
            ends.astype(np.uint32).reshape(-1, 2),
            opposite,
            np.where(count > 2, -1, corner[first]).astype(np.int32),
            int((count == 1).sum()),
            int((count > 2).sum()),
        )

    def silhouettes(self, positions: FloatArray) -> npt.NDArray[np.uint8]:
        """(E,) 1 where an edge may be seen against something behind it, 0 elsewhere.

        That is an edge between a face that shows its front and one that shows its back, a border,
        and an edge with three faces or more.

        Args:
            positions: (V, 3) vertices in homogeneous pixels, of `project`.

        Raises:
            DtypeError, ShapeError, RangeError: positions that are not finite numbers (V, 3), or of
                fewer vertices than the mesh has.
        """
        call = Arguments("MeshEdges.silhouettes", np.float64)
        positions = call.array("positions", positions, ("V", 3))
        flags = np.zeros(len(self.ends), np.uint8)
        call.run(_core.silhouettes, positions, self.ends, self.opposite, flags)
        return flags


def _first_of_each_position(vertices: FloatArray) -> npt.NDArray[np.int64]:
    """(V,) the least number of a vertex at the same position."""
    _, first, group = np.unique(vertices + 0.0, axis=0, return_index=True, return_inverse=True)
    found: npt.NDArray[np.int64] = first[group.reshape(-1)]
    return found
