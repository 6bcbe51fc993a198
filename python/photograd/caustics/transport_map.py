"""Optimal transport between two pictures of light: which point of one goes to which of the other.

Of all maps that turn the density a (m, n) into the density b (H, W), the one of least squared
distance is the gradient of a convex function: rays that follow it do not cross, and a lens surface
with the slopes for it exists to first order [Yue2014]. Sinkhorn's iteration finds a blurred plan
[Cuturi2013],

    f_i = -eps log sum_j exp((g_j - |x_i - y_j|^2) / eps + log b_j)       and g_j the same from f

in logarithms, with eps lowered from the squared extent to the squared spacing. On grids with
parallel axes the sum over j is one over columns and one over rows. The image of x_i is the mean of
y_j under the plan. The blur pulls it inwards, by about as much as a plan from a to itself would;
that displacement is taken off.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from photograd_course.portable_math import exp, log

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.errors import RangeError, ShapeError, message
from photograd.types import Array, FloatArray

FLOOR = 1e-4
"""Of the mean density: nowhere is quite dark, or points could not pass between bright parts."""
FALL = 0.6
"""Of eps from one level to the next."""
SWEEPS = 8
"""Iterations a level."""
FINEST = 2.0
"""Square root of the last eps in cells. What it blurs, descent brings back."""
SAFE = 300.0
"""Exponents within it are summed as products of matrices: two of them do not underflow."""


class Axes(NamedTuple):
    """Coordinates of a grid's columns (n,) and rows (m,), meters."""

    x: Array
    y: Array


@typed_call
def transport_map(source: Array, source_axes: Axes, target: Array, target_axes: Axes) -> FloatArray:
    """Where the light of each cell of the source goes: (m, n, 2) meters, x and y.

    Args:
        source: (m, n) power of each cell, at least 0.
        source_axes: of it.
        target: (H, W) power of each cell; scaled to the sum of the source.
        target_axes: of it, in the same frame.

    Raises:
        ShapeError: axes of other lengths.
        RangeError: numbers that are negative or not finite, or a picture without light.
    """
    call = Arguments("transport_map", np.float64)
    a = _density(call, "source", source)
    b = _density(call, "target", target)
    for name, array in (("source", a), ("target", b)):
        if min(array.shape) < 2:
            raise ShapeError(message(call.function, name, "at least 2 x 2 cells", array.shape))
    for name, axes, shape in (("source", source_axes, a.shape), ("target", target_axes, b.shape)):
        call.array(f"{name}_axes.x", axes.x, (shape[1],))
        call.array(f"{name}_axes.y", axes.y, (shape[0],))
    levels = _levels(source_axes, target_axes)
    g = np.zeros_like(b)
    f = np.zeros_like(a)
    log_a, log_b = log(a), log(b)
    for eps in levels:
        for _ in range(SWEEPS):
            f = -eps * _log_sum(g / eps + log_b, target_axes, source_axes, eps)
            g = -eps * _log_sum(f / eps + log_a, source_axes, target_axes, eps)
    eps = levels[-1]
    own = np.zeros_like(a)
    for _ in range(SWEEPS):
        own = 0.5 * (own - eps * _log_sum(own / eps + log_a, source_axes, source_axes, eps))
    there = _means(g / eps + log_b, target_axes, source_axes, eps)
    blurred = _means(own / eps + log_a, source_axes, source_axes, eps)
    x, y = np.meshgrid(source_axes.x, source_axes.y)
    return np.asarray(there + np.stack([x, y], axis=-1) - blurred)


def _density(call: Arguments, name: str, picture: Array) -> FloatArray:
    array = call.array(name, picture, ("H", "W") if name == "target" else ("m", "n"), low=0.0)
    total = float(array.sum())
    if not total > 0:
        raise RangeError(message(call.function, name, "a picture with light", "a black one"))
    share = array / total
    raised: FloatArray = np.maximum(share, FLOOR / share.size)
    return np.asarray(raised / raised.sum())


def _levels(source: Axes, target: Axes) -> list[float]:
    ends = [np.concatenate([source[k], target[k]]) for k in range(2)]
    widest = max(float(e.max() - e.min()) for e in ends)
    finest = FINEST * max(float(np.abs(np.diff(axis)).max()) for axis in (*source, *target))
    levels = [widest * widest]
    while levels[-1] > finest * finest:
        levels.append(max(FALL * levels[-1], finest * finest))
    return levels


def _log_sum(values: FloatArray, start: Axes, end: Axes, eps: float) -> FloatArray:
    """Log of the sum over `start`'s grid of exp(values - distance^2 / eps), on `end`'s grid."""
    rows = _log_sum_rows(values, start.x, end.x, eps)
    return _log_sum_rows(rows.T, start.y, end.y, eps).T


def _log_sum_rows(values: FloatArray, start: FloatArray, end: FloatArray, eps: float) -> FloatArray:
    distance = np.square(end[:, None] - start[None, :]) / eps
    if max(float(distance.max()), float(np.ptp(values))) < SAFE:
        top = values.max(axis=1, keepdims=True)
        return np.asarray(top + log(np.einsum("ri,ji->rj", exp(values - top), exp(-distance))))
    terms = values[:, None, :] - distance
    top = terms.max(axis=2)
    return np.asarray(top + log(exp(terms - top[..., None]).sum(axis=2)))


def _means(values: FloatArray, start: Axes, end: Axes, eps: float) -> FloatArray:
    """(m, n, 2) mean position on `start`'s grid under exp(values - distance^2 / eps)."""
    columns = _log_sum_rows(values, start.x, end.x, eps)  # (rows of start, columns of end)
    rows = _log_sum_rows(values.T, start.y, end.y, eps)  # (columns of start, rows of end)
    y = _mean_rows(columns.T, start.y, end.y, eps).T
    x = _mean_rows(rows.T, start.x, end.x, eps).T
    return np.stack([x.T, y], axis=-1)


def _mean_rows(values: FloatArray, start: FloatArray, end: FloatArray, eps: float) -> FloatArray:
    terms = values[:, None, :] - np.square(end[:, None] - start[None, :]) / eps
    weights = exp(terms - terms.max(axis=2)[..., None])
    return np.asarray((weights * start).sum(axis=2) / weights.sum(axis=2))
