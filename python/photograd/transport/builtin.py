"""Scenes by name: a Cornell box, a furnace, balls under an evening sky, balls of wax and smoke,
bodies of signed distances, things in motion.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from photograd_course.suggest import choose_from

from photograd.errors import RangeError, SceneError, message
from photograd.lights import EnvironmentMap
from photograd.transport.builtin_media import wax
from photograd.transport.builtin_motion import thrown
from photograd.transport.builtin_sdf import carved
from photograd.transport.camera_place import camera_at
from photograd.transport.evening import evening_map
from photograd.transport.scene import Environment, Material, MeshShape, Scene, Shape, SphereShape
from photograd.transport.shapes import box, rectangle


def cornell_box(size: int = 256) -> Scene:
    """A room 2 m wide with a red and a green wall, two boxes and a lamp in the ceiling."""
    shapes = (
        *_room(),
        box("tall", [-0.33, 0.6, -0.28], [0.6, 1.2, 0.6], "white", turn=17.0),
        box("short", [0.33, 0.3, 0.38], [0.6, 0.6, 0.6], "white", turn=-17.0),
    )
    camera = camera_at([0.0, 1.0, 6.8], [0.0, 1.0, 0.0], 19.5, size, size)
    return Scene("cornell-box", shapes, _walls(), camera)


def cornell_spheres(size: int = 256) -> Scene:
    """The same room with a ball of glass and a ball of copper instead of boxes."""
    shapes: tuple[Shape, ...] = (
        *_room(),
        SphereShape("mirror ball", np.array([-0.42, 0.42, -0.35]), 0.42, "copper"),
        SphereShape("glass ball", np.array([0.42, 0.38, 0.35]), 0.38, "glass"),
    )
    materials = {
        **_walls(),
        "copper": Material("ggx_metal", {"f0": [0.95, 0.64, 0.54], "roughness": 0.3}),
        "glass": Material("glass", {"eta": 1.5, "tint": [1.0, 1.0, 1.0]}),
    }
    camera = camera_at([0.0, 1.0, 6.8], [0.0, 1.0, 0.0], 19.5, size, size)
    return Scene("cornell-spheres", shapes, materials, camera)


def furnace_box(size: int = 64, albedo: float = 0.5, emission: float = 1.0) -> Scene:
    """A closed box whose walls all shine and reflect: everywhere L = emission / (1 - albedo)."""
    walls = box("walls", [0, 0, 0], [2, 2, 2], "wall", [emission] * 3, inward=True)
    camera = camera_at([0.3, 0.1, 0.5], [-1.0, -0.4, -1.0], 60.0, size, size)
    wall = Material("lambert", {"albedo": [albedo] * 3})
    return Scene("furnace-box", (walls,), {"wall": wall}, camera)


def white_ball(size: int = 64) -> Scene:
    """A ball that returns all light, under an even sky: it cannot be seen."""
    ball = SphereShape("ball", np.zeros(3), 1.0, "white")
    camera = camera_at([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], 40.0, size, size)
    white = Material("lambert", {"albedo": [1.0, 1.0, 1.0]})
    return Scene("white-ball", (ball,), {"white": white}, camera, Environment.constant(1.0))


def evening(size: int = 256) -> Scene:
    """Balls of clay, copper and glass on a table, lit by an environment map with a low sun."""
    shapes: tuple[Shape, ...] = (
        rectangle("table", [-3, 0, 3], [6, 0, 0], [0, 0, -6], "table"),
        SphereShape("clay ball", np.array([-1.1, 0.5, 0.0]), 0.5, "clay"),
        SphereShape("copper ball", np.array([0.0, 0.5, -0.3]), 0.5, "copper"),
        SphereShape("glass ball", np.array([1.1, 0.5, 0.0]), 0.5, "glass"),
    )
    materials = {
        "table": Material("lambert", {"albedo": [0.45, 0.42, 0.38]}),
        "clay": Material("lambert", {"albedo": [0.6, 0.35, 0.25]}),
        "copper": Material("ggx_metal", {"f0": [0.95, 0.64, 0.54], "roughness": 0.2}),
        "glass": Material("glass", {"eta": 1.5, "tint": [1.0, 1.0, 1.0]}),
    }
    camera = camera_at([0.0, 1.1, 4.8], [0.0, 0.5, 0.0], 40.0, size, size)
    return Scene("evening", shapes, materials, camera, lights=(EnvironmentMap(evening_map()),))


__all__ = ["BUILTIN", "builtin_scene", "camera_at"]

BUILTIN: dict[str, Callable[[int], Scene]] = {
    "cornell-box": cornell_box,
    "cornell-spheres": cornell_spheres,
    "furnace-box": furnace_box,
    "white-ball": white_ball,
    "evening": evening,
    "wax": wax,
    "carved": carved,
    "thrown": thrown,
}
"""Scenes by name, made for pictures of a given size."""


def builtin_scene(name: str, size: int = 256) -> Scene:
    """A scene of `BUILTIN`, with a square camera of `size` pixels.

    Raises:
        SceneError: no such scene.
        RangeError: no such size.
    """
    if name not in BUILTIN:
        known = choose_from(name, BUILTIN)
        raise SceneError(message("builtin_scene", "name", "a built-in scene", name, known))
    if size < 1:
        raise RangeError(message("builtin_scene", "size", "at least 1 pixel", size))
    return BUILTIN[name](size)


def _walls() -> dict[str, Material]:
    return {
        "white": Material("lambert", {"albedo": [0.725, 0.71, 0.68]}),
        "red": Material("lambert", {"albedo": [0.63, 0.065, 0.05]}),
        "green": Material("lambert", {"albedo": [0.14, 0.45, 0.091]}),
        "lamp": Material("lambert", {"albedo": [0.0, 0.0, 0.0]}),
    }


def _room() -> tuple[MeshShape, ...]:
    return (
        rectangle("floor", [-1, 0, 1], [2, 0, 0], [0, 0, -2], "white"),
        rectangle("ceiling", [-1, 2, -1], [2, 0, 0], [0, 0, 2], "white"),
        rectangle("back", [-1, 0, -1], [2, 0, 0], [0, 2, 0], "white"),
        rectangle("left", [-1, 0, 1], [0, 0, -2], [0, 2, 0], "red"),
        rectangle("right", [1, 0, -1], [0, 0, 2], [0, 2, 0], "green"),
        rectangle(
            "lamp", [-0.25, 1.98, -0.19], [0.5, 0, 0], [0, 0, 0.38], "lamp", [17.0, 12.0, 4.0]
        ),
    )
