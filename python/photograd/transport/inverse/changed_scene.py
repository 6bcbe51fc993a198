"""A scene with other numbers: what was found, or where lights are to be asked anew."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from photograd.lights import EnvironmentMap, Light
from photograd.transport.scene import Environment, Scene


def scene_with(scene: Scene, params: Mapping[str, Any]) -> Scene:
    """The scene with parameters changed.

    Args:
        scene: stays as it is.
        params: some of those of `PathTracer.params`, by their names; the others stay.

    Raises:
        RangeError, ShapeError: values that the scene's parts refuse.
    """
    changed: dict[str, dict[str, Any]] = {}
    for name, value in params.items():
        kind, _, rest = name.partition(".")
        changed.setdefault(kind, {})[rest] = value
    materials = dict(scene.materials)
    for path, value in changed.get("materials", {}).items():
        name, _, parameter = path.rpartition(".")
        values = {**materials[name].values, parameter: np.asarray(value, np.float64)}
        materials[name] = replace(materials[name], values=values)
    textures = dict(scene.textures)
    for name, values in changed.get("textures", {}).items():
        textures[name] = replace(textures[name], values=np.asarray(values, np.float32))
    shining = {name: np.asarray(value) for name, value in changed.get("emission", {}).items()}
    shapes = tuple(
        replace(shape, emission=shining[shape.name]) if shape.name in shining else shape
        for shape in scene.shapes
    )
    environment = scene.environment
    if "environment" in changed:
        environment = Environment(*np.asarray(changed["environment"][""], np.float64))
    lights = list(scene.lights)
    for path, value in changed.get("lights", {}).items():
        number, _, parameter = path.partition(".")
        lights[int(number)] = _light_with(lights[int(number)], parameter, value)
    return replace(
        scene, shapes=shapes, materials=materials, environment=environment,
        lights=tuple(lights), textures=textures,
    )  # fmt: skip


def _light_with(light: Light, parameter: str, value: Any) -> Light:
    if isinstance(light, EnvironmentMap):
        value = np.asarray(value, light.texels.dtype)
    changed: Light = replace(light, **{parameter: value})  # type: ignore[type-var]
    return changed
