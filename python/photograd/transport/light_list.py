"""The lights of a scene's list as the core takes them.

A light with a surface becomes a shape that emits, since rays have to hit it. All others stay
lights: a row of parameters each, or the texels of an environment map.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from photograd.errors import ShapeError, message
from photograd.lights import (
    EnvironmentMap,
    Light,
    QuadLight,
    RegisteredLight,
    SkyLight,
    SphereLight,
    TriangleLight,
)
from photograd.transport.scene import Environment, MeshShape, Scene, Shape, SphereShape
from photograd.transport.shapes import rectangle
from photograd.types import Array

SURFACES = (QuadLight, SphereLight, TriangleLight)


@dataclass(frozen=True, eq=False)
class ListedLight:
    """A light without a surface.

    Attributes:
        light: where it is, and what it sends when the tracer is built.
        start: {name among the tracer's params: array}, in the order in which the core packs them.
    """

    light: RegisteredLight | EnvironmentMap
    start: Mapping[str, Array]

    def row(self, params: Mapping[str, Array], dtype: npt.DTypeLike) -> tuple[Any, ...]:
        """For the core: (name, parameters, constants), or a map's texels, rotation and sampler.

        Raises:
            ShapeError: params of another shape than at the start.
        """
        for name, value in self.start.items():
            if np.shape(params[name]) != value.shape:
                got = np.shape(params[name])
                raise ShapeError(message("PathTracer", name, f"shape {value.shape}", got))
        core, (_, constants) = self.light.core_call(dtype)
        if isinstance(self.light, EnvironmentMap):
            (name,) = self.start
            return "environment", np.ascontiguousarray(params[name], dtype), constants, core
        parts = [np.reshape(params[name], -1) for name in self.start]
        return self.light.core_name, np.concatenate(parts).astype(dtype), constants

    def named(self, derivative: Array) -> dict[str, Array]:
        """A derivative by the second entry of `row`, under the names of the params."""
        ends = np.cumsum([value.size for value in self.start.values()])[:-1]
        parts = np.split(derivative.reshape(-1), ends)
        return {
            name: part.reshape(value.shape)
            for (name, value), part in zip(self.start.items(), parts, strict=True)
        }


def listed_lights(scene: Scene) -> list[ListedLight]:
    """The environment, if there is one, and the lights of the list that have no surface."""
    found = [_dome(scene.environment)] if scene.environment is not None else []
    for i, light in enumerate(scene.lights):
        if isinstance(light, SURFACES):
            continue
        if isinstance(light, EnvironmentMap):
            found.append(ListedLight(light, {f"lights.{i}.texels": light.texels}))
        else:
            assert isinstance(light, RegisteredLight)
            values = {
                f"lights.{i}.{parameter.name}": np.asarray(getattr(light, parameter.name))
                for parameter in light.parameters()
            }
            found.append(ListedLight(light, values))
    return found


def light_shapes(scene: Scene) -> dict[str, Shape]:
    """{name of the radiance among the params: the shape that emits it}; materials are unnamed."""
    return {
        f"lights.{i}.radiance": _shape(f"lights.{i}", light)
        for i, light in enumerate(scene.lights)
        if isinstance(light, SURFACES)
    }


def _dome(environment: Environment) -> ListedLight:
    colors = np.array([environment.zenith, environment.horizon, environment.ground])
    return ListedLight(SkyLight(*colors), {"environment": colors})


def _shape(name: str, light: Light) -> Shape:
    if isinstance(light, QuadLight):
        return rectangle(name, light.corner, light.edge_x, light.edge_y, "", light.radiance)
    if isinstance(light, SphereLight):
        center, emission = np.asarray(light.center), np.asarray(light.radiance)
        return SphereShape(name, center, light.radius, "", emission)
    assert isinstance(light, TriangleLight)
    corners = np.array([light.a, light.b, light.c], np.float64)
    return MeshShape(name, corners, np.array([[0, 1, 2]]), "", np.asarray(light.radiance))
