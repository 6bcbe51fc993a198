"""Scenes lit by lists of lights, one for each kind, and one for all."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd.lights import (
    ConstantLight,
    DirectionalLight,
    EnvironmentMap,
    Light,
    PointLight,
    QuadLight,
    SkyLight,
    SphereLight,
    SpotLight,
    SunLight,
    TriangleLight,
    about_y,
)
from photograd.transport import Material, Scene, SphereShape
from photograd.transport.shapes import rectangle

from tests.transport.scenes import FLOOR, GRAY, any_material, view

TILT = about_y(0.7) @ np.array([[1.0, 0, 0], [0, 0.6, -0.8], [0, 0.8, 0.6]])


def texels(height: int = 6, *, seed: int = 5) -> Any:
    """A map with one bright spot above the horizon, so that it matters where samples go."""
    image = 0.1 + 0.3 * np.random.default_rng(seed).random((height, 2 * height, 3))
    image[height // 6, height // 2] += [25.0, 20.0, 12.0]
    return image


def environment_map(height: int = 6, *, turn: Any = None, share: float = 0.0) -> EnvironmentMap:
    return EnvironmentMap(texels(height), np.eye(3) if turn is None else turn, share)


LIGHTS: dict[str, tuple[Light, ...]] = {
    "point": (PointLight([0.8, 1.6, 0.9], [5.0, 4.0, 3.0]),),
    "spot": (SpotLight([0.4, 2.0, 0.8], [-0.2, -1.0, -0.3], [9.0, 7.0, 5.0], 0.75, 0.6),),
    "directional": (DirectionalLight([0.5, 1.0, 0.4], [2.0, 1.5, 1.0]),),
    "ambient": (ConstantLight([0.6, 0.5, 0.4]),),
    "sky": (SkyLight([0.9, 1.0, 1.2], [0.6, 0.5, 0.4], [0.2, 0.2, 0.1]),),
    "sun": (SunLight([0.4, 1.0, 0.3], [25.0, 20.0, 15.0], 0.03),),
    "rectangle": (
        QuadLight([-0.5, 1.5, -0.3], [0.8, 0.0, -0.6], [0.6, 0.0, 0.8], [3.0, 2.5, 2.0]),
    ),
    "sphere": (SphereLight([0.7, 1.3, 0.5], 0.3, [6.0, 5.0, 4.0]),),
    "triangle": (TriangleLight([-0.7, 1.5, -0.4], [0.8, 1.4, -0.5], [0.1, 1.6, 0.9], [5, 4, 3]),),
    "map": (environment_map(),),
    "turned map": (environment_map(turn=TILT),),
}
LIGHTS["all"] = tuple(lights[0] for lights in LIGHTS.values())


def lit_by(*lights: Light, size: int = 8, gloss: Material | None = None, **more: Any) -> Scene:
    """A glossy ball on a gray floor under a list of lights."""
    shapes = (
        rectangle("floor", *FLOOR, "floor"),
        SphereShape("ball", np.array([0.0, 0.5, 0.0]), 0.5, "ball"),
    )
    materials = {"floor": GRAY, "ball": gloss or any_material("gltf")}
    return Scene("lit", shapes, materials, view(size), lights=lights, **more)
