"""Scenes of every kind of light."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
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
from photograd.transport import MeshShape, Scene, Texture, TextureUse
from photograd.transport.shapes import rectangle

from fingerprint_cases.scenes import (
    BLACK,
    FLOOR,
    GLOSS,
    GRAY,
    PANEL,
    Scenes,
    ball,
    dome,
    stage,
    view,
)

TILT = about_y(0.7) @ np.array([[1.0, 0, 0], [0, 0.6, -0.8], [0, 0.8, 0.6]])
OCTAHEDRON = 0.3 * np.concatenate([np.eye(3), -np.eye(3)]) + [0.2, 1.4, 0.3]
SIDES = np.array(
    [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
)


def environment_map(turn: Any = None, share: float = 0.0) -> EnvironmentMap:
    """A map with one bright spot above the horizon."""
    image = 0.1 + 0.3 * np.random.default_rng(5).random((6, 12, 3))
    image[1, 6] += [25.0, 20.0, 12.0]
    return EnvironmentMap(image, np.eye(3) if turn is None else turn, share)


LIGHTS: dict[str, Callable[[], Light]] = {
    "point": lambda: PointLight([0.8, 1.6, 0.9], [5.0, 4.0, 3.0]),
    "spot": lambda: SpotLight([0.4, 2.0, 0.8], [-0.2, -1.0, -0.3], [9.0, 7.0, 5.0], 0.5, 0.95),
    "directional": lambda: DirectionalLight([0.5, 1.0, 0.4], [2.0, 1.5, 1.0]),
    "constant": lambda: ConstantLight([0.6, 0.5, 0.4]),
    "sky": lambda: SkyLight([0.9, 1.0, 1.2], [0.6, 0.5, 0.4], [0.2, 0.2, 0.1]),
    "sun": lambda: SunLight([0.4, 1.0, 0.3], [25.0, 20.0, 15.0], 0.03),
    "quad": lambda: QuadLight([-0.5, 1.5, -0.3], [0.8, 0, -0.6], [0.6, 0, 0.8], [3.0, 2.5, 2.0]),
    "sphere": lambda: SphereLight([0.7, 1.3, 0.5], 0.3, [6.0, 5.0, 4.0]),
    "triangle": lambda: TriangleLight(
        [-0.7, 1.5, -0.4], [0.8, 1.4, -0.5], [0.1, 1.6, 0.9], [5.0, 4.0, 3.0]
    ),
    "map": environment_map,
    "map-turned": lambda: environment_map(TILT, 0.2),
}


def lit_by(*lights: Light, **more: Any) -> Scene:
    """A glossy ball on a gray floor under a list of lights."""
    shapes = (rectangle("floor", *FLOOR, "gray"), ball())
    return Scene("lit", shapes, {"gray": GRAY, "ball": GLOSS}, view(), lights=lights, **more)


def all_lights() -> Scene:
    """One light of each kind."""
    return lit_by(*(make() for make in LIGHTS.values()))


def emitting_shapes() -> Scene:
    """A ball, a box of instances and a textured panel that emit."""
    values = np.random.default_rng(3).uniform(0.1, 1.0, (4, 6, 4))
    corner, u, v = PANEL
    screen = replace(
        rectangle("screen", corner, u, v, "black", [4.0, 3.5, 3.0]),
        emission_texture=TextureUse("image", 1),
    )
    rows = np.eye(4), np.eye(4)
    rows[0][:3, 3], rows[1][:3, 3] = [-0.9, 0.1, 0.3], [0.9, 0.2, 0.0]
    rows[1][0, 0] = 1.4
    small = MeshShape(
        "small",
        0.5 * (OCTAHEDRON - [0.2, 1.2, 0.3]),
        SIDES,
        "gray",
        np.array([0.8, 0.6, 0.4]),
        instances=rows,
    )
    globe = ball("black", (0.0, 0.3, 0.6), 0.2, emission=np.array([1.0, 1.5, 2.0]))
    shapes = (rectangle("floor", *FLOOR, "gloss"), screen, small, globe, dome("gray", scale=0.3))
    materials = {"gray": GRAY, "black": BLACK, "gloss": GLOSS}
    textures = {"image": Texture(values, ("mirror", "clamp"))}
    return Scene("emitting", shapes, materials, view(), textures=textures)


def _lit(name: str) -> Callable[[], Scene]:
    return lambda: lit_by(LIGHTS[name]())


LIT: Scenes = {
    **{f"light-{name}": _lit(name) for name in LIGHTS},
    "lights-all": all_lights,
    "lights-far-and-sky": lambda: stage(
        ball(),
        materials={"ball": GLOSS},
        lights=tuple(LIGHTS[name]() for name in ("map", "sun", "sky", "constant", "directional")),
    ),
    "emitting-shapes": emitting_shapes,
}
