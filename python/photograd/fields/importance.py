"""Importance sampling along a ray, from coarse to fine [Mildenhall2020, Sec. 5.2].

    w_k = T_k (1 - exp(-sigma_k d))         of K coarse bins of width d
    p_k = (w_k + e) / sum_j (w_j + e)       piecewise-constant pdf; e keeps empty bins, and rays
    t   = CDF^-1(u)                         without any weight, from zeros

One network stands for both levels, as in [Barron2021]: its densities at the middle of the bins give
the pdf. The inverse CDF of N + 1 stratified numbers, 0 and 1 among them, gives the ends of N fine
intervals, which cover the ray without a gap; the samples are in their middle.

The weights are held constant: no derivative is taken with respect to the positions of samples.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from photograd_course.portable_math import exp

from photograd.types import Array

BINS = 64
"""Coarse bins of a ray."""
EPSILON = 5e-3
"""Added to the weight of each bin: of an opaque ray, a quarter of the samples is spread evenly."""


def weights_of(sigma_t: Array, width: Array) -> Array:
    """Weights (R, K) of the bins of each ray; their sum is its opacity.

    Args:
        sigma_t: (R, K) extinction in 1/m.
        width: (R, 1) or (R, K) of a bin, in meters.
    """
    tau = np.cumsum(sigma_t * width, axis=1, dtype=np.float64)
    through = exp(-np.concatenate([np.zeros((len(tau), 1)), tau], axis=1))
    weights: Array = through[:, :-1] - through[:, 1:]
    return weights


def cdf_of(weights: Array) -> Array:
    """(R, K + 1) the CDF at the ends of K bins of equal width: from 0 to 1, strictly increasing.

    Args:
        weights: (R, K) at least 0; a row of zeros gives the uniform distribution.
    """
    mass = np.cumsum(weights + EPSILON, axis=1, dtype=np.float64)
    mass /= mass[:, -1:]  # the last is exactly 1
    return np.concatenate([np.zeros((len(mass), 1)), mass], axis=1)


def inverse_cdf(cdf: Array, u: Array) -> Array:
    """(R, M) positions in [0, 1] along each ray whose CDF has the value u.

    Args:
        cdf: (R, K + 1) as `cdf_of` gives it.
        u: (R, M) in [0, 1].
    """
    count, bins = len(cdf), cdf.shape[1] - 1
    row = np.arange(count)[:, None]
    found = np.searchsorted((cdf + row).ravel(), (u + row).ravel(), side="right")
    # The sums round: at most to the bin beside, whose end u then lies on.
    index = np.clip(found.reshape(u.shape) - 1 - row * (bins + 1), 0, bins - 1)
    low, high = np.take_along_axis(cdf, index, 1), np.take_along_axis(cdf, index + 1, 1)
    share = np.clip((u - low) / (high - low), 0, 1)
    positions: Array = (index + share) / bins
    return positions


def stratified(rays: int, count: int, shift: Array | None) -> Array:
    """(R, N + 1) rising numbers: 0, one in each of the N - 1 strata between, 1.

    Args:
        rays: R.
        count: N.
        shift: (R,) in [0, 1), where in the strata; None for their middle.
    """
    within = np.full((rays, 1), 0.5) if shift is None else np.asarray(shift, np.float64)[:, None]
    inner = (np.arange(count - 1) + within) / max(count - 1, 1)
    ends = np.zeros((rays, 1)), np.ones((rays, 1))
    return np.concatenate([ends[0], inner, ends[1]], axis=1)


def fine_samples(
    density: Callable[[Array], Array], near: Array, length: Array, count: int, shift: Array | None
) -> tuple[Array, Array]:
    """Distance (R, N) of the fine samples along each ray, and the width (R, N) of their intervals.

    Args:
        density: distances (R, `BINS`) along the rays -> extinction (R, `BINS`) in 1/m.
        near: (R,) distance in meters at which a ray begins.
        length: (R,) meters along which it is sampled, at least 0.
        count: N.
        shift: as in `stratified`.
    """
    near, length = np.asarray(near, np.float64)[:, None], np.asarray(length, np.float64)[:, None]
    middles = near + (np.arange(BINS) + 0.5) / BINS * length
    cdf = cdf_of(weights_of(density(middles), length / BINS))
    ends = near + length * inverse_cdf(cdf, stratified(len(near), count, shift))
    return 0.5 * (ends[:, :-1] + ends[:, 1:]), np.maximum(np.diff(ends, axis=1), 0.0)
