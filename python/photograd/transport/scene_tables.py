"""Lights and media of a scene file: tables [[lights]] and [media.NAME] (docs/scene_file.md)."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from photograd.bsdf.phase import registry as phase_functions
from photograd.images.kind import LINEAR_SUFFIXES
from photograd.images.read import read_radiance
from photograd.lights import EnvironmentMap, Light, about_y
from photograd.lights.registered import RegisteredLight, cap_height
from photograd.lights.registered import registry as lights
from photograd.transport.density_files import is_placed, read_density
from photograd.transport.medium import VACUUM, DensityGrid, Medium
from photograd.transport.scene_node import Node
from photograd.transport.shapes import Shape


def light_of(node: Node) -> Light:
    """The light that a table describes.

    Args:
        node: a table of [[lights]].

    Raises:
        SceneError: with line and key, whatever is wrong with it.
    """
    kind = node.choice("kind", KINDS)
    light = node.built(lambda: KINDS[kind](node))
    node.refuse_other_keys()
    return light


def _registered(name: str) -> Callable[[Node], RegisteredLight]:
    """Reads the attributes of a light of the registry: colors, places and numbers."""
    light = lights()[name]

    def read(node: Node) -> RegisteredLight:
        values: dict[str, object] = {}
        for parameter in light.parameters():
            if parameter.size == 3:
                values[parameter.name] = node.color(parameter.name)
        for parameter in (*light.parameters(), *light.constants()):
            if parameter.name in ANGLES:
                values[parameter.name] = ANGLES[parameter.name](_angle(node))
            elif parameter.name not in values:
                read_one = node.number if parameter.size == 1 else _point(node)
                values[parameter.name] = read_one(parameter.name)
        return light(**values)

    return read


def _point(node: Node) -> Callable[[str], object]:
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
    **{name: _registered(name) for name in lights() if name not in ("constant", "quad")},
    "ambient": _registered("constant"),
    "rectangle": _registered("quad"),
    "environment": _environment,
}


# Media of a scene file: tables [media.NAME], and what fills shapes.


def media_in(root: Node) -> tuple[dict[str, Medium], str | None]:
    """The media of a scene file, and the name of the world's.

    Args:
        root: of the scene file.

    Raises:
        SceneError: with line and key, whatever is wrong with them.
    """
    tables = root.table("media") if root.has("media") else None
    media = {} if tables is None else {key: _medium(tables.table(key)) for key in tables.data}
    world = root.choice("world_medium", media) if root.has("world_medium") else None
    return media, world


def filled(node: Node, media: dict[str, Medium], shapes: list[Shape]) -> list[Shape]:
    """The shapes of a table with its `interior`, if it names one.

    Args:
        node: the table of the shapes.
        media: by name.
        shapes: without an interior.
    """
    if not node.has("interior"):
        return shapes
    interior = node.choice("interior", (*media, VACUUM))
    return [replace(shape, interior=interior) for shape in shapes]


def _medium(node: Node) -> Medium:
    density = _density(node)
    apart = node.has("sigma_a")
    first, second = ("sigma_a", "sigma_s") if apart else ("sigma_t", "albedo")
    coefficients = [_color(node, first), _color(node, second) if node.has(second) else None]
    if second == "sigma_s" and (coefficients[1] is None or not np.any(coefficients[1])):
        apart, coefficients[1] = False, None  # what does not scatter has no phase function
    more: dict[str, Any] = {"density": density}
    if coefficients[1] is not None:
        known = phase_functions()
        name = node.choice("phase", known) if node.has("phase") else "henyey_greenstein"
        values = {p.name: node.number(p.name, 0.0) for p in known[name].parameters}
        more |= {"phase": name, "values": values}
    node.refuse_other_keys()
    return node.built(lambda: (Medium.of if apart else Medium)(*coefficients, **more))


def _color(node: Node, key: str) -> Any:
    """One number or three, of which the medium knows what they may be."""
    found = node.value(key)
    return node.numbers(key, 3) if isinstance(found, list) else node.number(key)


def _density(node: Node) -> DensityGrid | None:
    if not node.has("density"):
        return None
    path = node.path.parent / node.text("density")
    has_grid = path.suffix.lower() == ".vdb" and node.has("grid")
    grid = node.text("grid") if has_grid else None
    moved = not is_placed(path) or node.has("corner") or node.has("size")
    corner = node.numbers("corner", 3) if moved else None
    size = node.numbers("size", 3) if moved else None
    majorant = node.number("majorant") if node.has("majorant") else None
    return node.built(
        lambda: read_density(path, grid=grid, corner=corner, size=size, majorant=majorant),
        "density",
    )
