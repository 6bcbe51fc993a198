"""Light on a rectangle of cells: each ray is spread over four cells, and its landing point moves.

A ray from p along d lands on the receiver's plane (corner C, normal N) at

    q = p + s d,  s = N . (C - p) / (N . d)          x = W u - 1/2, y = H v - 1/2

and gives its power to the four cells around (x, y) by bilinear weights: the irradiance is
continuous in where rays land, and so is its derivative almost everywhere. What lands farther than
half a cell outside is lost.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from photograd.caustics.intersections import dot
from photograd.transport.particles import IrradianceSensor
from photograd.types import Array, FloatArray


class Landing(NamedTuple):
    """Where rays land, in cells."""

    x: Array  # (R,) 0 at the center of the first column
    y: Array  # (R,) 0 at the center of the top row
    good: Array  # (R,) whether a ray comes through the front


def land(receiver: IrradianceSensor, origin: FloatArray, direction: FloatArray) -> Landing:
    """Landing points of rays (R, 3).

    Args:
        receiver: whose front counts.
        origin, direction: of the rays, meters.
    """
    scaled_x, scaled_y, normal = _axes(receiver)
    along = np.einsum("rk,k->r", direction, normal)
    reach = np.einsum("rk,k->r", receiver.corner - origin, normal)
    good = (along < 0) & (reach < 0)
    s = np.where(good, reach / np.where(good, along, -1.0), 0.0)
    q = origin + s[:, None] * direction - receiver.corner
    x = receiver.width * np.einsum("rk,k->r", q, scaled_x) - 0.5
    y = receiver.height * (1.0 - np.einsum("rk,k->r", q, scaled_y)) - 0.5
    return Landing(x, y, good)


def land_backward(
    receiver: IrradianceSensor,
    origin: FloatArray,
    direction: FloatArray,
    d_x: FloatArray,
    d_y: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """dL/dorigin and dL/ddirection of dL/dx and dL/dy, 0 where a ray does not land.

    Args:
        receiver, origin, direction: as for `land`.
        d_x, d_y: (R,).
    """
    scaled_x, scaled_y, normal = _axes(receiver)
    along = np.einsum("rk,k->r", direction, normal)
    reach = np.einsum("rk,k->r", receiver.corner - origin, normal)
    good = (along < 0) & (reach < 0)
    along = np.where(good, along, -1.0)
    s = np.where(good, reach / along, 0.0)
    d_q = np.where(good, receiver.width * d_x, 0.0)[:, None] * scaled_x
    d_q = d_q - np.where(good, receiver.height * d_y, 0.0)[:, None] * scaled_y
    d_s = (dot(d_q, direction) / along)[:, None] * normal
    return d_q - d_s, s[:, None] * (d_q - d_s)


def splat(receiver: IrradianceSensor, landing: Landing, power: FloatArray) -> FloatArray:
    """(H, W) power on each cell, in the unit of `power` (R,).

    Args:
        receiver: with H rows and W columns.
        landing: of `land`.
        power: of each ray.
    """
    total = np.zeros((receiver.height, receiver.width))
    cells, weights, _ = _shares(receiver, landing)
    for k in range(4):
        values = weights[k] * power
        total += np.bincount(cells[k], values, total.size + 1)[:-1].reshape(total.shape)
    return total


def splat_backward(
    receiver: IrradianceSensor, landing: Landing, power: FloatArray, d_total: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """dL/dx, dL/dy and dL/dpower of dL/dtotal (H, W).

    Args:
        receiver, landing, power: as for `splat`.
        d_total: (H, W).
    """
    cells, weights, (d_w_x, d_w_y) = _shares(receiver, landing)
    values = np.append(d_total.reshape(-1), 0.0)
    d_x, d_y, d_power = (np.zeros(len(power)) for _ in range(3))
    for k in range(4):
        value = values[cells[k]]
        d_power += weights[k] * value
        d_x += d_w_x[k] * value * power
        d_y += d_w_y[k] * value * power
    return d_x, d_y, d_power


def outside(receiver: IrradianceSensor, landing: Landing, power: FloatArray) -> float:
    """Power times the squared distance to the outermost cell centers, in cells, summed up.

    Args:
        receiver, landing, power: as for `splat`. What does not land counts as 0.
    """
    x, y = _overshoot(receiver, landing)
    return float((power * (x * x + y * y)).sum())


def outside_backward(
    receiver: IrradianceSensor, landing: Landing, power: FloatArray, d_out: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """dL/dx, dL/dy and dL/dpower of `outside`.

    Args:
        receiver, landing, power: as for `outside`.
        d_out: dL/d of what it returned.
    """
    x, y = _overshoot(receiver, landing)
    return 2.0 * d_out * power * x, 2.0 * d_out * power * y, d_out * (x * x + y * y)


def _overshoot(receiver: IrradianceSensor, landing: Landing) -> tuple[FloatArray, FloatArray]:
    over = []
    for at, count in ((landing.x, receiver.width), (landing.y, receiver.height)):
        beyond = np.maximum(at - (count - 1), 0.0) + np.minimum(at, 0.0)
        over.append(np.where(landing.good, beyond, 0.0))
    return over[0], over[1]


def _axes(receiver: IrradianceSensor) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Edges over their squared lengths, and the front's normal, not unit."""
    x, y = receiver.edge_x, receiver.edge_y
    return x / np.square(x).sum(), y / np.square(y).sum(), np.cross(x, y)


def _shares(
    receiver: IrradianceSensor, landing: Landing
) -> tuple[list[Array], list[FloatArray], tuple[list[FloatArray], list[FloatArray]]]:
    """Four cells of each ray, their weights, and derivatives of these by x and y.

    Cells outside have the number H W.
    """
    H, W = receiver.height, receiver.width
    x, y = np.clip(landing.x, -2.0, W + 1.0), np.clip(landing.y, -2.0, H + 1.0)
    left, top = np.floor(x), np.floor(y)
    a, b = x - left, y - top
    column, row = left.astype(np.int64), top.astype(np.int64)
    cells, weights, d_x, d_y = [], [], [], []
    for k in range(4):
        i, j = row + (k >> 1), column + (k & 1)
        inside = landing.good & (i >= 0) & (i < H) & (j >= 0) & (j < W)
        cells.append(np.where(inside, i * W + j, H * W))
        w_x, s_x = (a, 1.0) if k & 1 else (1.0 - a, -1.0)
        w_y, s_y = (b, 1.0) if k >> 1 else (1.0 - b, -1.0)
        weights.append(w_x * w_y)
        d_x.append(s_x * w_y)
        d_y.append(s_y * w_x)
    return cells, weights, (d_x, d_y)
