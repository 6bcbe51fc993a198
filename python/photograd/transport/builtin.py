"""Scenes by name: a Cornell box, a furnace, balls under an evening sky, balls of wax and smoke,
signed distance functions, things in motion.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
from photograd_course.suggest import choose_from

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.capture.orbit import look_at
from photograd.errors import SceneError, message
from photograd.geometry import sdf
from photograd.lights import EnvironmentMap, QuadLight
from photograd.transport.material import Material
from photograd.transport.medium import BOUNDARY, DensityGrid, Medium
from photograd.transport.motion import moved_on
from photograd.transport.scene import Environment, Scene
from photograd.transport.shapes import MeshShape, SdfShape, Shape, SphereShape, box, rectangle
from photograd.types import Array


def camera_at(
    position: object, target: object, field_of_view: float, width: int, height: int
) -> Camera:
    """A camera that looks from one point to another; field_of_view is vertical, in degrees.

    Args:
        position: (3,) of the camera.
        target: (3,) in the middle of its picture.
        field_of_view: vertical, in degrees.
        width, height: of the picture, in pixels.
    """
    focal = 0.5 * height / float(np.tan(np.radians(field_of_view) / 2))
    pose = look_at(np.asarray(position, np.float64), np.asarray(target, np.float64))
    return Camera(width, height, focal, focal, width / 2, height / 2, pose)


# A sky shortly before sunset, as an environment map that a formula paints.


ZENITH, HORIZON, GROUND = [0.2, 0.36, 0.75], [1.5, 0.9, 0.52], [0.15, 0.12, 0.10]
SUN = np.array([0.62, 0.26, 0.44])  # towards it, of any length
SUN_RADIANCE, SUN_SHARPNESS = [700.0, 460.0, 240.0], 900.0  # a lobe of about 2.7 degrees
GLOW_RADIANCE, GLOW_SHARPNESS = [2.0, 1.1, 0.5], 8.0


def map_directions(height: int) -> Array:
    """Directions (H, 2 H, 3) of the texels' centers, as `EnvironmentMap` has them.

    Args:
        height: H, texels from the zenith to the nadir.
    """
    theta = (np.arange(height) + 0.5) / height * np.pi
    phi = ((np.arange(2 * height) + 0.5) / (2 * height) - 0.5) * 2 * np.pi
    side = np.sin(theta)[:, None]
    up = np.broadcast_to(np.cos(theta)[:, None], (height, 2 * height))
    return np.stack([-side * np.sin(phi), up, side * np.cos(phi)], axis=-1)


def evening_map(height: int = 64, sun: Any = SUN) -> Array:
    """Radiance (H, 2 H, 3) float32: blue above, orange at the horizon, a low sun, its glow.

    `sun` (3,) points towards it, of any length.

    Args:
        height: H, texels from the zenith to the nadir.
        sun: (3,) towards it.
    """
    w = map_directions(height)
    up = w[..., 1:2]
    sky = np.array(HORIZON) + (np.array(ZENITH) - HORIZON) * np.sqrt(np.clip(up, 0.0, 1.0))
    above = 1.0 / (1.0 + np.exp(-60.0 * up))  # the horizon is soft over a few texels
    radiance = np.array(GROUND) * (1.0 - above) + sky * above
    toward = (w @ (np.asarray(sun) / np.linalg.norm(sun)))[..., None] - 1.0
    for color, sharpness in ((SUN_RADIANCE, SUN_SHARPNESS), (GLOW_RADIANCE, GLOW_SHARPNESS)):
        radiance = radiance + above * np.array(color) * np.exp(sharpness * toward)
    return np.asarray(radiance, np.float32)


# Balls of wax, of colored glass and of smoke: what happens between surfaces.


RADIUS = 0.5


def smoke_densities(n: int = 32) -> npt.NDArray[np.float64]:
    """Billows (n, n, n) from 0 to 1 in a box, thin towards the rim of the ball in it."""
    at = (np.arange(n) + 0.5) / n * 2 - 1
    x, y, z = np.meshgrid(at, at, at, indexing="ij")
    ripples = np.sin(5 * x + 2 * np.sin(3 * y)) + np.sin(6 * y + 2 * np.sin(4 * z))
    ripples = ripples + np.sin(5 * z + 2 * np.sin(5 * x))
    r = np.sqrt(x * x + y * y + z * z)
    densities: npt.NDArray[np.float64] = np.clip(0.35 + 0.35 * ripples, 0.0, 1.0)
    densities *= np.clip(4 * (1 - r), 0.0, 1.0)
    return densities


def wax(size: int = 256) -> Scene:
    """A ball of wax, one of amber glass and one of smoke, lit from behind and above.

    Args:
        size: pixels along an edge of the picture.
    """
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
        # Marble and skin have mean free paths below a millimeter [Jensen2001]; this wax has some
        # of 7 to 11 centimeters, so that light gets through a ball of a meter.
        "wax": Medium([9.0, 11.0, 14.0], [0.998, 0.99, 0.96], values={"g": 0.3}),
        "amber": Medium([0.15, 0.9, 3.2]),
        "smoke": Medium(
            12.0, [0.8, 0.83, 0.88], values={"g": 0.4}, density=DensityGrid(smoke_densities(), box)
        ),
    }
    camera = camera_at([0.0, 1.1, 4.8], [0.0, 0.45, 0.0], 40.0, size, size)
    light = QuadLight([-2.0, 2.8, -2.2], [4.0, 0.0, 0.0], [0.0, 1.0, 1.0], [7.0, 6.4, 5.6])
    sky = Environment(np.array([0.35, 0.45, 0.6]), np.full(3, 0.3), np.full(3, 0.1))
    return Scene("wax", shapes, materials, camera, sky, (light,), media=media)


# A ball that is thrown, a die that turns, a ball of glass that rolls away: motion blur.


def thrown(size: int = 256) -> Scene:
    """Three things that move while the shutter is open, and a copper ball that lies there.

    Args:
        size: pixels along an edge of the picture.
    """
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
    light = QuadLight([-2.6, 3.2, 1.4], [1.6, 0.0, 0.0], [0.0, -0.8, 1.0], [20.0, 18.5, 16.5])
    sky = Environment(np.array([0.3, 0.42, 0.6]), np.full(3, 0.25), np.full(3, 0.1))
    return Scene("thrown", shapes, materials, camera, sky, (light,))


def _turned(degrees: float, about: list[float], shift: list[float]) -> np.ndarray:
    """(4, 4): a turn about the vertical through a point, then a shift, meters."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    matrix = np.array([[c, 0, s, 0], [0, 1, 0, 0], [-s, 0, c, 0], [0, 0, 0, 1.0]])
    matrix[:3, 3] = np.asarray(about) - matrix[:3, :3] @ np.asarray(about) + np.asarray(shift)
    return matrix


