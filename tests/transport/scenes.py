"""Small scenes for the proofs of path tracing."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd.capture.camera import Camera
from photograd.transport import Environment, Material, MeshShape, PathTracer, Scene, SphereShape
from photograd.transport.builtin import camera_at, cornell_box
from photograd.transport.material import MODELS
from photograd.transport.shapes import rectangle

Array = Any
FLOOR = ([-2, 0, 2], [4, 0, 0], [0, 0, -4])  # y = 0, faces up
LAMP = ([-0.6, 1.5, -0.6], [1.2, 0, 0], [0, 0, 1.2])  # y = 1.5, faces down
GRAY = Material("lambert", {"albedo": [0.5, 0.5, 0.5]})
BLACK = Material("lambert", {"albedo": [0.0, 0.0, 0.0]})


def view(size: int = 8, position: Any = (0.0, 1.2, 3.0), target: Any = (0.0, 0.2, 0.0)) -> Camera:
    return camera_at(position, target, 40.0, size, size)


def stage(
    material: Material,
    *,
    size: int = 8,
    lamp: float = 4.0,
    sky: float | None = None,
    ball: bool = True,
    floor: Material = GRAY,
) -> Scene:
    """A ball of a material on a gray floor, under a square light and perhaps an even sky."""
    shapes: list[Any] = [rectangle("floor", *FLOOR, "floor")]
    if ball:
        shapes.append(SphereShape("ball", np.array([0.0, 0.5, 0.0]), 0.5, "ball"))
    if lamp:
        shapes.append(rectangle("lamp", *LAMP, "black", [lamp, 0.9 * lamp, 0.8 * lamp]))
    materials = {"floor": floor, "ball": material, "black": BLACK}
    environment = None if sky is None else Environment.constant(sky)
    return Scene("stage", tuple(shapes), materials, view(size), environment)


def any_material(model: str, fraction: float = 0.6) -> Material:
    """A model at a fraction of the range of its parameters."""
    values: dict[str, Any] = {}
    for parameter in MODELS[model].parameters:
        spread = np.linspace(0.9, 1.1, parameter.size) if parameter.size > 1 else np.ones(1)
        value = parameter.lo + (parameter.hi - parameter.lo) * fraction * spread
        values[parameter.name] = value if parameter.size > 1 else float(value[0])
    if "dispersion" in values and "metalness" in values:
        values |= {"metalness": 0.1, "transmission": 0.9}  # else hardly a path goes through
    return Material(model, values)


def bent_floor(size: int = 8, tilt: float = 60.0) -> Scene:
    """A white floor whose shading normals lean by up to `tilt` degrees, under an even sky of 1."""
    n = 9
    x, z = np.meshgrid(np.linspace(-2, 2, n), np.linspace(-2, 2, n), indexing="ij")
    vertices = np.stack([x, np.zeros_like(x), z], axis=-1).reshape(-1, 3)
    corner = np.arange(n * n).reshape(n, n)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    faces = np.concatenate(
        [np.stack([a, d, c], -1).reshape(-1, 3), np.stack([a, c, b], -1).reshape(-1, 3)]
    )
    g = np.random.default_rng(4)
    lean, turn = np.radians(g.uniform(0, tilt, n * n)), g.uniform(0, 2 * np.pi, n * n)
    normals = np.stack(
        [np.sin(lean) * np.cos(turn), np.cos(lean), np.sin(lean) * np.sin(turn)], axis=-1
    )
    white = Material("lambert", {"albedo": [1.0, 1.0, 1.0]})
    floor = MeshShape("floor", vertices, faces, "white", normals=normals)
    camera = view(size, (0.0, 0.4, 2.5), (0.0, 0.0, 0.0))
    return Scene("bent", (floor,), {"white": white}, camera, Environment.constant(1.0))


def rough_dielectric_stage() -> Scene:
    return stage(Material("rough_dielectric", {"eta": 1.5, "roughness": 0.4}), sky=0.3)


def globe_light() -> Scene:
    """A shining ball above a glossy floor."""
    shapes = (
        rectangle("floor", *FLOOR, "gloss"),
        SphereShape("globe", np.array([0.3, 0.9, -0.4]), 0.4, "black", np.array([3.0, 2.0, 1.0])),
    )
    gloss = Material("ggx_metal", {"f0": [0.9, 0.8, 0.7], "roughness": 0.35})
    return Scene("globe", shapes, {"gloss": gloss, "black": BLACK}, view(8))


STRATEGY_SCENES = {
    "lamp": lambda: stage(GRAY),
    "lamp and sky": lambda: stage(any_material("gltf"), sky=0.5),
    "sky alone": lambda: stage(any_material("oren_nayar_qualitative"), lamp=0.0, sky=1.0),
    "shining ball": globe_light,
    "frosted glass": rough_dielectric_stage,
    "smooth glass": lambda: stage(Material("glass", {"eta": 1.5, "tint": [0.9, 1.0, 0.95]})),
    "mirror": lambda: stage(Material("mirror", {"reflectance": [0.9, 0.8, 0.7]}), sky=0.2),
    "bent normals": bent_floor,
    "room": lambda: cornell_box(8),
}


def picture_and_gradients(scene: Scene, spp: int) -> list[Any]:
    """Radiance, its squares, and the gradients of a random cotangent; without what is empty."""
    tracer = PathTracer(scene)
    sums = tracer.render(spp=spp, seed=9)
    d = np.random.default_rng(8).uniform(-1, 1, sums.radiance.shape)
    gradient = tracer.render_backward(d, spp=spp, seed=9)
    return [sums.radiance, sums.squares, *gradient.values()]
