"""Density control as sampling: a fixed number of Gaussians wander to where they are needed.

Gaussians are seen as samples of the scene. Faint ones are moved onto others, drawn with a
probability proportional to opacity; while there is room, a few more are added the same way; and a
small random motion keeps the faint ones looking for a better place [Kheradmand2024].

n Gaussians at one place must look like the one of opacity o that was there. Along a ray through the
center n of opacity a compose to 1 - (1 - a)^n, so

    a = 1 - (1 - o)^(1/n)

and so that the total over the picture stays, too, scales shrink by

    s = o / sum_{j=1..n} C(n, j) (-1)^(j - 1) a^j / sqrt(j)

since 1 - (1 - a g)^n = sum_j C(n, j) (-1)^(j - 1) a^j g^j, and g = exp(-x^2 / 2) to the power j
covers 1 / sqrt(j) of what g covers, along one axis. (The paper has the sum over i of C(i - 1, k);
adding those up gives C(n, k + 1).)
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import comb

import numpy as np
from numpy.typing import NDArray
from photograd_course.portable_math import exp, expm1, log, log1p, sigmoid
from photograd_course.random import normal_vectors, uniform
from photograd_course.row_map import RowMap

from photograd.splats.density import (
    Change,
    DensityControl,
    Grad2dStatistics,
    Params,
    Schedule,
    logits,
    opacities,
    rotation_matrices,
)
from photograd.types import Array

MAX_COPIES = 51
"""At so many copies of a Gaussian the formula ends, as in the authors' code."""

FAINT_ENOUGH = 0.06
"""Opacity above which the random motion is below e^-5 of its size: those stay where they are."""


@dataclass(frozen=True)
class MarkovChain(DensityControl):
    """Density control by moving faint Gaussians and by random motion [Kheradmand2024].

    Attributes:
        budget: there are never more Gaussians.
        seed: of what is drawn and of the random motion.
        schedule: of moving and adding.
        growth: the number grows by this factor at most, each time.
        faint: opacity at or below which a Gaussian is moved.
        opacity_weight, scale_weight: of the means of opacity and of scale (in extents), added to
            the loss: what is not needed fades and shrinks.
        noise: size of the random motion, in units of the means' rate.
    """

    budget: int
    seed: int = 0
    schedule: Schedule = field(default_factory=Schedule)
    growth: float = 1.05
    faint: float = 0.005
    opacity_weight: float = 0.01
    scale_weight: float = 0.01
    noise: float = 5e5

    def change(
        self, params: Params, grad2d: Grad2dStatistics, *, extent: float, step: int
    ) -> Change | None:
        """Faint rows become copies in place, new ones stand at the end; all copies are fresh.

        Args:
            params: of the Gaussians, by group.
            grad2d: not used.
            extent: of the scene, in meters.
            step: of the fit.
        """
        del grad2d, extent
        if not self.schedule.due(step):
            return None
        alpha = opacities(params)
        dead = np.flatnonzero(alpha <= self.faint)
        count = len(alpha)
        more = max(0, min(self.budget, int(self.growth * count)) - count)
        targets = np.concatenate([dead, np.arange(count, count + more)])
        weight = np.where(alpha > self.faint, alpha, 0.0)
        if not len(targets) or not weight.any():
            return None
        chosen = _drawn(weight, len(targets), self.seed, step)
        return _copied(params, chosen, targets)

    def add_priors(self, params: Params, gradients: dict[str, Array], *, extent: float) -> None:
        """Add w a (1 - a) / N to d_logit and w s / (3 N extent) to d_log_scale.

        Args:
            params: of the Gaussians, by group.
            gradients: of the loss, changed in place.
            extent: of the scene, in meters.
        """
        alpha = opacities(params)
        scales = exp(params["log_scales"].astype(np.float64)) / extent
        d_logits = self.opacity_weight * alpha * (1 - alpha) / len(alpha)
        d_scales = self.scale_weight * scales / scales.size
        gradients["opacity_logits"] += d_logits.astype(gradients["opacity_logits"].dtype)
        gradients["log_scales"] += d_scales.astype(gradients["log_scales"].dtype)

    def explore(self, params: Params, *, extent: float, rate: float, step: int) -> None:
        """Add noise rate cov3d n sigmoid(100 (0.005 - a)) / extent^2 to each mean, n normal.

        Divided by the extent squared, the motion is the same in meters and in feet.

        Args:
            params: of the Gaussians, by group; the means are changed in place.
            extent: of the scene, in meters.
            rate: learning rate of the means, in m.
            step: of the fit, for random numbers.
        """
        alpha = opacities(params)
        rows = np.flatnonzero(alpha < FAINT_ENOUGH)
        if not len(rows):
            return
        unit = normal_vectors(self.seed, step=step, row=rows, sample=4)
        gate = sigmoid(100 * (self.faint - alpha[rows]))
        turn = rotation_matrices(params["quats"][rows])
        square = exp(2 * params["log_scales"][rows].astype(np.float64)) / (extent * extent)
        local = square * np.einsum("nji,nj->ni", turn, unit * gate[:, None])
        moved = self.noise * rate * np.einsum("nij,nj->ni", turn, local)
        params["means"][rows] += moved.astype(params["means"].dtype)


def _drawn(weight: Array, count: int, seed: int, step: int) -> NDArray[np.int64]:
    """`count` rows with probability proportional to weight, with replacement."""
    edges = np.cumsum(weight)
    u = uniform(seed, step=step, pixel=np.arange(count), sample=5) * edges[-1]
    found = np.searchsorted(edges, u, side="right")
    rows: NDArray[np.int64] = np.minimum(found, int(np.flatnonzero(weight)[-1])).astype(np.int64)
    return rows


def _copied(params: Params, chosen: NDArray[np.int64], targets: NDArray[np.int64]) -> Change:
    """Row chosen[i] is written to targets[i], and shares its opacity with its copies."""
    count = len(params["means"])
    copies = np.bincount(chosen, minlength=count) + 1
    sources = np.flatnonzero(copies > 1)
    n = np.minimum(copies[sources], MAX_COPIES)
    total = opacities(params)[sources]
    share = -expm1(log1p(-total) / n)
    shrink = log(total / _coverage(share, n))
    size = max(count, int(targets.max()) + 1)
    rows = np.arange(size, dtype=np.int64)
    rows[targets] = chosen
    changed = {name: array.copy() for name, array in params.items()}
    dtype = params["means"].dtype
    changed["opacity_logits"][sources] = logits(share).astype(dtype)
    changed["log_scales"][sources] += shrink[:, None].astype(dtype)
    after = {name: array[rows] for name, array in changed.items()}
    origin = np.arange(size, dtype=np.int64)
    origin[targets] = -1
    origin[sources] = -1
    return Change(after, RowMap(origin, source_count=count))


def _coverage(share: Array, n: Array) -> Array:
    """sum_j C(n, j) (-1)^(j - 1) share^j / sqrt(j) for each row, in the order of j."""
    total, signed = np.zeros(len(share)), -np.ones(len(share))
    for j in range(1, int(n.max(initial=1)) + 1):
        term = np.array([comb(int(k), j) for k in range(int(n.max(initial=1)) + 1)], np.float64)
        signed *= -share
        total += signed * term[n] / np.sqrt(j)
    return total
