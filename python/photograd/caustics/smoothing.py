"""Height fields from slopes, and smooth steps of height fields, by cosine transforms.

L is the Laplacian of a grid with free borders, (L h)_i = sum over the neighbors j of h_i - h_j. The
cosines cos(pi k (i + 1/2) / n) are its eigenvectors in each direction, with the eigenvalues
2 - 2 cos(pi k / n), so that solving with it is four products with small matrices.
"""

from __future__ import annotations

import math

import numpy as np
from photograd_course.portable_math import cos

from photograd.types import FloatArray


class CosineBasis:
    """Eigenvectors of the Laplacian of an (m, n) grid."""

    def __init__(self, m: int, n: int) -> None:
        """Compute both matrices.

        Args:
            m, n: rows and columns.
        """
        self._rows, self._row_values = _basis(m)
        self._columns, self._column_values = _basis(n)

    def smooth(self, u: FloatArray, smoothness: float) -> FloatArray:
        """(I + smoothness L)^-1 u of (m, n), its own transpose.

        Args:
            u: any numbers.
            smoothness: squared reach in vertices, at least 0.
        """
        values = self._row_values[:, None] + self._column_values
        return self._back(self._forth(u) / (1.0 + smoothness * values))

    def sharpen(self, h: FloatArray, smoothness: float) -> FloatArray:
        """(I + smoothness L) h, the inverse of `smooth`."""
        values = self._row_values[:, None] + self._column_values
        return self._back(self._forth(h) * (1.0 + smoothness * values))

    def integrate(
        self, slope_x: FloatArray, slope_y: FloatArray, dx: float, dy: float
    ) -> FloatArray:
        """The height field (m, n) of mean 0 whose differences are nearest to slopes.

        Minimizes the sum of (h[i, j + 1] - h[i, j] - dx slope_x)^2 / dx^2 and the same along y.

        Args:
            slope_x: (m, n - 1) between columns.
            slope_y: (m - 1, n) between rows.
            dx, dy: spacing, meters.
        """
        right = np.zeros((len(slope_x), slope_y.shape[1]))
        right[:, 1:] += slope_x / dx
        right[:, :-1] -= slope_x / dx
        right[1:] += slope_y / dy
        right[:-1] -= slope_y / dy
        values = self._row_values[:, None] / (dy * dy) + self._column_values / (dx * dx)
        values[0, 0] = 1.0
        found = self._forth(right) / values
        found[0, 0] = 0.0
        return self._back(found)

    def _forth(self, h: FloatArray) -> FloatArray:
        part = np.einsum("ki,ij->kj", self._rows, h)
        return np.asarray(np.einsum("kj,lj->kl", part, self._columns))

    def _back(self, c: FloatArray) -> FloatArray:
        part = np.einsum("ki,kl->il", self._rows, c)
        return np.asarray(np.einsum("il,lj->ij", part, self._columns))


def _basis(n: int) -> tuple[FloatArray, FloatArray]:
    """Orthonormal rows (n, n), and eigenvalues (n,)."""
    k, i = np.arange(n), np.arange(n)
    rows = cos(math.pi / n * k[:, None] * (i + 0.5)) * math.sqrt(2.0 / n)
    rows[0] = math.sqrt(1.0 / n)
    return np.asarray(rows), np.asarray(2.0 - 2.0 * cos(math.pi / n * k))
