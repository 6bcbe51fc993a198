"""The scenes of docs/heroes.py: a room, caustics, clouds and materials."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd.capture.camera import Camera
from photograd.geometry import sdf
from photograd.lights import DirectionalLight, EnvironmentMap, QuadLight, SpotLight
from photograd.scenes.noise import fractal_noise
from photograd.transport import (
    BOUNDARY,
    Environment,
    Material,
    Medium,
    Scene,
    SdfShape,
    SphereShape,
    Texture,
    TextureUse,
)
from photograd.transport.builtin import camera_at, map_directions
from photograd.transport.medium import DensityGrid
from photograd.transport.shapes import box, rectangle

Array = NDArray[Any]
BALL, STEP = 0.42, 1.12  # m, in the gallery: radius, height of the upper row
AIR = np.array([[-3.85, 1.0, -4.6], [8.0, 2.4, 5.6]])  # m, a corner of the clouds' grid, its size
VOXEL, BRICK = 0.05, 8  # m; voxels along an edge
EXTINCTION = 14.0  # 1/m
SUN = (-0.8, 0.5, -0.05)


@dataclass(frozen=True)
class Hero:
    """A scene, and how it is traced and shown."""

    scene: Callable[[int, int], Scene]
    spp: int
    max_depth: int
    exposure: float = 0.0  # stops
    photon_maps: int = 0
    labels: dict[str, tuple[float, float]] = field(default_factory=dict)


def cornell(width: int, height: int) -> Scene:
    """The Cornell box, as wide as the picture, with two balls."""
    half = 1.77
    shapes = (
        rectangle("floor", [-half, 0, 1], [2 * half, 0, 0], [0, 0, -2.4], "white"),
        rectangle("ceiling", [-half, 2, -1.4], [2 * half, 0, 0], [0, 0, 2.4], "white"),
        rectangle("back", [-half, 0, -1.4], [2 * half, 0, 0], [0, 2, 0], "white"),
        rectangle("left", [-half, 0, 1], [0, 0, -2.4], [0, 2, 0], "red"),
        rectangle("right", [half, 0, -1.4], [0, 0, 2.4], [0, 2, 0], "green"),
        box("tall", [-0.62, 0.62, -0.5], [0.62, 1.24, 0.62], "white", turn=19.0),
        box("short", [0.62, 0.29, 0.05], [0.62, 0.58, 0.62], "white", turn=-18.0),
        SphereShape("ocher ball", np.array([0.6, 0.58 + 0.26, 0.05]), 0.26, "ocher"),
        SphereShape("blue ball", np.array([-0.05, 0.24, 0.5]), 0.24, "blue"),
    )
    materials = {
        "white": Material("lambert", {"albedo": [0.725, 0.71, 0.68]}),
        "red": Material("lambert", {"albedo": [0.63, 0.065, 0.05]}),
        "green": Material("lambert", {"albedo": [0.14, 0.45, 0.091]}),
        "ocher": Material("lambert", {"albedo": [0.62, 0.4, 0.12]}),
        "blue": Material("lambert", {"albedo": [0.12, 0.2, 0.5]}),
    }
    light = QuadLight([-0.55, 1.995, -0.55], [1.1, 0, 0], [0, 0, 0.7], [9.0, 8.2, 6.6])
    camera = camera_at([0.0, 1.0, 6.8], [0.0, 1.0, 0.0], 19.5, width, height)
    return Scene("cornell", shapes, materials, camera, lights=(light,))


def glass(width: int, height: int) -> Scene:
    """A ball, a ring and a rounded cube of glass on a table, in the light of one spot."""
    toward = np.array([0.15, 0.25, -0.1])
    spot = np.array([-2.6, 2.1, -1.7])
    axis = (toward - spot) / np.linalg.norm(toward - spot)
    ring = sdf.placed(sdf.torus(0.36, 0.1), [0.95, 0.1, 0.45], [1, 0, 0, 0])
    cube = sdf.placed(
        sdf.rounded_box([0.2, 0.2, 0.2], 0.05), [-0.75, 0.25, 0.35], [0.9, 0, 0.43, 0]
    )
    shapes = (
        rectangle("table", [-12, 0, 6], [24, 0, 0], [0, 0, -24], "table"),
        SphereShape("ball", np.array([0.0, 0.4, -0.2]), 0.4, "clear"),
        SdfShape("ring", ring, "amber"),
        SdfShape("cube", cube, "green"),
    )
    materials = {
        "table": Material("lambert", {"albedo": [0.72, 0.7, 0.67]}),
        "clear": Material("glass", {"eta": 1.5, "tint": [0.98, 0.99, 1.0]}),
        "amber": Material("glass", {"eta": 1.5, "tint": [1.0, 0.8, 0.45]}),
        "green": Material("glass", {"eta": 1.5, "tint": [0.7, 0.97, 0.8]}),
    }
    light = SpotLight(spot, axis, [30.0, 27.5, 24.0], 0.42, 0.35)
    sky = Environment(np.array([0.10, 0.12, 0.16]), np.full(3, 0.07), np.full(3, 0.02))
    camera = camera_at([0.7, 2.1, 3.3], [0.25, 0.1, 0.12], 27.0, width, height)
    return Scene("glass", shapes, materials, camera, sky, (light,))


def cloud_densities() -> Array:
    """Cumulus clouds in a grid (X, Y, Z) over AIR, 0 to 1."""
    count = np.round(AIR[1] / VOXEL).astype(int)
    axes = [(np.arange(n) + 0.5) * VOXEL for n in count]
    at = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    g = np.random.default_rng(11)
    density = np.full(tuple(count), -1.0)
    for center, wide in (((1.3, 3.6), 1.1), ((3.8, 1.3), 1.5), ((6.6, 3.0), 1.2)):
        for _ in range(16):
            x, z = np.array(center) + g.normal(size=2) * (0.5 * wide, 0.35 * wide)
            radius = wide * g.uniform(0.25, 0.7)
            middle = np.array([x, 0.25 + 0.75 * radius, z])
            reach = np.linalg.norm(at - middle, axis=-1)
            density = np.maximum(density, 1.0 - reach / radius)
    billows = -fractal_noise(at * 2.3, seed=7, octaves=5, gain=0.5, ridged=True)
    flat = np.clip((at[..., 1] - 0.12) / 0.15, 0.0, 1.0)  # clouds are flat below
    found: Array = np.clip((density + 0.6 * billows + 0.1) * 6.0, 0.0, 1.0) * flat
    # Inside it varies as well: where a medium is as dense as it gets everywhere, tracking that has
    # derivatives loses one path of twenty at each collision.
    uneven: Array = 0.72 + 0.28 * fractal_noise(at * 5.0, seed=8, octaves=2, gain=0.5)
    return found * uneven.clip(0.45, 1.0)


def bricks(densities: Array) -> tuple[tuple[Any, ...], dict[str, Medium]]:
    """Boxes around what is not empty, and the medium in each.

    Where a medium is thin, delta tracking keeps drawing collisions that are none; small boxes leave
    out nearly all of that.
    """
    padded = np.pad(densities, 1)
    shapes: list[Any] = []
    media: dict[str, Medium] = {}
    for corner in np.ndindex(*(-(-np.array(densities.shape) // BRICK))):
        first = np.array(corner) * BRICK
        last = np.minimum(first + BRICK, densities.shape)
        part = padded[tuple(slice(a, b + 2) for a, b in zip(first, last, strict=True))]
        if part.max() <= 0:
            continue
        placed = np.eye(4)
        placed[[0, 1, 2], [0, 1, 2]] = (last - first + 2) * VOXEL
        placed[:3, 3] = AIR[0] + (first - 1) * VOXEL
        name = f"cloud {len(media)}"
        media[name] = Medium(
            EXTINCTION, 0.9995, values={"g": 0.6}, density=DensityGrid(part, placed)
        )
        middle = AIR[0] + (first + last) / 2 * VOXEL
        size = (last - first) * VOXEL - 4e-3  # faces of neighbors are apart
        shapes.append(replace(box(name, middle, size, BOUNDARY), interior=name))
    return tuple(shapes), media


def clouds(width: int, height: int) -> Scene:
    """Cumulus over fields in the light of a low sun, with every order of scattering."""
    boxes, media = bricks(cloud_densities())
    shapes = (rectangle("field", [-60, 0, 20], [120, 0, 0], [0, 0, -140], "field"), *boxes)
    materials = {"field": Material("lambert", {"albedo": [0.1, 0.14, 0.06]})}
    sky = Environment(
        np.array([0.03, 0.10, 0.34]), np.array([0.26, 0.38, 0.56]), np.array([0.1, 0.1, 0.1])
    )
    sun = DirectionalLight(SUN, [7.5, 5.9, 4.2])
    camera = camera_at([0.0, 0.7, 6.6], [0.0, 2.0, 0.0], 28.0, width, height)
    return Scene("clouds", shapes, materials, camera, sky, (sun,), media=media)


def studio() -> Array:
    """A bright room with three softboxes, radiance (H, 2 H, 3)."""
    w = map_directions(128)
    up = w[..., 1:2]
    found = 0.42 + 0.4 * np.clip(up, 0, 1) + np.zeros(3)
    for side, width, level in ((-0.75, 0.24, 9.0), (0.35, 0.3, 4.5), (0.95, 0.12, 6.0)):
        across = np.abs(np.arctan2(w[..., :1], w[..., 2:3]) / np.pi - side) < width / 2
        found = found + level * (across & (up > 0.15) & (up < 0.8))
    return np.asarray(found, np.float32)


def gallery_materials() -> dict[str, tuple[str, Material]]:
    """What each ball is of, by the name that is written below it."""
    painted = {"base_color": [0.62, 0.03, 0.03], "metalness": 0.0, "roughness": 0.4}
    coated = {**painted, "coat": 1.0, "coat_roughness": 0.05}
    thin = {"iridescence_factor": 1.0, "iridescence_ior": 1.8, "iridescence_thickness": 420.0}
    cloth = {"sheen_color_factor": [0.9, 0.75, 1.0], "sheen_roughness_factor": 0.4}
    velvet = {"base_color": [0.16, 0.05, 0.28], "metalness": 0.0, "roughness": 0.9}
    dark = {"base_color": [0.55, 0.55, 0.6], "metalness": 1.0, "roughness": 0.2}
    gold = {"base_color": [1.0, 0.77, 0.34], "metalness": 1.0}
    clear = {"base_color": [1, 1, 1], "metalness": 0.0, "transmission": 1.0, "eta": 1.5}
    return {
        "plastic": ("plastic", Material("gltf", {**painted, "base_color": [0.05, 0.22, 0.55]})),
        "coat": ("clear coat", Material("clearcoat", coated)),
        "sheen": ("sheen", Material("gltf_sheen", {**velvet, **cloth})),
        "film": ("iridescence", Material("gltf_iridescence", {**dark, **thin})),
        "gold": ("metal, 0.1", Material("gltf", {**gold, "roughness": 0.1})),
        "satin": ("metal, 0.4", Material("gltf", {**gold, "roughness": 0.4})),
        "glass": ("glass", Material("glass", {"eta": 1.5, "tint": [0.97, 1.0, 0.98]})),
        "frosted": ("frosted glass", Material("gltf_refraction", {**clear, "roughness": 0.25})),
    }


def gallery(width: int, height: int) -> Scene:
    """Eight balls of glTF's materials, one row on the floor and one on a step, in a studio."""
    materials = {name: material for name, (_, material) in gallery_materials().items()}
    squares = np.indices((4, 64)).sum(axis=0)[..., None] % 2
    checks = np.where(squares > 0, [0.62, 0.6, 0.55], [0.06, 0.1, 0.16])
    shapes: list[Any] = [
        rectangle("floor", [-12, 0, 8], [24, 0, 0], [0, 0, -20], "paper"),
        box("step", [0, STEP / 2, -1.6], [24, STEP, 2.2], "paper"),
        rectangle("panel", [-6, 0, -0.499], [12, 0, 0], [0, 0.75, 0], "checks"),
    ]
    for name, place in zip(materials, _places(), strict=True):
        shapes.append(SphereShape(name, place, BALL, name))
    materials["paper"] = Material("lambert", {"albedo": [0.72, 0.72, 0.74]})
    materials["checks"] = Material(
        "lambert", {"albedo": [1.0] * 3}, {"albedo": TextureUse("checks")}
    )
    textures = {"checks": Texture(np.repeat(np.repeat(checks, 16, axis=0), 16, axis=1))}
    camera = _gallery_camera(width, height)
    lights = (EnvironmentMap(studio()),)
    return Scene("gallery", tuple(shapes), materials, camera, lights=lights, textures=textures)


