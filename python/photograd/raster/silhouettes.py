"""The silhouettes of a mesh as segments of the image."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from photograd.raster.edges import MeshEdges
from photograd.types import FloatArray


@dataclass(frozen=True, eq=False)
class Segments:
    """Silhouettes within a picture, each cut at its border and at the near plane.

    With the ends a, b of an edge in homogeneous pixels, its line in the image is
    <a x b, (x, y, 1)> = 0, also where an end lies behind the camera.

    Attributes:
        edges: (N,) numbers of the edges.
        start, end: (N, 2) positions in pixels.
        line: (N, 3) a x b.
        side: (N,) 1 where the face lies on the side of the line with positive values, else -1; 0
            for an edge with three faces or more.
    """

    edges: npt.NDArray[np.int64]
    start: FloatArray
    end: FloatArray
    line: FloatArray
    side: FloatArray

    @classmethod
    def of(
        cls, positions: FloatArray, edges: MeshEdges, size: tuple[int, int], near: float
    ) -> Segments:
        """The silhouettes of a mesh.

        Args:
            positions: (V, 3) vertices in homogeneous pixels.
            edges: of the mesh.
            size: (height, width) of the picture.
            near: of the near plane, meters.
        """
        chosen = np.flatnonzero(edges.silhouettes(positions))
        a, b = (positions[edges.ends[chosen, k]] for k in range(2))
        low, high = _cut(a, b, size, near)
        kept = low < high
        chosen, a, b, low, high = chosen[kept], a[kept], b[kept], low[kept], high[kept]
        line = np.cross(a, b)
        inner = edges.inner[chosen]
        value = np.einsum("nc,nc->n", line, positions[np.maximum(inner, 0)])
        start, end = (_on_screen(a + t[:, None] * (b - a)) for t in (low, high))
        return cls(chosen, start, end, line, np.where(inner < 0, 0.0, np.sign(value)))


def line_backward(
    positions: FloatArray, edges: MeshEdges, owner: npt.NDArray[np.int64], d_line: FloatArray
) -> FloatArray:
    """dL/dpositions (V, 3) of cotangents d_line (N, 3) of the lines of the edges `owner` (N,).

    d_a += b x d_line and d_b += d_line x a.

    Args:
        positions: (V, 3) vertices in homogeneous pixels.
        edges: of the mesh.
        owner: (N,) numbers of edges.
        d_line: (N, 3).
    """
    first, second = edges.ends[owner].T.astype(np.int64)
    d_a = np.cross(positions[second], d_line)
    d_b = np.cross(d_line, positions[first])
    return sums(np.concatenate([first, second]), np.concatenate([d_a, d_b]), len(positions))


def sums(owner: npt.NDArray[np.int64], rows: FloatArray, count: int) -> FloatArray:
    """(count, K) sums of the rows (N, K) of each `owner` (N,) below `count`, in their order."""
    columns = [np.bincount(owner, weights=column, minlength=count) for column in rows.T]
    return np.stack(columns, axis=-1)


def _on_screen(positions: FloatArray) -> FloatArray:
    found: FloatArray = positions[:, :2] / positions[:, 2:]
    return found


def _cut(
    a: FloatArray, b: FloatArray, size: tuple[int, int], near: float
) -> tuple[FloatArray, FloatArray]:
    """Parameters (E,) between which a + t (b - a) lies beyond the near plane and in the picture.

    Each of five planes keeps the t with h(t) >= 0, which is linear [Liang1984].
    """
    height, width = size
    planes = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, width], [0, -1, height]], float)
    low, high = np.zeros(len(a)), np.ones(len(a))
    for plane, offset in zip(planes, (near, 0, 0, 0, 0), strict=True):
        at_a, at_b = (np.einsum("nc,c->n", v, plane) - offset for v in (a, b))
        change = at_b - at_a
        with np.errstate(divide="ignore", invalid="ignore"):
            t = -at_a / change
        low = np.where(change > 0, np.maximum(low, t), low)
        high = np.where(change < 0, np.minimum(high, t), high)
        high = np.where((change == 0) & (at_a < 0), -1.0, high)
    return low, high
