"""The lights that fill a part of the sphere, each from a point from where all of it is seen."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd.lights import EnvironmentMap, QuadLight, SphereLight, TriangleLight, about_y
from photograd_course.random import uniform

from support.light_charts import Ball, Parallelogram, Sphere, Triangles
from support.light_proofs import Seen, polygon_irradiance

COLOR = np.array([1.0, 2.0, 0.5])
POINT = np.array([0.3, -0.1, 0.2])
UP = np.array([2.0, 9.0, 6.0]) / 11.0
# Above POINT, in general position: edges x and y are perpendicular and the front looks down.
CORNER = np.array([-0.6, 1.1, 1.2])
EDGE_X = np.array([0.5, -0.4, -1.2])
EDGE_Y = np.array([1.2, 0.3, 0.4])
TRIANGLE = np.array([[-0.5, 0.9, 0.4], [0.2, 0.8, -0.9], [0.9, 1.2, 0.7]])
# An octahedron, its faces counterclockwise seen from outside.
OCTAHEDRON = np.concatenate([np.eye(3), -np.eye(3)]) * [0.5, 0.3, 0.4] + [0.2, 1.4, 0.6]
FACES = np.array(
    [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
)


def quad() -> Seen:
    light = QuadLight(CORNER, EDGE_X, EDGE_Y, COLOR)
    outline = np.stack([CORNER, CORNER + EDGE_X, CORNER + EDGE_X + EDGE_Y, CORNER + EDGE_Y])
    known = COLOR * polygon_irradiance(outline, POINT, UP)
    return Seen(light, POINT, UP, Parallelogram(POINT, CORNER, EDGE_X, EDGE_Y), known)


def triangle() -> Seen:
    light = TriangleLight(*TRIANGLE, COLOR)
    known = COLOR * polygon_irradiance(TRIANGLE, POINT, UP)
    return Seen(light, POINT, UP, Triangles(POINT, TRIANGLE[None]), known)


def sphere() -> Seen:
    light = SphereLight([0.4, 1.0, 0.5], 0.35, COLOR)
    to = np.asarray(light.center) - POINT
    d = np.linalg.norm(to)
    # All of the ball is above the horizon: pi (radius / d)^2 cos, as of a disc.
    known = COLOR * (np.pi * (light.radius / d) ** 2 * float(to @ UP) / d)
    return Seen(light, POINT, UP, Ball(POINT, light), known)


def texels(height: int = 8, *, seed: int = 31) -> Any:
    """Positive numbers (H, 2 H, 3), a few of them bright."""
    u = uniform(seed, pixel=np.arange(height * 2 * height)[:, None], dimension=np.arange(3))
    return (0.05 + u**8 * 20.0).reshape(height, 2 * height, 3)


def bilinear_oracle(image: Any, w: Any, world_from_map: Any) -> Any:
    """Radiance (N, 3) from directions (N, 3), texel by texel in NumPy."""
    height, width = image.shape[:2]
    x, y, z = (w @ world_from_map).T
    column = (np.arctan2(-x, z) / (2.0 * np.pi) + 0.5) * width - 0.5
    row = np.clip(np.arccos(np.clip(y, -1.0, 1.0)) / np.pi * height - 0.5, 0.0, height - 1.0)
    left, top = np.floor(column).astype(int), np.floor(row).astype(int)
    f, g = (column - left)[:, None], (row - top)[:, None]
    below = np.minimum(top + 1, height - 1)
    upper = (1 - f) * image[top, left % width] + f * image[top, (left + 1) % width]
    lower = (1 - f) * image[below, left % width] + f * image[below, (left + 1) % width]
    return (1 - g) * upper + g * lower


def environment() -> Seen:
    light = EnvironmentMap(texels(), about_y(0.7))
    return Seen(light, POINT, UP, Sphere(light), environment_irradiance(light))


def environment_irradiance(light: EnvironmentMap, rows: int = 512) -> Any:
    """By the midpoint rule in height and longitude, on the oracle's radiance."""
    height = 1.0 - (np.arange(rows) + 0.5) * 2.0 / rows
    phi = (np.arange(2 * rows) + 0.5) * np.pi / rows
    h, p = (part.ravel() for part in np.meshgrid(height, phi, indexing="ij"))
    r = np.sqrt(1.0 - h * h)
    w = np.stack([r * np.cos(p), h, r * np.sin(p)], axis=1)
    value = bilinear_oracle(light.texels, w, light.world_from_map)
    cosine = np.maximum(w @ UP, 0.0)[:, None]
    return (value * cosine).sum(axis=0) * (4.0 * np.pi / len(w))


SEEN = {"quad": quad, "triangle": triangle, "sphere": sphere, "environment": environment}
