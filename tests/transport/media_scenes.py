"""Small scenes with something between their surfaces."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from photograd.lights import PointLight
from photograd.transport import (
    BOUNDARY,
    DensityGrid,
    Environment,
    Material,
    Medium,
    Scene,
    SphereShape,
)
from photograd.transport.builtin import camera_at
from photograd.transport.shapes import box, rectangle

from tests.transport.scenes import BLACK, FLOOR, GRAY, LAMP, view

GLASS = Material("glass", {"eta": 1.4, "tint": [1.0, 1.0, 1.0]})
FROSTED = Material("rough_dielectric", {"eta": 1.4, "roughness": 0.8})
FOG = Medium([0.9, 0.6, 0.4], [0.8, 0.7, 0.9], values={"g": 0.4})
WAX = Medium([4.0, 5.0, 6.0], [0.95, 0.9, 0.8], "cornette_shanks", {"g": 0.2})
INK = Medium([0.3, 1.1, 2.2])


def placed(corner: Any, size: Any) -> Any:
    """world_from_box (4, 4)."""
    matrix = np.eye(4)
    matrix[:3, 3] = corner
    matrix[[0, 1, 2], [0, 1, 2]] = size
    return matrix


def cloud(shape: tuple[int, int, int] = (3, 4, 5), *, seed: int = 3) -> Any:
    """Densities (X, Y, Z) between 0.1 and 1."""
    return 0.1 + 0.9 * np.random.default_rng(seed).random(shape)


def smoke(values: Any = None, **more: Any) -> Medium:
    """A medium with a grid in the box of `fog_box`."""
    grid = DensityGrid(
        cloud() if values is None else values, placed([-0.9, 0.05, -0.9], [1.8, 1.3, 1.8]), **more
    )
    return Medium([1.8, 1.4, 1.0], [0.8, 0.7, 0.9], values={"g": 0.3}, density=grid)


def fog_box(medium: Medium = FOG, *, size: int = 8, sky: float | None = 0.3) -> Scene:
    """A box of fog on a gray floor, under a light and perhaps a sky."""
    shapes = (
        rectangle("floor", *FLOOR, "floor"),
        box("fog", [0, 0.7, 0], [1.8, 1.3, 1.8], BOUNDARY),
        rectangle("lamp", *LAMP, "black", [4.0, 3.6, 3.2]),
    )
    filled = (shapes[0], with_interior(shapes[1], "fog"), shapes[2])
    materials = {"floor": GRAY, "black": BLACK}
    environment = None if sky is None else Environment.constant(sky)
    return Scene("fog", filled, materials, view(size), environment, media={"fog": medium})


def with_interior(shape: Any, name: str) -> Any:
    return replace(shape, interior=name)


def ball_of(
    medium: Medium,
    material: Material | None = None,
    *,
    size: int = 8,
    sky: float = 1.0,
    lights: Any = (),
    camera: Any = None,
    floor: bool = False,
) -> Scene:
    """A ball of 1 m across, filled; without a material its surface is a mere boundary."""
    name = BOUNDARY if material is None else "shell"
    shapes: tuple[Any, ...] = (
        SphereShape("ball", np.array([0.0, 0.5, 0.0]), 0.5, name, interior="inside"),
    )
    if floor:
        shapes = (rectangle("floor", *FLOOR, "floor"), *shapes)
    materials = {"floor": GRAY} if material is None else {"floor": GRAY, "shell": material}
    seen = view(size, (0, 0.5, 2.0), (0, 0.5, 0)) if camera is None else camera
    return Scene(
        "ball", shapes, materials, seen, Environment.constant(sky), lights, media={"inside": medium}
    )


def haze(medium: Medium = FOG, *, size: int = 8) -> Scene:
    """Infinite haze, a clear ball of glass in it, an area light and a point light."""
    shapes = (
        rectangle("floor", *FLOOR, "floor"),
        SphereShape("ball", np.array([0.4, 0.4, 0.0]), 0.4, "glass"),
        rectangle("lamp", *LAMP, "black", [6.0, 5.0, 4.0]),
    )
    materials = {"floor": GRAY, "glass": GLASS, "black": BLACK}
    lights = (PointLight([-0.8, 0.9, 0.4], [1.5, 1.2, 1.0]),)
    return Scene(
        "haze", shapes, materials, view(size), None, lights, media={"haze": medium}, world="haze"
    )


def pencil(position: Any, target: Any) -> Any:
    """A camera of one pixel that sees a ten-millionth of a degree."""
    return camera_at(position, target, 1e-7, 1, 1)
