"""Lights as a frame treats them: light from one direction at each point, and views for its shadows.

Point, spot and directional lights are that already, and are asked as the path tracer asks them. A
surface that emits becomes points on it, and light from infinity becomes directions; more of them
come closer to the integral.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.frame.scene import FrameScene
from photograd.frame.shadows import cone_view, cube_views, parallel_view
from photograd.lights import (
    DirectionalLight,
    Light,
    PointLight,
    QuadLight,
    SkyLight,
    SphereLight,
    SpotLight,
    SunLight,
    TriangleLight,
)
from photograd.transport.core_arrays import camera_numbers
from photograd.transport.scene import Scene
from photograd.types import Array, FloatArray

WIDEST = 0.26
"""Cosine of half the angle up to which one view serves a spot light: 75 degrees."""

GOLDEN_SECTION = 0.6180339887498949


@typed_call
class FrameLight(ABC):
    """Light that reaches each point from one direction.

    Attributes:
        name: of its own.
    """

    name: str

    @property
    def is_parallel(self) -> bool:
        """Whether all points see the same light from the same direction."""
        return False

    @abstractmethod
    def arriving(self, points: Array) -> tuple[Array, Array]:
        """Directions towards the light (N, 3), and irradiance of what faces it (N, 3), W/m^2.

        Args:
            points: (N, 3) in the world.
        """

    @abstractmethod
    def views(self, scene: FrameScene, size: int) -> tuple[Camera, ...]:
        """From which its shadows are drawn.

        Args:
            scene: that is lit.
            size: texels along a side of a shadow map.
        """


@dataclass(frozen=True, eq=False)
class DeltaFrameLight(FrameLight):
    """A point, spot or directional light of a scene."""

    name: str
    light: Light

    @property
    def is_parallel(self) -> bool:
        """Of directions alone."""
        return isinstance(self.light, DirectionalLight)

    def arriving(self, points: Array) -> tuple[Array, Array]:
        """As the path tracer asks it."""
        found = self.light.sample(points, np.full((len(points), 2), 0.5, points.dtype))
        return found.direction, np.where(found.pdf[:, None] > 0, found.radiance, 0)

    def views(self, scene: FrameScene, size: int) -> tuple[Camera, ...]:
        """A cube of a point light, one view of the others."""
        if isinstance(self.light, DirectionalLight):
            direction = self.light.direction
            return (parallel_view(direction, scene.center, scene.radius, size),)
        if isinstance(self.light, SpotLight) and self.light.cos_outer > WIDEST:
            return (cone_view(self.light.position, self.light.axis, self.light.cos_outer, size),)
        assert isinstance(self.light, PointLight | SpotLight)
        return cube_views(np.asarray(self.light.position, np.float64), size)


@dataclass(frozen=True, eq=False)
class SkyDirection(DeltaFrameLight):
    """One of the directions that stand for a light at infinity.

    Attributes:
        name, light: as of others.
        density: samples per steradian around it, of all directions of the light together.
    """

    light: DirectionalLight
    density: float


@dataclass(frozen=True, eq=False)
class PatchLight(FrameLight):
    """A small part of a surface that emits on one side, as a point on it.

    Attributes:
        name: of the surface, and the number of the part.
        position, normal: (3,) each, in the world.
        power: (3,) radiance times area, W/sr along the normal.
        shape: of the core, its number.
        density: points that stand for the surface, per square meter.
    """

    name: str
    position: FloatArray
    normal: FloatArray
    power: FloatArray
    shape: int
    density: float

    def arriving(self, points: Array) -> tuple[Array, Array]:
        """Irradiance falls with the squared distance, and with the cosine at the emitter."""
        away = self.position.astype(points.dtype) - points
        squared = np.maximum((away * away).sum(axis=1, keepdims=True), np.finfo(points.dtype).tiny)
        wi = away / np.sqrt(squared)
        normal, power = self.normal.astype(points.dtype), self.power.astype(points.dtype)
        cosine = np.maximum(-(wi * normal).sum(axis=1, keepdims=True), 0)
        return wi, cosine / squared * power

    def views(self, scene: FrameScene, size: int) -> tuple[Camera, ...]:
        """A cube, from a point just above the surface."""
        return cube_views(self.position + 2 * scene.near * self.normal, size)


def sky_count(light: Light, count: int) -> int:
    """Directions that stand for a light at infinity, where `count` of them are asked for."""
    return 1 if isinstance(light, SunLight) else count


@typed_call
def sky_lights(scene: FrameScene, count: int) -> list[SkyDirection]:
    """Directions towards the lights at infinity, `count` of each, a sun one, by their density.

    Args:
        scene: whose lights and environment are looked at.
        count: directions of a light.
    """
    lights = []
    origin = np.zeros((1, 3))
    for name, light in infinite_lights(scene.scene).items():
        steps = np.arange(sky_count(light, count))
        u2 = np.stack([(steps + 0.5) / len(steps), (0.5 + GOLDEN_SECTION * steps) % 1.0], axis=1)
        found = light.sample(np.repeat(origin, len(steps), axis=0), u2)
        for i in np.flatnonzero(found.pdf > 0):
            density = float(found.pdf[i] * len(steps))
            direction = DirectionalLight(found.direction[i], found.radiance[i] / density)
            lights.append(SkyDirection(f"{name}.{i}", direction, density))
    return lights


@typed_call
def infinite_lights(scene: Scene) -> dict[str, Light]:
    """The lights at infinity, by the names of their radiance among the tracer's params.

    Args:
        scene: whose lights and environment are looked at.
    """
    found: dict[str, Light] = {}
    if scene.environment is not None:
        around = scene.environment
        found["environment"] = SkyLight(around.zenith, around.horizon, around.ground)
    for number, light in enumerate(scene.lights):
        if not light.is_delta and not isinstance(light, QuadLight | SphereLight | TriangleLight):
            found[f"lights.{number}"] = light
    return found


@typed_call
def background(
    scene: Scene, camera: Camera, hidden: Array | None = None, *, dtype: npt.DTypeLike = np.float64
) -> Array:
    """Radiance (H, W, 3) of the lights at infinity, as a camera sees them.

    Args:
        scene: whose lights and environment are looked at.
        camera: of the picture.
        hidden: (H, W) bool, where it is not looked for, and 0; None looks everywhere.
        dtype: float32 or float64, of the directions and the radiance.
    """
    sky = np.zeros((camera.height * camera.width, 3), dtype)
    lights = list(infinite_lights(scene).values())
    open_pixels = np.arange(len(sky)) if hidden is None else np.flatnonzero(~hidden)
    if lights and len(open_pixels):
        directions = np.empty((len(open_pixels), 3), sky.dtype)
        _core.view_directions(camera_numbers(camera), open_pixels, directions)
        origins = np.broadcast_to(camera.position.astype(sky.dtype), directions.shape).copy()
        found = np.zeros_like(directions)
        for light in lights:
            core, leading = light.core_call(sky.dtype)
            found += core.radiance(*leading, origins, directions)
        sky[open_pixels] = found
    return sky.reshape(camera.height, camera.width, 3)


@typed_call
def delta_lights(scene: FrameScene) -> list[FrameLight]:
    """The point, spot and directional lights of a scene."""
    return [
        DeltaFrameLight(f"lights.{number}", light)
        for number, light in enumerate(scene.scene.lights)
        if light.is_delta
    ]


@typed_call
def surface_lights(scene: FrameScene, count: int) -> list[PatchLight]:
    """Points on the surfaces that emit, by their power; textures count by their mean.

    Args:
        scene: whose surfaces are looked at.
        count: of points in all, at least one for each surface.
    """
    numbers = scene.tracer.core_arguments(scene.scene.camera)["emission"].astype(np.float64)
    # Name, number, triangles (T, 3, 3), radiance.
    found: list[tuple[str, int, FloatArray, Array]] = []
    for number, radiance in enumerate(numbers):
        if radiance.any():
            faces = scene.faces[scene.shape == number]
            name = scene.tracer.core_shapes[scene.tracer.core_owner[number]].name
            found.append((name, number, scene.vertices[faces], radiance))
    powers = np.array([_areas(t).sum() * radiance.sum() for _, _, t, radiance in found])
    lights: list[PatchLight] = []
    for (name, number, triangles, radiance), power in zip(found, powers, strict=True):
        share = max(1, round(count * float(power / powers.sum())))
        lights += _patches(name, number, triangles, radiance, share)
    return lights


def _areas(triangles: FloatArray) -> FloatArray:
    edges = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return np.asarray(0.5 * np.linalg.norm(edges, axis=1))


def _patches(
    name: str, shape: int, triangles: FloatArray, radiance: Any, count: int
) -> list[PatchLight]:
    """Points by area, spread evenly: a sequence of low discrepancy over the list of triangles."""
    areas = _areas(triangles)
    ends = np.cumsum(areas)
    lights: list[PatchLight] = []
    density = count / float(ends[-1])
    for i in range(count):
        at = (i + 0.5) / count * ends[-1]
        k = int(min(np.searchsorted(ends, at, side="right"), len(ends) - 1))
        # Within the triangle: the plastic number's sequence [Roberts2018].
        u, v = (0.5 + 0.7548776662466927 * i) % 1.0, (0.5 + 0.5698402909980532 * i) % 1.0
        if u + v > 1.0:
            u, v = 1.0 - u, 1.0 - v
        a, b, c = triangles[k]
        normal = np.cross(b - a, c - a)
        normal /= np.linalg.norm(normal)
        power = np.asarray(radiance) * ends[-1] / count
        point = a + u * (b - a) + v * (c - a)
        lights.append(PatchLight(f"{name}.{i}", point, normal, power, shape, density))
    return lights