# A carved cube, a ring of glass and a figure of clay: signed distance functions.


HALF = float(np.sqrt(0.5))
QUARTER = {"x": (HALF, HALF, 0, 0), "z": (HALF, 0, 0, HALF)}  # turns about an axis


def carved_cube() -> sdf.Shape:
    """A cube with corners cut by a ball, bored along all three axes, 0.5 m to each side."""
    rod = sdf.capsule(0.7, 0.27)
    bores = sdf.union(rod, sdf.placed(rod, quat=QUARTER["x"]), sdf.placed(rod, quat=QUARTER["z"]))
    return sdf.difference(
        sdf.intersection(sdf.rounded_box([0.5] * 3, 0.04), sdf.sphere(0.64)), bores
    )


def figure() -> sdf.Shape:
    """A body, a head and two arms, grown together; 1.1 m high."""
    arm = sdf.capsule(0.2, 0.09)
    arms = sdf.union(
        sdf.placed(arm, [0.33, 0.55, 0.1], [0.92, 0, 0.1, 0.38]),
        sdf.placed(arm, [-0.33, 0.55, 0.1], [0.92, 0, -0.1, -0.38]),
    )
    trunk = sdf.smooth_union(
        sdf.placed(sdf.capsule(0.2, 0.26), [0, 0.4, 0]),
        sdf.placed(sdf.sphere(0.2), [0, 0.9, 0]),
        0.2,
    )
    return sdf.intersection(
        sdf.smooth_union(trunk, arms, 0.18), sdf.placed(sdf.box([2, 1, 2]), [0, 1, 0])
    )


