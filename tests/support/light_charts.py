"""Lights seen from one point, each with a chart: where on it a sample lies, and how much it fills.

A chart maps patches x (s, t) in [0, 1]^2 to directions and knows the solid angle of ds dt. The
proofs ask it which cell a sample fell into, and integrate a light's density over that cell, so
that cells end where the light ends.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt
from photograd.lights import EnvironmentMap, LightSamples, SphereLight

Array = npt.NDArray[Any]
CELLS = 16  # along s and t of a patch


class Chart(Protocol):
    """Which part of the sphere a light fills."""

    patches: int

    def directions(self, patch: int, s: Array, t: Array) -> tuple[Array, Array]:
        """Directions (N, 3), and solid angle over ds dt (N,)."""

    def places(self, samples: LightSamples) -> tuple[Array, Array, Array]:
        """Patch, s and t (N,) of samples."""

    def edges(self) -> tuple[Array, Array]:
        """Edges of the cells in s and t."""


def even_edges() -> tuple[Array, Array]:
    line = np.linspace(0.0, 1.0, CELLS + 1)
    return line, line


@dataclass(frozen=True)
class Parallelogram:
    """Points corner + s x + t y, seen from `point`."""

    point: Array
    corner: Array
    x: Array
    y: Array
    patches: int = 1

    def directions(self, _: int, s: Array, t: Array) -> tuple[Array, Array]:
        to = self.corner - self.point + s[:, None] * self.x + t[:, None] * self.y
        r = np.linalg.norm(to, axis=1)
        area = np.cross(self.x, self.y)
        return to / r[:, None], np.abs(to @ area) / r**3

    def places(self, samples: LightSamples) -> tuple[Array, Array, Array]:
        to = self.point + samples.distance[:, None] * samples.direction - self.corner
        found = np.linalg.lstsq(np.stack([self.x, self.y], axis=1), to.T, rcond=None)[0]
        return np.zeros(len(to), np.int64), found[0], found[1]

    def edges(self) -> tuple[Array, Array]:
        return even_edges()


@dataclass(frozen=True)
class Triangles:
    """Points a + s ((1 - t) ab + t ac) of each of the triangles (F, 3, 3), seen from `point`."""

    point: Array
    corners: Array

    @property
    def patches(self) -> int:
        return len(self.corners)

    def directions(self, patch: int, s: Array, t: Array) -> tuple[Array, Array]:
        a, b, c = self.corners[patch]
        to = a - self.point + s[:, None] * ((1 - t)[:, None] * (b - a) + t[:, None] * (c - a))
        r = np.linalg.norm(to, axis=1)
        return to / r[:, None], s * np.abs(to @ np.cross(b - a, c - a)) / r**3

    def places(self, samples: LightSamples) -> tuple[Array, Array, Array]:
        at = self.point + samples.distance[:, None] * samples.direction
        patch = np.full(len(at), -1)
        s, t = np.zeros(len(at)), np.zeros(len(at))
        for number, (a, b, c) in enumerate(self.corners):
            frame = np.stack([b - a, c - a, np.cross(b - a, c - a)], axis=1)
            u, v, off = np.linalg.solve(frame, (at - a).T)
            on = (np.abs(off) < 1e-9) & (u > -1e-9) & (v > -1e-9) & (u + v < 1 + 1e-9)
            patch[on], s[on] = number, (u + v)[on]
            t[on] = (v / np.maximum(u + v, 1e-300))[on]
        return patch, s, t

    def edges(self) -> tuple[Array, Array]:
        return even_edges()


@dataclass(frozen=True)
class Ball:
    """Directions at height 1 - h s around the center, turned by 2 pi t."""

    point: Array
    light: SphereLight
    patches: int = 1

    def frame(self) -> tuple[Array, float]:
        to = np.asarray(self.light.center) - self.point
        axis = to / np.linalg.norm(to)
        side = np.cross(axis, [1.0, 0.0, 0.0])
        side /= np.linalg.norm(side)
        angle = np.arcsin(self.light.radius / np.linalg.norm(to))
        return np.stack([side, np.cross(axis, side), axis]), 1.0 - float(np.cos(angle))

    def directions(self, _: int, s: Array, t: Array) -> tuple[Array, Array]:
        frame, height = self.frame()
        z, phi = 1.0 - height * s, 2.0 * np.pi * t
        r = np.sqrt(1.0 - z * z)
        local = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1)
        return local @ frame, np.full(len(s), 2.0 * np.pi * height)

    def places(self, samples: LightSamples) -> tuple[Array, Array, Array]:
        frame, height = self.frame()
        on = samples.distance[:, None] * samples.direction + self.point - self.light.center
        # The distance too: every sample lies on the ball.
        np.testing.assert_allclose(np.linalg.norm(on, axis=1), self.light.radius, rtol=1e-12)
        x, y, z = frame @ samples.direction.T
        return np.zeros(len(x), np.int64), (1 - z) / height, np.arctan2(y, x) / (2 * np.pi) % 1.0

    def edges(self) -> tuple[Array, Array]:
        return even_edges()


@dataclass(frozen=True)
class Sphere:
    """Height 1 - 2 s and longitude 2 pi t - pi in the frame of a map; cells between its texels."""

    light: EnvironmentMap
    patches: int = 1

    def directions(self, _: int, s: Array, t: Array) -> tuple[Array, Array]:
        y, phi = 1.0 - 2.0 * s, 2.0 * np.pi * (t - 0.5)
        r = np.sqrt(1.0 - y * y)
        local = np.stack([-r * np.sin(phi), y, r * np.cos(phi)], axis=1)
        return local @ self.light.world_from_map.T, np.full(len(s), 4.0 * np.pi)

    def places(self, samples: LightSamples) -> tuple[Array, Array, Array]:
        assert np.isinf(samples.distance).all()
        x, y, z = (samples.direction @ self.light.world_from_map).T
        longitude = np.arctan2(-x, z) / (2 * np.pi) + 0.5
        return np.zeros(len(x), np.int64), (1 - y) / 2, longitude

    def edges(self) -> tuple[Array, Array]:
        height = len(self.light.texels)
        theta = np.pi * (np.arange(height) + 0.5) / height
        columns = (np.arange(2 * height) + 0.5) / (2 * height)
        s = np.concatenate([[0.0], (1.0 - np.cos(theta)) / 2.0, [1.0]])
        return s, np.concatenate([[0.0], columns, [1.0]])
