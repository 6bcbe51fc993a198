"""Large steps in the shape of a mesh: vertices parameterized so that descent stays smooth.

Vertices x (V, 3) are the solution of [Nicolet2021, Sect. 3]

    (I + lambda L) x = u        (L x)_i = sum over the neighbors j of i of x_i - x_j

and descent changes u. L is symmetric, so that the adjoint dL/du = (I + lambda L)^-1 dL/dx is the
same solve: a gradient at one vertex moves its surroundings along. I + lambda L is positive
definite, and conjugate gradients solve it with sums in one order [Hestenes1952].
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd.errors import Error, message
from photograd.types import Array, FloatArray

TOLERANCE = 1e-13
"""Of the residual, relative to the right side."""
MAX_ITERATIONS = 10_000


class LargeSteps:
    """The matrix I + lambda L of a mesh, with the uniform Laplacian L of its edges."""

    def __init__(self, ends: Array, count: int, smoothness: float) -> None:
        """Prepare products and solves.

        Args:
            ends: (E, 2) vertex numbers of each edge, each edge once, as `MeshEdges.ends`.
            count: V, the number of vertices.
            smoothness: lambda, a number of at least 0; 0 makes x = u.

        Raises:
            DtypeError, ShapeError, RangeError: arrays or numbers that are no such thing.
        """
        call = Arguments("LargeSteps", np.float64)
        self.count = call.integer("count", count, low=1)
        self.smoothness = call.number("smoothness", smoothness, low=0)
        ends = call.array("ends", ends, ("E", 2), dtype=np.int64, low=0, high=count - 1)
        self._vertex: npt.NDArray[np.int64] = np.concatenate([ends[:, 0], ends[:, 1]])
        self._neighbor: npt.NDArray[np.int64] = np.concatenate([ends[:, 1], ends[:, 0]])
        degree = np.bincount(self._vertex, minlength=count).astype(np.float64)
        self._diagonal = 1.0 + self.smoothness * degree

    def times(self, x: Array) -> FloatArray:
        """(I + lambda L) x, float64.

        Args:
            x: (V, K).

        Raises:
            DtypeError, ShapeError, RangeError: not finite numbers of that shape.
        """
        x = Arguments("LargeSteps.times", np.float64).array("x", x, (self.count, "K"))
        return self._times(x)

    def solve(self, u: Array) -> FloatArray:
        """(I + lambda L)^-1 u, float64; also its adjoint, as the matrix is symmetric.

        Args:
            u: (V, K).

        Raises:
            DtypeError, ShapeError, RangeError: not finite numbers of that shape.
            Error: no convergence, of numbers close to the ends of float64's range.
        """
        u = Arguments("LargeSteps.solve", np.float64).array("u", u, (self.count, "K"))
        x = u / self._diagonal[:, None]
        residual = u - self._times(x)
        limit = TOLERANCE * TOLERANCE * np.square(u).sum(axis=0)
        direction = np.zeros_like(u)
        rho_before = np.ones(u.shape[1])
        for _ in range(MAX_ITERATIONS):
            if (np.square(residual).sum(axis=0) <= limit).all():
                return x
            conditioned = residual / self._diagonal[:, None]  # by Jacobi
            rho = (residual * conditioned).sum(axis=0)
            direction = conditioned + _ratio(rho, rho_before) * direction
            product = self._times(direction)
            step = _ratio(rho, (direction * product).sum(axis=0))
            x = x + step * direction
            residual = residual - step * product
            rho_before = rho
        got = f"none after {MAX_ITERATIONS} iterations"
        raise Error(message("LargeSteps.solve", "u", "a system that converges", got))

    def _times(self, x: FloatArray) -> FloatArray:
        rows = x[self._neighbor]
        around = [
            np.bincount(self._vertex, weights=column, minlength=self.count) for column in rows.T
        ]
        found: FloatArray = self._diagonal[:, None] * x - self.smoothness * np.stack(around, -1)
        return found


def _ratio(above: FloatArray, below: FloatArray) -> FloatArray:
    """Quotients; 0 where a column is solved and both are 0."""
    found: FloatArray = np.where(below > 0, above / np.where(below > 0, below, 1.0), 0.0)
    return found
