"""Balls of wax, of coloured glass and of smoke: what happens between surfaces."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from photograd.lights import QuadLight
from photograd.transport.camera_place import camera_at
from photograd.transport.medium import BOUNDARY, DensityGrid, Medium
from photograd.transport.scene import Environment, Material, Scene, Shape, SphereShape
from photograd.transport.shapes import rectangle

RADIUS = 0.5


def smoke_densities(n: int = 32) -> npt.NDArray[np.float64]:
    """Billows (n, n, n) from 0 to 1 in a box, thin towards the rim of the ball in it."""
    at = (np.arange(n) + 0.5) / n * 2 - 1
    x, y, z = np.meshgrid(at, at, at, indexing="ij")
    wave = np.sin(5 * x + 2 * np.sin(3 * y)) + np.sin(6 * y + 2 * np.sin(4 * z))
    wave = wave + np.sin(5 * z + 2 * np.sin(5 * x))
    r = np.sqrt(x * x + y * y + z * z)
    densities: npt.NDArray[np.float64] = np.clip(0.35 + 0.35 * wave, 0.0, 1.0)
    densities *= np.clip(4 * (1 - r), 0.0, 1.0)
    return densities


def wax(size: int = 256) -> Scene:
    """A ball of wax, one of amber glass and one of smoke, lit from behind and above."""
    smoke_at = np.array([1.1, RADIUS, 0.0])
    shapes: tuple[Shape, ...] = (
        rectangle("table", [-4, 0, 3], [8, 0, 0], [0, 0, -7], "table"),
        SphereShape("wax ball", np.array([-1.1, RADIUS, 0.0]), RADIUS, BOUNDARY, interior="wax"),
        SphereShape("amber ball", np.array([0.0, RADIUS, -0.2]), RADIUS, "glass", interior="amber"),
        SphereShape("smoke ball", smoke_at, RADIUS, BOUNDARY, interior="smoke"),
    )
    materials = {
        "table": Material("lambert", {"albedo": [0.5, 0.48, 0.45]}),
        "glass": Material("glass", {"eta": 1.54, "tint": [1.0, 1.0, 1.0]}),
    }
    box = np.eye(4)
    box[:3, :3] *= 2 * RADIUS
    box[:3, 3] = smoke_at - RADIUS
    media = {
        # Marble and skin have mean free paths below a millimetre [Jensen2001]; this wax has some
        # of 7 to 11 centimetres, so that light gets through a ball of a metre.
        "wax": Medium([9.0, 11.0, 14.0], [0.998, 0.99, 0.96], values={"g": 0.3}),
        "amber": Medium([0.15, 0.9, 3.2]),
        "smoke": Medium(12.0, [0.8, 0.83, 0.88], values={"g": 0.4},
                        density=DensityGrid(smoke_densities(), box)),
    }  # fmt: skip
    camera = camera_at([0.0, 1.1, 4.8], [0.0, 0.45, 0.0], 40.0, size, size)
    lamp = QuadLight([-2.0, 2.8, -2.2], [4.0, 0.0, 0.0], [0.0, 1.0, 1.0], [7.0, 6.4, 5.6])
    sky = Environment(np.array([0.35, 0.45, 0.6]), np.full(3, 0.3), np.full(3, 0.1))
    return Scene("wax", shapes, materials, camera, sky, (lamp,), media=media)
