"""Lights of a glTF file, and ours as glTF has them: KHR_lights_punctual [Khronos2022].

    point         intensity I, candela    irradiance I cos / r^2
    spot          intensity I, candela    the same times s: 1 within innerConeAngle, 0 beyond outer
    directional   intensity E, lux        irradiance E cos

All are times a linear color and shine along -Z of their node, whose scale changes no number.
Candela and lux are taken as W/sr and W/m^2, as nits of emissive surfaces are as W/(m^2 sr): lights
keep their ratios. `range` is no property of light and is left out, with a note.

Between its two angles the extension leaves the fall of a spot's light to the reader: it proposes
t^2 in the cosine's share t = (cos - cos outer) / (cos inner - cos outer); ours is t^2 (3 - 2 t)
(cpp/photograd/light/spot_light.h), which passes a half of the light of the rim, not a third.

    h = 1 - cos = 2 sin^2(angle / 2),     softness = 1 - h_inner / h_outer
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from photograd._json_node import JsonNode
from photograd.capture.frames import MAX_COORDINATE
from photograd.errors import IoError, message
from photograd.lights import DirectionalLight, Light, PointLight, SpotLight
from photograd.transport.mesh_files.container import NAME, Container, real, whole
from photograd.transport.mesh_files.nodes import NodeTransform
from photograd.types import Array

LIGHTS = "KHR_lights_punctual"
KINDS = ("point", "spot", "directional")
BRIGHTEST = 1e30
NARROWEST = 1e-3
"""Radians: cosines of smaller angles are 1 in single precision."""
_OUTER = np.pi / 4  # where a file gives none
_ROUNDED = 1e-6  # a right angle in single precision is a little larger than one
_HARDEST = 1e-6  # the least softness: angles that differ by less have the same cosine


def read_lights(
    container: Container, nodes: Sequence[NodeTransform], note: Callable[[str], None]
) -> tuple[Light, ...]:
    """One for each node that has a light; `note` takes ranges, and lights that are out of reach.

    Args:
        container: the file.
        nodes: with their transforms.
        note: called with sentences.

    Raises:
        IoError, RangeError: values that no light of the extension has, by node or light.
    """
    table: list[JsonNode] | None = None
    found: list[Light] = []
    for node, world in nodes:
        if "extensions" not in node or LIGHTS not in node["extensions"]:
            continue
        if table is None:
            table = _table(container.root)
        number = whole(node["extensions"][LIGHTS], 0, len(table) - 1, "light")
        light = _placed(table[number], world, note)
        if light is None:
            note(f"{node.where}: a light without direction or out of reach, left out")
        else:
            found.append(light)
    return tuple(found)


def _table(root: JsonNode) -> list[JsonNode]:
    if "extensions" not in root or LIGHTS not in root["extensions"]:
        return []
    return root["extensions"][LIGHTS]["lights"].items()


def _placed(light: JsonNode, world: Array, note: Callable[[str], None]) -> Light | None:
    """A light at its node, or None if it cannot stand there."""
    kind = light["type"].text()
    if kind not in KINDS:
        raise IoError(message(NAME, light["type"].where, f"one of {', '.join(KINDS)}", kind[:60]))
    strength = _strength(light)
    if "range" in light:
        note(f"{light.where}: range: left out: light falls with the square of distance alone")
    back, position = world[:3, 2], world[:3, 3]
    shape = _cone(light) if kind == "spot" else None
    if not np.isfinite(world).all() or np.abs(position).max() > MAX_COORDINATE:
        return None
    if kind == "point":
        return PointLight(position, strength)
    length = np.linalg.norm(back)
    if not 0 < length < np.inf:
        return None
    if shape is None:
        return DirectionalLight(back / length, strength)
    return SpotLight(position, -back / length, strength, *shape)


def _strength(light: JsonNode) -> Array:
    """(3,): intensity times color."""
    intensity = real(light, "intensity", 1.0)
    if not 0 <= intensity < BRIGHTEST:
        where, expected = f"{light.where}: intensity", f"a number from 0 to {BRIGHTEST:g}"
        raise IoError(message(NAME, where, expected, intensity))
    color = light["color"].numbers((3,)) if "color" in light else np.ones(3)
    if not (color.min() >= 0 and color.max() <= 1):
        where, expected = f"{light.where}: color", "three numbers from 0 to 1"
        raise IoError(message(NAME, where, expected, color.tolist()))
    return np.asarray(intensity * color)


def _cone(light: JsonNode) -> tuple[float, float]:
    """cos_outer and softness."""
    spot = light["spot"] if "spot" in light else JsonNode(NAME, f"{light.where}: spot", {})
    if not isinstance(spot.value, dict):
        raise spot.wrong("an object")
    inner, outer = real(spot, "innerConeAngle", 0.0), real(spot, "outerConeAngle", _OUTER)
    if not NARROWEST <= outer <= np.pi / 2 + _ROUNDED:
        where, expected = f"{spot.where}: outerConeAngle", f"radians from {NARROWEST} to pi / 2"
        raise IoError(message(NAME, where, expected, outer))
    if not 0 <= inner < outer:
        where, expected = f"{spot.where}: innerConeAngle", f"radians from 0 to below {outer:.6g}"
        raise IoError(message(NAME, where, expected, inner))
    within, whole_cone = _height(inner), _height(outer)
    return 1 - whole_cone, max(1 - within / whole_cone, _HARDEST)


def _height(angle: float) -> float:
    """1 - cos(angle), without loss of digits."""
    return 2 * float(np.sin(0.5 * angle)) ** 2


def gltf_light(light: Light) -> tuple[dict[str, Any], list[float]] | None:
    """An entry of the table of lights, and the matrix of its node; None if glTF lacks its kind.

    Args:
        light: to be written.
    """
    if not isinstance(light, DirectionalLight | PointLight | SpotLight):
        return None
    strength = light.irradiance if isinstance(light, DirectionalLight) else light.intensity
    if np.max(strength) > BRIGHTEST / 2:  # the power of two above it would not be read
        return None
    if isinstance(light, DirectionalLight):
        return _entry("directional", light.irradiance), _matrix(light.direction, np.zeros(3))
    if isinstance(light, PointLight):
        return _entry("point", light.intensity), _matrix([0.0, 0.0, 1.0], light.position)
    whole_cone = 1 - light.cos_outer
    outer, inner = _angle(whole_cone), _angle((1 - light.softness) * whole_cone)
    if not NARROWEST <= outer <= np.pi / 2 + _ROUNDED:
        return None
    entry = _entry("spot", light.intensity)
    entry["spot"] = {"innerConeAngle": inner, "outerConeAngle": outer}
    return entry, _matrix(-np.asarray(light.axis, np.float64), light.position)


def _angle(height: float) -> float:
    return 2 * float(np.arcsin(min(np.sqrt(0.5 * height), 1.0)))


def _entry(kind: str, strength: Any) -> dict[str, Any]:
    """The intensity is a power of two, so that its product with the color is exact."""
    color = np.asarray(strength, np.float64)
    largest = float(color.max())
    intensity = max(1.0, 2.0 ** float(np.ceil(np.log2(largest)))) if largest > 0 else 1.0
    return {"type": kind, "intensity": intensity, "color": (color / intensity).tolist()}


def _matrix(back: Any, position: Any) -> list[float]:
    """By columns, of a node whose -Z looks away from `back`, a unit vector."""
    z = np.asarray(back, np.float64)
    x = np.cross(np.eye(3)[int(np.argmin(np.abs(z)))], z)
    x /= np.linalg.norm(x)
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2] = x, np.cross(z, x), z
    matrix[:3, 3] = position
    return list(matrix.T.ravel().tolist())
