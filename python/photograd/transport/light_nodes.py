"""Lights of a scene file: tables [[lights]].

[[lights]]
kind = "point"                # position, intensity (W/sr)
position = [0, 2, 0]
intensity = 10                # a colour: one number, or three

spot          position, axis, intensity, angle (degrees from the axis to the rim), softness (0 to 1)
directional   direction (towards the light), irradiance (W/m^2)
ambient       radiance: the same from everywhere
sky           zenith, horizon, ground: radiances by height
sun           direction, radiance, angle (degrees from the middle to the rim of the disc)
rectangle     corner, edge_x, edge_y (perpendicular), radiance; its front is that of edge_x x edge_y
sphere        center, radius, radiance
triangle      a, b, c (counter-clockwise seen from where it shines), radiance
environment   image (.exr, .hdr or .pfm beside the file, twice as wide as high), and optionally
              turn (degrees around +Y), scale (what radiances are multiplied by), uniform_share
              (0 to 1)
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np

from photograd.images.kind import LINEAR_SUFFIXES
from photograd.images.read import read_radiance
from photograd.lights import EnvironmentMap, Light, about_y
from photograd.lights.distant import cap_height
from photograd.lights.registered import CLASSES, RegisteredLight
from photograd.transport.scene_node import Node


def light_of(node: Node) -> Light:
    """The light that a table describes.

    Raises:
        SceneError: with line and key, whatever is wrong with it.
    """
    kind = node.choice("kind", KINDS)
    light = node.built(lambda: KINDS[kind](node))
    node.refuse_other_keys()
    return light


def _registered(name: str) -> Callable[[Node], RegisteredLight]:
    """Reads the attributes of a light of the registry: colours, places and numbers."""
    light = CLASSES[name]

    def read(node: Node) -> RegisteredLight:
        values: dict[str, object] = {}
        for parameter in light.parameters():
            if parameter.size == 3:
                values[parameter.name] = node.color(parameter.name)
        for parameter in (*light.parameters(), *light.constants()):
            if parameter.name in ANGLES:
                values[parameter.name] = ANGLES[parameter.name](_angle(node))
            elif parameter.name not in values:
                read_one = node.number if parameter.size == 1 else _place(node)
                values[parameter.name] = read_one(parameter.name)
        return light(**values)

    return read


def _place(node: Node) -> Callable[[str], object]:
    return lambda key: node.numbers(key, 3)


def _angle(node: Node) -> float:
    """In radians."""
    degrees = node.number("angle")
    if not 0 < degrees <= 180:
        raise node.wrong("angle", "degrees above 0, at most 180", degrees)
    return math.radians(degrees)


def _environment(node: Node) -> EnvironmentMap:
    path = Path(node.text("image"))
    if path.suffix.lower() not in LINEAR_SUFFIXES:
        raise node.wrong("image", f"a name that ends in {' or '.join(LINEAR_SUFFIXES)}", path)
    scale = node.number("scale", 1.0)
    if scale < 0:
        raise node.wrong("scale", "a number of at least 0", scale)
    texels = read_radiance(node.path.parent / path) * np.float32(scale)
    turn = about_y(math.radians(node.number("turn", 0.0)))
    return EnvironmentMap(texels, turn, node.number("uniform_share", 0.0))


ANGLES: dict[str, Callable[[float], float]] = {"cos_outer": math.cos, "height": cap_height}
"""Attributes that a file gives as `angle`."""

KINDS: dict[str, Callable[[Node], Light]] = {
    **{name: _registered(name) for name in CLASSES if name not in ("constant", "quad")},
    "ambient": _registered("constant"),
    "rectangle": _registered("quad"),
    "environment": _environment,
}