def carved(size: int = 256) -> Scene:
    """A bored cube, a figure of clay and a ring of glass on a table, none of them of triangles.

    Args:
        size: pixels along an edge of the picture.
    """
    turned = sdf.placed(carved_cube(), [-1.05, 0.5, -0.1], [0.94, 0, 0.34, 0])
    ring = sdf.placed(sdf.torus(0.36, 0.15), [1.0, 0.5, 0.2], [0.66, 0.6, 0.3, 0.1])
    shapes = (
        rectangle("table", [-4, 0, 3], [8, 0, 0], [0, 0, -7], "table"),
        SdfShape("cube", turned, "bronze"),
        SdfShape("figure", sdf.placed(figure(), [0.05, 0.0, -0.3]), "clay"),
        SdfShape("ring", ring, "glass"),
    )
    materials = {
        "table": Material("lambert", {"albedo": [0.5, 0.48, 0.45]}),
        "bronze": Material("ggx_metal", {"f0": [0.85, 0.62, 0.4], "roughness": 0.3}),
        "clay": Material("lambert", {"albedo": [0.62, 0.34, 0.24]}),
        "glass": Material("glass", {"eta": 1.5, "tint": [1.0, 1.0, 1.0]}),
    }
    camera = camera_at([0.0, 1.3, 4.6], [0.0, 0.48, 0.0], 33.0, size, size)
    light = QuadLight([-2.6, 3.2, 1.4], [1.6, 0.0, 0.0], [0.0, -0.8, 1.0], [20.0, 18.5, 16.5])
    sky = Environment(np.array([0.3, 0.42, 0.6]), np.full(3, 0.25), np.full(3, 0.1))
    return Scene("carved", shapes, materials, camera, sky, (light,))


# Scenes by name: a Cornell box, a furnace, balls under an evening sky, balls of wax and smoke,


def cornell_box(size: int = 256) -> Scene:
    """A room 2 m wide with a red and a green wall, two boxes and a light in the ceiling.

    Args:
        size: pixels along an edge of the picture.
    """
    shapes = (
        *_room(),
        box("tall", [-0.33, 0.6, -0.28], [0.6, 1.2, 0.6], "white", turn=17.0),
        box("short", [0.33, 0.3, 0.38], [0.6, 0.6, 0.6], "white", turn=-17.0),
    )
    camera = camera_at([0.0, 1.0, 6.8], [0.0, 1.0, 0.0], 19.5, size, size)
    return Scene("cornell-box", shapes, _walls(), camera)


def cornell_spheres(size: int = 256) -> Scene:
    """The same room with a ball of glass and a ball of copper instead of boxes.

    Args:
        size: pixels along an edge of the picture.
    """
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
    """A closed box whose walls all shine and reflect: everywhere L = emission / (1 - albedo).

    Args:
        size: pixels along an edge of the picture.
        albedo: of the walls.
        emission: radiance of the walls.
    """
    walls = box("walls", [0, 0, 0], [2, 2, 2], "wall", [emission] * 3, inward=True)
    camera = camera_at([0.3, 0.1, 0.5], [-1.0, -0.4, -1.0], 60.0, size, size)
    wall = Material("lambert", {"albedo": [albedo] * 3})
    return Scene("furnace-box", (walls,), {"wall": wall}, camera)


def white_ball(size: int = 64) -> Scene:
    """A ball that returns all light, under an even sky: it cannot be seen.

    Args:
        size: pixels along an edge of the picture.
    """
    ball = SphereShape("ball", np.zeros(3), 1.0, "white")
    camera = camera_at([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], 40.0, size, size)
    white = Material("lambert", {"albedo": [1.0, 1.0, 1.0]})
    return Scene("white-ball", (ball,), {"white": white}, camera, Environment.constant(1.0))


def evening(size: int = 256) -> Scene:
    """Balls of clay, copper and glass on a table, lit by an environment map with a low sun.

    Args:
        size: pixels along an edge of the picture.
    """
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


@typed_call
def builtin_scene(name: str, size: int = 256) -> Scene:
    """A scene that needs no file, with a square camera.

    Args:
        name: one of `photograd.transport.builtin.BUILTIN`, such as "cornell-box".
        size: pixels along an edge of its pictures.

    Raises:
        SceneError: no such scene; names the nearest.
        DtypeError, RangeError: size that is no whole number, or below 1.

    Example:
        >>> room = photograd.builtin_scene("cornell-box", 16)
        >>> room.camera.width, "red" in room.materials
        (16, True)
    """
    if name not in BUILTIN:
        known = choose_from(name, BUILTIN)
        raise SceneError(message("builtin_scene", "name", "a built-in scene", name, known))
    Arguments("builtin_scene").integer("size", size, low=1)
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
