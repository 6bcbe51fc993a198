"""The visible samples of rays and their weights: what marches with networks have in common.

A march through networks does not run in one kernel: samples are placed, densities are evaluated,
then the samples that matter are decoded. The core's stages, and their adjoints, are in
cpp/photograd/render/march/sample_rows.h.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from photograd_course.portable_math import sigmoid, softplus

from photograd._compiled import _core
from photograd.fields.active_voxels import ActiveVoxels
from photograd.fields.march import MarchPolicy
from photograd.types import Array


@dataclass(frozen=True)
class WeightedSamples:
    """The samples of rays in cells with an active voxel that the march does not stop before."""

    offset: NDArray[np.int64]  # (R + 1,)
    t: Array  # (M,)
    points: Array  # (M, 3) in voxels
    raw: Array  # (M,) density
    weights: tuple[Array, Array, Array]  # weight (M,), behind (M,), transmittance (R,)
    kept: NDArray[np.bool_] | None = None  # which of those before the stop; None for all

    @classmethod
    def of_rays(
        cls,
        policy: MarchPolicy,
        active: ActiveVoxels,
        rays: tuple[Array, Array, Array, Array],
        stop: float,
        density: Callable[[Array], Array],
    ) -> Self:
        """Place the samples and weigh them.

        Args:
            policy: with the step and the density scale.
            active: which voxels there are.
            rays: of `checked_rays`.
            stop: transmittance below which a ray ends.
            density: raw density (M,) at points (M, 3) in voxels.
        """
        offset, t, points = _core.visible_samples(active.table, policy.settings(stop), rays)
        raw = density(points)
        weights = _weights(policy, offset, raw)
        if stop <= 0:
            return cls(offset, t, points, raw, weights)
        kept = weights[0] + weights[1] > stop  # transmittance in front, up to rounding
        offset = np.concatenate([[0], np.cumsum(kept)])[offset]
        t, points, raw = t[kept], points[kept], raw[kept]
        return cls(offset, t, points, raw, _weights(policy, offset, raw), kept)

    @property
    def ray(self) -> NDArray[np.int64]:
        """(M,) the ray of each sample."""
        return np.repeat(np.arange(len(self.offset) - 1), np.diff(self.offset))

    def d_density(self, policy: MarchPolicy, d_weight: Array, d_left: Array) -> Array:
        """Derivatives of a loss with respect to raw density (M,).

        Args:
            policy: as in `of_rays`.
            d_weight: (M,), with respect to the weights.
            d_left: (R,), with respect to the transmittance of each ray.
        """
        weight, behind, _ = self.weights
        d_sigma_t = _core.sample_weights_backward(
            self.offset, (weight, behind), policy.dt, (d_weight, d_left)
        )
        slope: Array = policy.density_scale * sigmoid(self.raw) * d_sigma_t
        return slope.astype(self.raw.dtype)

    def d_rays(self, box: Any, shape: tuple[int, int, int], d_points: Array) -> tuple[Array, Array]:
        """Derivatives of a loss with respect to origins and directions (R, 3), through the points.

        Args:
            box: (2, 3) in meters.
            shape: voxels along its edges.
            d_points: (M, 3), with respect to the points in voxels.
        """
        lower, upper = np.array(box)
        d_position = d_points * (np.array(shape) / (upper - lower)).astype(d_points.dtype)
        origins = _core.blend_samples(self.offset, np.ones_like(self.t), d_position)
        return origins, _core.blend_samples(self.offset, self.t, d_position)


def _weights(policy: MarchPolicy, offset: Any, raw: Array) -> tuple[Array, Array, Array]:
    sigma_t = (policy.density_scale * softplus(raw)).astype(raw.dtype)
    weight, behind, left = _core.sample_weights(offset, sigma_t, policy.dt)
    return weight, behind, left
