"""A lens that sends light about where a picture wants it: transport, Snell's law, Poisson.

Optimal transport says to which point q of the receiver the light at a point p of the lens's back
goes. A ray that arrives there inside the glass along d has to leave along w = (q - p) / |q - p|. By
Snell's law the components of eta d and w along the surface agree [Schwartzburg2014, Sec. 5],

    normal ~ eta d - w            h_x = -normal . x / normal . axis        h_y likewise

and the heights are those whose differences are nearest to these slopes: a Poisson equation. Since p
moves with the heights, this is done a few times.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.caustics.intersections import unit
from photograd.caustics.lens import Lens
from photograd.caustics.light import Light, cell_power, light_at
from photograd.caustics.scattering import scatter
from photograd.caustics.smoothing import CosineBasis
from photograd.caustics.transport_map import Axes, transport_map
from photograd.errors import RangeError, ShapeError, message
from photograd.transport.particles import IrradianceSensor
from photograd.types import Array, FloatArray

ROUNDS = 4
"""Times that the heights are computed; they change by less than a percent after the second."""
GRID = 64
"""Cells along an edge for which transport is computed, at most."""


@typed_call
def transport_lens(lens: Lens, light: Light, receiver: IrradianceSensor, target: Array) -> Lens:
    """The lens with heights that form the picture, to first order.

    Args:
        lens: its heights are replaced.
        light: a directional or a point light.
        receiver: where the picture is formed, with edges parallel to the lens's.
        target: (H, W) light on the receiver's cells, in any unit.

    Raises:
        ShapeError: a target of another shape than the receiver, or a lens of fewer heights than 3
            each way.
        RangeError: negative or not finite numbers, a target without light, edges that are not
            parallel, or heights that come down to the front.
    """
    call = Arguments("transport_lens", np.float64)
    target = call.array("target", target, (receiver.height, receiver.width), low=0.0)
    _require_parallel(call, lens, receiver)
    m, n = lens.heights.shape
    if min(m, n) < 3:
        expected, remedy = "at least 3 heights each way", "take more, or start from a plane"
        raise ShapeError(message("transport_lens", "lens", expected, (m, n), remedy))
    axes = (_unit(receiver.edge_x), _unit(receiver.edge_y))
    counts = (min(GRID, n - 1), min(GRID, m - 1))
    source_axes, source = _source(lens, light, counts, axes)
    small, small_axes = _shrunk(target, receiver, axes)
    there = transport_map(source, source_axes, small, small_axes)
    columns = (np.arange(n) / (n - 1)) * counts[0] - 0.5
    rows = (np.arange(m) / (m - 1)) * counts[1] - 0.5
    wanted = _resampled(there, rows, columns)
    normal = np.cross(*axes)
    level = float((receiver.corner * normal).sum())
    goal = wanted[..., :1] * axes[0] + wanted[..., 1:] * axes[1] + level * normal
    basis = CosineBasis(m, n)
    found = replace(lens, heights=np.zeros((m, n)))
    for _ in range(ROUNDS):
        slope_x, slope_y = _slopes(found, light, goal)
        along_x = 0.5 * (slope_x[:, 1:] + slope_x[:, :-1])
        along_y = 0.5 * (slope_y[1:] + slope_y[:-1])
        found = replace(lens, heights=basis.integrate(along_x, along_y, *lens.spacing))
    return found


def _require_parallel(call: Arguments, lens: Lens, receiver: IrradianceSensor) -> None:
    cosine = abs(float((_unit(lens.edge_x) * _unit(receiver.edge_x)).sum()))
    facing = float((np.cross(receiver.edge_x, receiver.edge_y) * lens.frame[2]).sum())
    if cosine < 1 - 1e-6 or not facing < 0:
        expected = "edges parallel to the lens's, and its front towards the lens"
        remedy = "start from a plane, or turn the receiver"
        got = f"edge_x {receiver.edge_x}"
        raise RangeError(message(call.function, "receiver", expected, got, remedy))


def _unit(vector: FloatArray) -> FloatArray:
    return np.asarray(vector / np.sqrt(np.square(vector).sum()))


def _source(
    lens: Lens, light: Light, counts: tuple[int, int], axes: tuple[FloatArray, FloatArray]
) -> tuple[Axes, FloatArray]:
    """Power of the lens's cells, at coordinates along the receiver's edges."""
    columns, rows = counts
    x, y = (np.arange(columns) + 0.5) / columns, (np.arange(rows) + 0.5) / rows
    start = [float((lens.corner * axis).sum()) for axis in axes]
    across = float((lens.edge_x * axes[0]).sum())
    up = float((lens.edge_y * axes[1]).sum())
    power = cell_power(lens, light, counts)
    return Axes(start[0] + x * across, start[1] + y * up), power


def _shrunk(
    target: FloatArray, receiver: IrradianceSensor, axes: tuple[FloatArray, FloatArray]
) -> tuple[FloatArray, Axes]:
    """The target with at most `GRID` cells along an edge, and where these are."""
    parts = []
    for length, edge, axis in (
        (receiver.height, receiver.edge_y, axes[1]),
        (receiver.width, receiver.edge_x, axes[0]),
    ):
        cells = min(GRID, length)
        # The share of each fine cell in each coarse one.
        ends = np.arange(cells + 1) * (length / cells)
        fine = np.arange(length)
        low = np.maximum(ends[:-1, None], fine)
        shares = np.maximum(np.minimum(ends[1:, None], fine + 1) - low, 0.0)
        start, reach = float((receiver.corner * axis).sum()), float((edge * axis).sum())
        parts.append((shares, start + (np.arange(cells) + 0.5) / cells * reach))
    (rows, y), (columns, x) = parts
    small = np.einsum("ai,ij->aj", rows, target)
    small = np.einsum("aj,bj->ab", small, columns)
    return small, Axes(x, y[::-1].copy())  # row 0 is on top


def _resampled(values: FloatArray, rows: FloatArray, columns: FloatArray) -> FloatArray:
    """(m, n, 2) bilinear at fractional rows and columns, going on straight beyond the border."""
    out = values
    for axis, at in ((0, rows), (1, columns)):
        last = out.shape[axis] - 2
        low = np.clip(np.floor(at), 0, last).astype(np.int64)
        shape = [1, 1, 1]
        shape[axis] = len(at)
        part = (at - low).reshape(shape)
        out = (1.0 - part) * np.take(out, low, axis) + part * np.take(out, low + 1, axis)
    return out


def _slopes(lens: Lens, light: Light, goal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Slopes (m, n) at the vertices of the back that send light from there to goals (m, n, 3)."""
    frame, shape = lens.frame, lens.heights.shape
    back = lens.back().reshape(-1, 3)
    depth = (lens.thickness + lens.heights).reshape(-1, 1)
    normal = np.broadcast_to(-frame[2], back.shape)
    entry = back - depth * frame[2]
    no, one = np.zeros(len(back), bool), np.ones(len(back))
    for _ in range(2):  # the front's point below moves with the direction there
        arriving, _ = light_at(light, entry)
        inside = scatter(arriving, normal, lens.eta, no, one).direction
        along = np.einsum("rk,k->r", inside, frame[2])[:, None]
        entry = back - depth * inside / along
    leaving = unit(goal.reshape(-1, 3) - back)
    wanted = lens.eta * inside - leaving
    axial = np.einsum("rk,k->r", wanted, frame[2])
    slope_x = -np.einsum("rk,k->r", wanted, frame[0]) / axial
    slope_y = -np.einsum("rk,k->r", wanted, frame[1]) / axial
    return slope_x.reshape(shape), slope_y.reshape(shape)
