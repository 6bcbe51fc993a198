"""Parts of the scenes that are fingerprinted, and those that need nothing but parts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from photograd.capture.camera import Camera
from photograd.lights import PointLight
from photograd.transport import (
    BUILTIN,
    Environment,
    Material,
    MeshShape,
    Scene,
    SphereShape,
    builtin_scene,
)
from photograd.transport.builtin import camera_at
from photograd.transport.metal_room import BALLS, metal_room
from photograd.transport.shapes import rectangle

Array = Any
Scenes = Mapping[str, Callable[[], Scene]]
WIDTH, HEIGHT = 16, 12
FLOOR = ([-2, 0, 2], [4, 0, 0], [0, 0, -4])  # y = 0, faces up
PANEL = ([-0.6, 1.5, -0.6], [1.2, 0, 0], [0, 0, 1.2])  # y = 1.5, faces down
GRAY = Material("lambert", {"albedo": [0.5, 0.45, 0.4]})
BLACK = Material("lambert", {"albedo": [0.0, 0.0, 0.0]})
GLOSS = Material("gltf", {"base_color": [0.8, 0.6, 0.4], "metalness": 0.3, "roughness": 0.4})
GLASS = Material("glass", {"eta": 1.4, "tint": [0.9, 0.95, 1.0]})
SKY = Environment(np.array([0.5, 0.6, 0.9]), np.array([0.6, 0.5, 0.4]), np.array([0.3, 0.2, 0.2]))
POINT = PointLight([-0.9, 1.2, 0.9], [0.9, 0.8, 0.7])


def view(
    position: Any = (0.0, 1.0, 2.4),
    target: Any = (0.0, 0.6, 0.0),
    *,
    width: int = WIDTH,
    height: int = HEIGHT,
) -> Camera:
    """A camera 60 degrees wide."""
    return camera_at(position, target, 60.0, width, height)


def panel(radiance: float = 4.0) -> MeshShape:
    """A square light that faces down."""
    return rectangle("panel", *PANEL, "black", [radiance, 0.9 * radiance, 0.8 * radiance])


def stage(*shapes: Any, materials: Mapping[str, Material] | None = None, **more: Any) -> Scene:
    """Shapes on a gray floor, under a square light, a point light and a sky."""
    given = {"camera": view(), "environment": SKY, "lights": (POINT,), **more}
    return Scene(
        "stage",
        (rectangle("floor", *FLOOR, "gray"), panel(), *shapes),
        {"gray": GRAY, "black": BLACK, **(materials or {})},
        **given,
    )


def ball(
    material: str = "ball", center: Any = (0.0, 0.5, 0.0), radius: float = 0.5, **more: Any
) -> SphereShape:
    """A ball on the floor."""
    name = more.pop("name", "ball")
    return SphereShape(name, np.array(center, np.float64), radius, material, **more)


def dome(material: str, **more: Any) -> MeshShape:
    """A coarse half ball, open below, with shading normals and texture coordinates."""
    up, around = np.meshgrid(np.linspace(0.15, 1.5, 5), np.linspace(0, 2 * np.pi, 10))
    points = np.stack([np.sin(up) * np.sin(around), np.cos(up), np.sin(up) * np.cos(around)], -1)
    number = np.arange(50).reshape(10, 5)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    faces = np.concatenate([np.stack(t, -1).reshape(-1, 3) for t in ((a, d, c), (a, c, b))])
    uv = np.stack([around / (2 * np.pi), up / 1.5], -1).reshape(-1, 2)
    normals = points.reshape(-1, 3)
    at = np.asarray(more.pop("at", (0.0, 0.0, 0.0)))
    name, scale = more.pop("name", "dome"), more.pop("scale", 0.5)
    return MeshShape(
        name,
        scale * normals + at,
        faces,
        material,
        normals=normals,
        uv=more.pop("uv", 1.0) * uv,
        **more,
    )


def bent_floor() -> Scene:
    """A floor whose shading normals lean by up to 60 degrees."""
    n = 7
    x, z = np.meshgrid(np.linspace(-2, 2, n), np.linspace(-2, 2, n), indexing="ij")
    vertices = np.stack([x, np.zeros_like(x), z], axis=-1).reshape(-1, 3)
    corner = np.arange(n * n).reshape(n, n)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    faces = np.concatenate([np.stack(t, -1).reshape(-1, 3) for t in ((a, d, c), (a, c, b))])
    g = np.random.default_rng(4)
    lean, turn = np.radians(g.uniform(0, 60, n * n)), g.uniform(0, 2 * np.pi, n * n)
    normals = np.stack(
        [np.sin(lean) * np.cos(turn), np.cos(lean), np.sin(lean) * np.sin(turn)], axis=-1
    )
    bent = MeshShape("bent", vertices, faces, "ball", normals=normals)
    scene = stage(ball(), materials={"ball": GLOSS})
    return replace(scene, shapes=(bent, *scene.shapes[1:]))


def without_unused(scene: Scene) -> Scene:
    """The scene without materials and textures that nothing uses: their gradients are zero."""
    names = {shape.material for shape in scene.shapes}
    materials = {name: m for name, m in scene.materials.items() if name in names}
    uses = [use for m in materials.values() for use in m.textures.values()]
    uses += [
        s.emission_texture
        for s in scene.shapes
        if isinstance(s, MeshShape) and s.emission_texture is not None
    ]
    textures = {use.texture: scene.textures[use.texture] for use in uses}
    return replace(scene, materials=materials, textures=textures)


def large(name: str = "cornell-spheres") -> Scene:
    """A built-in scene in a picture of many chunks of pixels."""
    return replace(builtin_scene(name, 8), camera=builtin_scene(name, 48).camera)


def _builtin(name: str) -> Callable[[], Scene]:
    return lambda: builtin_scene(name, 10)


def _metal(name: str) -> Callable[[], Scene]:
    return lambda: metal_room(10, name)


BASIC: Scenes = {
    **{f"builtin-{name}": _builtin(name) for name in BUILTIN},
    **{f"metal-room-{name}": _metal(name) for name in BALLS},
    "stage": lambda: stage(ball(), materials={"ball": GLOSS}),
    "bent-floor": bent_floor,
    "large-surfaces": large,
    "large-media": lambda: large("wax"),
}
