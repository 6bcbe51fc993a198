"""Rays from a light through the front of a lens, and the power that each carries.

A ray through the point p of the front stands for an area dA there. With the angle theta between ray
and axis it carries

    directional light    E cos(theta) dA
    point light          I cos(theta) dA / |p - light|^2

in watts; of the three channels of a light the mean counts. A ray begins a little in front of the
lens, so that it passes the front like any other surface.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from photograd_course.random import uniform

from photograd.caustics.lens import Lens
from photograd.errors import DtypeError, RangeError, message
from photograd.lights import DirectionalLight, PointLight
from photograd.types import Array, FloatArray

STAND_OFF = 0.01
"""Of the lens's thickness: where rays begin in front of it."""
Light = DirectionalLight | PointLight


class Rays(NamedTuple):
    """Light on its way to a lens."""

    origin: Array  # (R, 3) meters
    direction: Array  # (R, 3) unit
    power: Array  # (R,) watts


def check_light(function: str, light: Light, lens: Lens) -> None:
    """Refuse lights that do not light the front of a lens.

    Args:
        function: that was called, for errors.
        light: to be checked.
        lens: whose front it is.

    Raises:
        DtypeError: neither a directional nor a point light.
        RangeError: one behind the front, or without power.
    """
    if not isinstance(light, DirectionalLight | PointLight):
        expected, got = "a DirectionalLight or a PointLight", type(light).__name__
        raise DtypeError(message(function, "light", expected, got))
    corners = lens.plane()[[0, 0, -1, -1], [0, -1, 0, -1]]
    directions, flux = light_at(light, corners)
    if not (np.einsum("rk,k->r", directions, lens.frame[2]) > 0).all():
        remedy = "light goes along edge_x x edge_y of the lens"
        got = "one that misses it"
        raise RangeError(message(function, "light", "one before the lens's front", got, remedy))
    if not (np.isfinite(flux).all() and flux.min() > 0):
        raise RangeError(message(function, "light", "one with power", "a dark one"))


def light_at(light: Light, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Unit directions (R, 3) of light at points (R, 3), and W/m^2 (R,) across them."""
    if isinstance(light, DirectionalLight):
        to = np.asarray(light.direction, np.float64)
        way = -to / np.sqrt(np.square(to).sum())
        strength = float(np.asarray(light.irradiance, np.float64).mean())
        return np.broadcast_to(way, points.shape), np.full(len(points), strength)
    arm = points - np.asarray(light.position, np.float64)
    square = np.square(arm).sum(axis=1)
    strength = float(np.asarray(light.intensity, np.float64).mean())
    return arm / np.sqrt(square)[:, None], strength / square


def rays_through(
    lens: Lens, light: Light, counts: tuple[int, int], *, seed: int, step: int
) -> Rays:
    """Rays through a grid of cells of the front, each at a random place in its cell.

    Args:
        lens: whose front is lit.
        light: that lights it.
        counts: cells along edge_x and along edge_y; one ray a cell.
        seed: of the random numbers.
        step: which of them: other steps have other places.
    """
    columns, rows = counts
    cell = np.arange(columns * rows)
    x = (cell % columns + uniform(seed, step=step, pixel=cell, dimension=0)) / columns
    y = (cell // columns + uniform(seed, step=step, pixel=cell, dimension=1)) / rows
    points = lens.corner + x[:, None] * lens.edge_x + y[:, None] * lens.edge_y
    area = np.sqrt(np.square(np.cross(lens.edge_x, lens.edge_y)).sum()) / len(cell)
    directions, flux = light_at(light, points)
    cosine = np.einsum("rk,k->r", directions, lens.frame[2])
    back_off = (STAND_OFF * lens.thickness / cosine)[:, None]
    return Rays(points - back_off * directions, np.array(directions), flux * cosine * area)


def cell_power(lens: Lens, light: Light, counts: tuple[int, int]) -> Array:
    """(rows, columns) watts through cells of the front, at their centers.

    Args:
        lens, light: as for `rays_through`.
        counts: cells along edge_x and along edge_y.
    """
    columns, rows = counts
    x, y = (np.arange(columns) + 0.5) / columns, (np.arange(rows) + 0.5) / rows
    points = lens.corner + x[None, :, None] * lens.edge_x + y[:, None, None] * lens.edge_y
    directions, flux = light_at(light, points.reshape(-1, 3))
    power: Array = flux * np.einsum("rk,k->r", directions, lens.frame[2])
    return power.reshape(rows, columns)
