"""Small scenes for the passes of a frame."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd.capture.camera import Camera
from photograd.lights import DirectionalLight, PointLight, SpotLight
from photograd.transport import Material, Scene
from photograd.transport.shapes import SphereShape, box, rectangle

GRAY = Material("lambert", {"albedo": [0.6, 0.5, 0.4]})
LIGHTS = {
    "point": PointLight([0.4, 2.5, 0.7], [9.0, 8.0, 7.0]),
    "spot": SpotLight([0.4, 2.5, 0.7], [-0.1, -1.0, -0.2], [20.0, 18.0, 15.0], 0.8, 0.5),
    "directional": DirectionalLight([0.3, 1.0, 0.4], [2.0, 1.8, 1.6]),
}


def camera(width: int = 96, height: int = 64) -> Camera:
    """In front and above, looking down at the floor."""
    back = np.array([0.0, 0.6, 1.0]) / np.linalg.norm([0.0, 0.6, 1.0])
    down = np.array([0.0, -1.0, 0.6]) / np.linalg.norm([0.0, 1.0, 0.6])
    pose = np.eye(4)
    pose[:3, :3] = np.stack([[1.0, 0.0, 0.0], down, -back], axis=1)
    pose[:3, 3] = 3.5 * back + np.array([0.0, 0.3, 0.0])
    return Camera(width, height, 1.1 * width, 1.1 * width, width / 2, height / 2, pose)


def floor(material: str = "gray") -> Any:
    return rectangle(
        "floor", [-2.0, 0.0, 2.0], [4.0, 0.0, 0.0], [0.0, 0.0, -4.0], material, [0, 0, 0]
    )


def room(light: Any, material: Material = GRAY, **more: Any) -> Scene:
    """A box and a ball on a floor under one light."""
    shapes = (
        floor(),
        box("box", [-0.9, 0.0, -0.5], [0.7, 0.8, 0.7], "gray"),
        SphereShape("ball", [0.5, 0.4, 0.0], 0.4, "gray"),
    )
    lights = () if light is None else (light,)
    return Scene("room", shapes, {"gray": material}, camera(), lights=lights, **more)
