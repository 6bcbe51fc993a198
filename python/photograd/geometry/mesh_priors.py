"""Two priors on the shape of a mesh: smooth vertices and smooth normals; each with its adjoint.

Laplacian, with the mean of the N(i) neighbors of each of V vertices [Sorkine2004, Sect. 2]:

    delta_i = x_i - 1 / |N(i)| sum over j in N(i) of x_j      E = 1 / (V s^2) sum |delta_i|^2
    d_x_i += 2 / (V s^2) (delta_i - sum over j in N(i) of delta_j / |N(j)|)

Normal consistency, over the M edges (a, b) of two faces, with opposite vertices c and d:

    e = b - a   N = e x (c - a)   N' = (d - a) x e   n = N / |N|   E = 1 / M sum (1 - <n, n'>)
    d_N -= (n' - <n, n'> n) / (M |N|)                and alike for N'
    d_e += (c - a) x d_N + d_N' x (d - a)   d_c += d_N x e   d_d += e x d_N'   d_a -= all of them

N and N' point to one side of the surface whichever way its faces run. An edge of a face without
area counts nothing, and a vertex without neighbors neither. s is a length, so that E is a number
without a unit.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd.types import Array, FloatArray


class LaplacianEnergy:
    """How far vertices lie from the mean of their neighbors; depends on the edges alone."""

    def __init__(self, ends: Array, count: int, scale: float) -> None:
        """Prepare the sums.

        Args:
            ends: (E, 2) vertex numbers of each edge, each edge once, as `MeshEdges.ends`.
            count: V, the number of vertices.
            scale: s, meters.

        Raises:
            DtypeError, ShapeError, RangeError: arrays or numbers that are no such thing.
        """
        call = Arguments("LaplacianEnergy", np.float64)
        self.count = call.integer("count", count, low=1)
        self._factor = 1 / (count * call.number("scale", scale, above=0) ** 2)
        ends = call.array("ends", ends, ("E", 2), dtype=np.int64, low=0, high=count - 1)
        self._vertex: npt.NDArray[np.int64] = np.concatenate([ends[:, 0], ends[:, 1]])
        self._neighbor: npt.NDArray[np.int64] = np.concatenate([ends[:, 1], ends[:, 0]])
        degree = np.bincount(self._vertex, minlength=count).astype(np.float64)
        self._share = np.where(degree > 0, 1 / np.maximum(degree, 1), 0.0)[:, None]

    def value(self, vertices: Array) -> float:
        """E of vertices (V, 3).

        Raises:
            DtypeError, ShapeError, RangeError: not finite numbers of that shape.
        """
        return self._factor * float(np.square(self._delta(vertices)).sum())

    def gradient(self, vertices: Array, d_value: float = 1.0) -> FloatArray:
        """dL/dvertices (V, 3) for dL/dE.

        Args:
            vertices: (V, 3).
            d_value: dL/dE.

        Raises:
            DtypeError, ShapeError, RangeError: as for `value`.
        """
        delta = self._delta(vertices)
        around = _sums(self._vertex, (self._share * delta)[self._neighbor], self.count)
        found: FloatArray = 2 * self._factor * d_value * (delta - around)
        return found

    def _delta(self, vertices: Array) -> FloatArray:
        call = Arguments("LaplacianEnergy", np.float64)
        x = call.array("vertices", vertices, (self.count, 3))
        mean = self._share * _sums(self._vertex, x[self._neighbor], self.count)
        found: FloatArray = np.where(self._share > 0, x - mean, 0.0)
        return found


@dataclass(frozen=True, eq=False)
class _Pairs:
    """The quantities above for the K edges whose faces have area."""

    owner: npt.NDArray[np.int64]  # (4, K): a, b, c, d
    e: FloatArray  # (K, 3)
    p: FloatArray  # (K, 3): c - a
    q: FloatArray  # (K, 3): d - a
    n: tuple[FloatArray, FloatArray]  # (K, 3) each
    length: tuple[FloatArray, FloatArray]  # (K, 1) each
    cosine: FloatArray  # (K, 1)


class NormalConsistency:
    """How much the normals of neighboring faces differ; depends on the edges alone."""

    def __init__(self, ends: Array, opposite: Array) -> None:
        """Keep the edges of two faces.

        Args:
            ends: (E, 2) vertex numbers of each edge, each edge once, as `MeshEdges.ends`.
            opposite: (E, 2) third vertices of the two faces at each edge, -1 where there are not
                two, as `MeshEdges.opposite`.

        Raises:
            DtypeError, ShapeError, RangeError: arrays that are no such thing.
        """
        call = Arguments("NormalConsistency", np.float64)
        ends = call.array("ends", ends, ("E", 2), dtype=np.int64, low=0)
        opposite = call.array("opposite", opposite, (len(ends), 2), dtype=np.int64, low=-1)
        inner = (opposite >= 0).all(axis=1)
        owner = np.concatenate([ends[inner], opposite[inner]], axis=1).T
        self._owner: npt.NDArray[np.int64] = owner
        self._count = int(owner.max(initial=-1)) + 1

    def value(self, vertices: Array) -> float:
        """E of vertices (V, 3); 0 for a mesh without an edge of two faces.

        Raises:
            DtypeError, ShapeError, RangeError: not finite numbers of that shape.
        """
        pairs = self._pairs(vertices)
        total = float((1 - pairs.cosine).sum())
        return total / max(len(self._owner[0]), 1)

    def gradient(self, vertices: Array, d_value: float = 1.0) -> FloatArray:
        """dL/dvertices (V, 3) for dL/dE.

        Args:
            vertices: (V, 3).
            d_value: dL/dE.

        Raises:
            DtypeError, ShapeError, RangeError: as for `value`.
        """
        k = self._pairs(vertices)
        scale = d_value / max(self._owner.shape[1], 1)
        d_first = -scale * (k.n[1] - k.cosine * k.n[0]) / k.length[0]
        d_second = -scale * (k.n[0] - k.cosine * k.n[1]) / k.length[1]
        d_e = np.cross(k.p, d_first) + np.cross(d_second, k.q)
        d_c, d_d = np.cross(d_first, k.e), np.cross(k.e, d_second)
        rows = np.concatenate([-(d_e + d_c + d_d), d_e, d_c, d_d])
        return _sums(k.owner.reshape(-1), rows, len(vertices))

    def _pairs(self, vertices: Array) -> _Pairs:
        call = Arguments("NormalConsistency", np.float64)
        x = call.array("vertices", vertices, ("V", 3), min_length=self._count)
        a, b, c, d = (x[owner] for owner in self._owner)
        e, p, q = b - a, c - a, d - a
        normals = np.cross(e, p), np.cross(q, e)
        length = [np.sqrt(np.square(n).sum(axis=1, keepdims=True)) for n in normals]
        kept = ((length[0] > 0) & (length[1] > 0))[:, 0]
        n = normals[0][kept] / length[0][kept], normals[1][kept] / length[1][kept]
        cosine = (n[0] * n[1]).sum(axis=1, keepdims=True)
        lengths = length[0][kept], length[1][kept]
        return _Pairs(self._owner[:, kept], e[kept], p[kept], q[kept], n, lengths, cosine)


def _sums(owner: npt.NDArray[np.int64], rows: FloatArray, count: int) -> FloatArray:
    """(count, 3) sums of the rows of each owner, in their order."""
    columns = [np.bincount(owner, weights=column, minlength=count) for column in rows.T]
    return np.stack(columns, axis=-1)
