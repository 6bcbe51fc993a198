"""A ball that is thrown, a die that turns, a ball of glass that rolls away: motion blur."""

from __future__ import annotations

import numpy as np

from photograd.lights import QuadLight
from photograd.transport.camera_place import camera_at
from photograd.transport.motion import moved_on
from photograd.transport.scene import Environment, Material, Scene, Shape, SphereShape
from photograd.transport.shapes import box, rectangle


def thrown(size: int = 256) -> Scene:
    """Three things that move while the shutter is open, and a copper ball that lies there."""
    die = box("die", [-0.6, 0.25, 0.4], [0.5, 0.5, 0.5], "ivory", turn=20.0)
    shapes: tuple[Shape, ...] = (
        rectangle("table", [-4, 0, 3], [8, 0, 0], [0, 0, -7], "table"),
        SphereShape(
            "thrown", np.array([-0.9, 1.35, -0.5]), 0.25, "clay", closing=np.array([0.0, 1.6, -0.4])
        ),
        moved_on(die, _turned(25.0, [-0.6, 0.0, 0.4], [0.06, 0.0, 0.0])),
        SphereShape(
            "rolling",
            np.array([0.55, 0.32, 0.7]),
            0.32,
            "glass",
            closing=np.array([0.67, 0.32, 0.65]),
        ),
        SphereShape("still", np.array([0.75, 0.5, -0.7]), 0.5, "copper"),
    )
    materials = {
        "table": Material("lambert", {"albedo": [0.5, 0.48, 0.45]}),
        "clay": Material("lambert", {"albedo": [0.62, 0.3, 0.2]}),
        "ivory": Material("lambert", {"albedo": [0.75, 0.7, 0.58]}),
        "glass": Material("glass", {"eta": 1.5, "tint": [0.9, 1.0, 0.95]}),
        "copper": Material("ggx_metal", {"f0": [0.95, 0.64, 0.54], "roughness": 0.2}),
    }
    camera = camera_at([0.0, 1.4, 4.6], [0.0, 0.65, 0.0], 33.0, size, size)
    lamp = QuadLight([-2.6, 3.2, 1.4], [1.6, 0.0, 0.0], [0.0, -0.8, 1.0], [20.0, 18.5, 16.5])
    sky = Environment(np.array([0.3, 0.42, 0.6]), np.full(3, 0.25), np.full(3, 0.1))
    return Scene("thrown", shapes, materials, camera, sky, (lamp,))


def _turned(degrees: float, about: list[float], shift: list[float]) -> np.ndarray:
    """(4, 4): a turn about the vertical through a point, then a shift, metres."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    matrix = np.array([[c, 0, s, 0], [0, 1, 0, 0], [-s, 0, c, 0], [0, 0, 0, 1.0]])
    matrix[:3, 3] = np.asarray(about) - matrix[:3, :3] @ np.asarray(about) + np.asarray(shift)
    return matrix
