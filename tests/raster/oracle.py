"""Meshes and cameras of the tests, and a rasterizer that asks each pixel for each triangle."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd.capture.camera import Camera
from photograd.capture.frames import rotation_from_axis_angle


def camera(width: int = 24, height: int = 20, focal: float = 26.0, turn: float = 0.1) -> Camera:
    """From (0.1, -0.2, -3) towards +Z, turned a little; what is drawn lies about the origin."""
    pose = np.eye(4)
    pose[:3, :3] = rotation_from_axis_angle(turn * np.array([0.3, -1.0, 0.5]))
    pose[:3, 3] = 0.1, -0.2, -3.0
    return Camera(width, height, focal, 1.1 * focal, 0.49 * width, 0.52 * height, pose)


def sphere(nu: int = 12, nv: int = 8, radius: float = 0.8) -> tuple[Any, Any]:
    """Closed, corners counter-clockwise seen from outside: vertices (V, 3), faces (F, 3)."""
    u = np.arange(nu) / nu * 2 * np.pi
    v = np.arange(1, nv)[:, None] / nv * np.pi
    x, z = np.sin(v) * np.cos(u), -np.sin(v) * np.sin(u)
    rings = np.stack([x, np.cos(v) + 0 * u, z], axis=-1).reshape(-1, 3)
    vertices = radius * np.concatenate([rings, [[0, 1, 0], [0, -1, 0]]])
    faces, top, bottom = [], len(rings), len(rings) + 1
    for i in range(nu):
        k = (i + 1) % nu
        faces.append([top, i, k])
        for j in range(nv - 2):
            a, b = j * nu + i, j * nu + k
            faces += [[a, a + nu, b], [b, a + nu, b + nu]]
        faces.append([bottom, (nv - 2) * nu + k, (nv - 2) * nu + i])
    return vertices, np.array(faces)


def soup(count: int, seed: int, size: float = 0.6) -> tuple[Any, Any]:
    """Triangles anywhere about the origin."""
    rng = np.random.default_rng(seed)
    middle = rng.uniform(-1, 1, (count, 1, 3))
    vertices = (middle + size * rng.uniform(-1, 1, (count, 3, 3))).reshape(-1, 3)
    return vertices, np.arange(3 * count).reshape(-1, 3)


def rasterized(positions: Any, faces: Any, size: tuple[int, int], near: float = 1e-3) -> Any:
    """face (H, W), b (H, W, 3), depth (H, W), by a look at every pair, in plain formulas."""
    height, width = size
    face = np.full(size, -1)
    depth = np.full(size, np.inf)
    weights = np.zeros((*size, 3))
    for y, x in np.ndindex(height, width):
        p = np.array([x + 0.5, y + 0.5, 1.0])
        for number, corners in enumerate(faces):
            m = positions[corners].T
            if np.linalg.det(m) == 0:
                continue
            share = np.linalg.solve(m, p)  # p = sum of share_i V_i; depths are 1 / sum
            if not (share > 0).all():
                continue
            z = 1 / share.sum()
            if near <= z < depth[y, x]:
                face[y, x], depth[y, x], weights[y, x] = number, z, share * z
    return face, weights, depth