def _gallery_camera(width: int, height: int) -> Camera:
    """A little above the balls."""
    return camera_at([0.0, 1.55, 8.2], [0.0, 0.9, 0.0], 18.6, width, height)


def _places() -> list[Array]:
    """Centers of the eight balls, (3,) each."""
    return [
        np.array([(column - 1.5) * 1.15, BALL + STEP * (1 - row), -1.0 + row])
        for row in range(2)
        for column in range(4)
    ]


def _names() -> dict[str, tuple[float, float]]:
    """Places of the names in the picture, below the balls, as fractions."""
    camera, found = _gallery_camera(1600, 900), {}
    for (name, _), center in zip(gallery_materials().values(), _places(), strict=True):
        at = np.linalg.solve(camera.world_from_camera, [*(center - [0, BALL, 0]), 1.0])
        down = 0.05 if center[2] < -0.5 else 0.075
        x, y = camera.fx * at[0] / at[2] + camera.cx, camera.fy * at[1] / at[2] + camera.cy
        found[name] = (x / camera.width, y / camera.height + down)
    return found


SCENES = {
    "cornell": Hero(cornell, spp=384, max_depth=12, exposure=0.7),
    "caustics": Hero(glass, spp=128, max_depth=24, photon_maps=64, exposure=0.6),
    "clouds": Hero(clouds, spp=256, max_depth=200, exposure=0.4),
    "materials": Hero(gallery, spp=192, max_depth=16, labels=_names()),
}
