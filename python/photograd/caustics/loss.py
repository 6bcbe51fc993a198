"""How far irradiance is from a picture, near and far: squares on a pyramid of pictures.

r is the difference over the mean of the target, D_l the blur by (1, 3, 3, 1) / 8 along both axes
with every second sample kept, l times, clamped at the border:

    loss = sum over levels of mean((D_l r)^2)          dL/dr = sum over levels 2 D_l^T D_l r / N_l

The finest level sees details; the coarse ones see light that is far from where it is wanted, which
finer ones have no derivative for.
"""

from __future__ import annotations

import numpy as np

from photograd.types import FloatArray

COARSEST = 4
"""Cells along the shorter edge of the coarsest level, at least."""


class PyramidLoss:
    """The loss of power on cells against a target of the same sum."""

    def __init__(self, target: FloatArray) -> None:
        """Make the matrices.

        Args:
            target: (H, W) power of each cell.
        """
        self.target = target
        self._scale = 1.0 / float(target.mean())
        rows, columns = np.eye(target.shape[0]), np.eye(target.shape[1])
        self._levels = [(rows, columns)]
        while min(len(rows), len(columns)) >= 2 * COARSEST:
            rows, columns = (np.einsum("ij,jk->ik", _halved(len(a)), a) for a in (rows, columns))
            self._levels.append((rows, columns))

    def loss(self, power: FloatArray) -> float:
        """Of the power (H, W) on the cells; 0 where it is the target."""
        return sum(float(np.square(r).mean()) for r in self._residuals(power))

    def loss_backward(self, power: FloatArray) -> FloatArray:
        """dL/dpower (H, W).

        Args:
            power: as for `loss`.
        """
        total = np.zeros_like(power)
        residuals = self._residuals(power)
        for (rows, columns), r in zip(self._levels, residuals, strict=True):
            part = r if len(rows) == len(power) else np.einsum("ai,ab->ib", rows, r)
            part = part if len(rows) == len(power) else np.einsum("ib,bj->ij", part, columns)
            total += part * (2.0 * self._scale / r.size)
        return total

    def _residuals(self, power: FloatArray) -> list[FloatArray]:
        finest = (power - self.target) * self._scale
        found = [finest]
        for rows, columns in self._levels[1:]:
            part = np.einsum("ai,ij->aj", rows, finest)
            found.append(np.einsum("aj,bj->ab", part, columns))
        return found


def _halved(n: int) -> FloatArray:
    """((n + 1) // 2, n) the blur by (1, 3, 3, 1) / 8 of every second sample."""
    out = np.zeros(((n + 1) // 2, n))
    for i in range(len(out)):
        for k, weight in ((-1, 1), (0, 3), (1, 3), (2, 1)):
            out[i, min(max(2 * i + k, 0), n - 1)] += weight / 8
    return out
