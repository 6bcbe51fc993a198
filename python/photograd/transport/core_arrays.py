"""A scene's instances, textures and lights as the core takes them.

A light with a surface becomes a shape that emits, since rays have to hit it. All others stay
lights: a row of parameters each, or the texels of an environment map.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd.capture.camera import Camera
from photograd.lights import (
    EnvironmentMap,
    Light,
    QuadLight,
    RegisteredLight,
    SkyLight,
    SphereLight,
    TriangleLight,
)
from photograd.transport.material import Material
from photograd.transport.scene import Environment, Scene
from photograd.transport.shapes import MeshShape, Shape, SphereShape, rectangle
from photograd.transport.texture import WRAPS
from photograd.types import Array

Layout = tuple[int, int, int, int, int, bool]
Use = tuple[int, int, int, int, float, float]
BentNormals = tuple[Array, int, int]
BRUSHES = ("anisotropy", "anisotropic")
"""Parameters by which a model looks different when its frame is turned."""


def camera_numbers(camera: Camera) -> tuple[Any, ...]:
    """Width, height, intrinsics in pixels, and the rows of world_from_camera.

    Args:
        camera: of a picture.
    """
    pose = camera.world_from_camera[:3].tolist()
    return camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy, pose


def instances_of(meshes: Sequence[MeshShape]) -> tuple[Array, Array]:
    """Mesh numbers (I,) int32 and world_from_object (I, 3, 4) float64 of all instances.

    Args:
        meshes: of the scene.
    """
    numbers: list[int] = []
    matrices: list[Array] = []
    for number, mesh in enumerate(meshes):
        instances = mesh.instances or (np.eye(4),)
        numbers += [number] * len(instances)
        matrices += [instance[:3] for instance in instances]
    return np.array(numbers, np.int32), np.array(matrices, np.float64).reshape(-1, 3, 4)


def textures_of(
    scene: Scene,
) -> tuple[list[Layout], list[list[Use]], list[BentNormals | None], list[bool]]:
    """Layouts of the textures; of each material what they scale, its normal map, and whether it is
    brushed: the first axis of its frame then runs along growing u.

    Args:
        scene: whose textures and materials are listed.
    """
    order = {name: number for number, name in enumerate(scene.textures)}
    layouts = [
        (*texture.values.shape, *_wrap(texture.wrap), texture.filter == "mip")
        for texture in scene.textures.values()
    ]
    uses = [_uses(material, order) for material in scene.materials.values()]
    maps = [_bent(material) for material in scene.materials.values()]
    directed = [
        any(parameter.name in BRUSHES for parameter in material.parameters)
        for material in scene.materials.values()
    ]
    return layouts, uses, maps, directed


def cutoffs_of(scene: Scene) -> list[float]:
    """Of each material that is a mask; -1 for all others.

    Args:
        scene: whose materials are listed.
    """
    cutoffs = [material.alpha_cutoff for material in scene.materials.values()]
    return [-1.0 if cutoff is None else cutoff for cutoff in cutoffs]


def glows_of(scene: Scene, shapes: Sequence[Shape]) -> list[tuple[int, int]]:
    """Of each of the `shapes` the texture of `scene` that scales its emission, and the channel."""
    order = {name: number for number, name in enumerate(scene.textures)}
    uses = [getattr(shape, "emission_texture", None) for shape in shapes]
    return [(-1, 0) if use is None else (order[use.texture], use.channel) for use in uses]


def mean_emission(scene: Scene, shape: Shape) -> Array:
    """Radiance (3,) of a shape, over its texture: how often it is asked as a light.

    Args:
        scene: that has its texture.
        shape: of the scene.
    """
    use = getattr(shape, "emission_texture", None)
    if use is None:
        return shape.emission
    channels = scene.textures[use.texture].values[..., use.channel : use.channel + 3]
    return np.asarray(shape.emission * channels.mean(axis=(0, 1), dtype=np.float64))


def _uses(material: Material, order: dict[str, int]) -> list[Use]:
    """Sorted by texture: a lookup serves all parameters that it scales."""
    found: list[Use] = []
    first = 0
    for parameter in material.parameters:
        use = material.textures.get(parameter.name)
        if use is not None:
            row = (order[use.texture], use.channel, first, parameter.size)
            found.append((*row, parameter.lo, parameter.hi))
        first += parameter.size
    return sorted(found)


def _bent(material: Material) -> BentNormals | None:
    bent = material.normal_map
    return None if bent is None else (bent.values, *_wrap(bent.wrap))


def _wrap(wrap: tuple[str, str]) -> tuple[Any, ...]:
    return WRAPS.index(wrap[0]), WRAPS.index(wrap[1])


def blocks_of(arguments: dict[str, Any]) -> dict[str, Array]:
    """The arrays of a scene that have derivatives, by the names of the core's blocks.

    Those of cpp/photograd/scene/gradient.h: "parameters", "emission", "lights.0", "textures.0",
    "media.0", "densities.0" and so on.

    Args:
        arguments: what the core takes of the scene.
    """
    blocks = {name: arguments[name] for name in ("parameters", "emission")}
    blocks |= {f"lights.{i}": row[1] for i, row in enumerate(arguments["lights"])}
    blocks |= {f"textures.{i}": texels for i, texels in enumerate(arguments["textures"])}
    for i, (_, row, density, _) in enumerate(arguments["media"]):
        blocks[f"media.{i}"] = row
        if density is not None:
            blocks[f"densities.{i}"] = density
    return blocks


# The lights of a scene's list as the core takes them.


SURFACES = (QuadLight, SphereLight, TriangleLight)


@dataclass(frozen=True, eq=False)
class PackedLight:
    """A light without a surface.

    Attributes:
        light: where it is, and what it sends when the tracer is built.
        start: {name among the tracer's params: array}, in the order in which the core packs them.
    """

    light: RegisteredLight | EnvironmentMap
    start: Mapping[str, Array]

    def row(self, params: Mapping[str, Array], dtype: npt.DTypeLike) -> tuple[Any, ...]:
        """For the core: (name, parameters, constants), or a map's texels, rotation and sampler.

        Args:
            params: of the tracer.
            dtype: of the computation.

        Raises:
            ShapeError: params of another shape than at the start.
        """
        call = Arguments("PathTracer", dtype)
        parts = [
            call.array(name, params[name], value.shape, finite=False)
            for name, value in self.start.items()
        ]
        core, (_, constants) = self.light.core_call(dtype)
        if isinstance(self.light, EnvironmentMap):
            return "environment", parts[0], constants, core
        return self.light.core_name, np.concatenate([part.ravel() for part in parts]), constants

    def named(self, derivative: Array) -> dict[str, Array]:
        """A derivative with respect to the second entry of `row`, under the names of the params."""
        ends = np.cumsum([value.size for value in self.start.values()])[:-1]
        parts = np.split(derivative.reshape(-1), ends)
        return {
            name: part.reshape(value.shape)
            for (name, value), part in zip(self.start.items(), parts, strict=True)
        }


def packed_lights(scene: Scene) -> list[PackedLight]:
    """The environment, if there is one, and the lights of the list that have no surface.

    Args:
        scene: whose lights are listed.
    """
    found = [_dome(scene.environment)] if scene.environment is not None else []
    for i, light in enumerate(scene.lights):
        if isinstance(light, SURFACES):
            continue
        if isinstance(light, EnvironmentMap):
            found.append(PackedLight(light, {f"lights.{i}.texels": light.texels}))
        else:
            assert isinstance(light, RegisteredLight)
            values = {
                f"lights.{i}.{parameter.name}": np.asarray(getattr(light, parameter.name))
                for parameter in light.parameters()
            }
            found.append(PackedLight(light, values))
    return found


def light_shapes(scene: Scene) -> dict[str, Shape]:
    """{name of the radiance among the params: the shape that emits it}; materials are unnamed.

    Args:
        scene: whose lights are listed.
    """
    return {
        f"lights.{i}.radiance": _shape(f"lights.{i}", light)
        for i, light in enumerate(scene.lights)
        if isinstance(light, SURFACES)
    }


def _dome(environment: Environment) -> PackedLight:
    colors = np.array([environment.zenith, environment.horizon, environment.ground])
    return PackedLight(SkyLight(*colors), {"environment": colors})


def _shape(name: str, light: Light) -> Shape:
    if isinstance(light, QuadLight):
        return rectangle(name, light.corner, light.edge_x, light.edge_y, "", light.radiance)
    if isinstance(light, SphereLight):
        center, emission = np.asarray(light.center), np.asarray(light.radiance)
        return SphereShape(name, center, light.radius, "", emission)
    assert isinstance(light, TriangleLight)
    corners = np.array([light.a, light.b, light.c], np.float64)
    return MeshShape(name, corners, np.array([[0, 1, 2]]), "", np.asarray(light.radiance))
