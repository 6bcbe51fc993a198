"""Media of a scene file: tables [media.NAME], and what fills shapes.

world_medium = "haze"         # optional, at the top: around everything; it has no end

[media.milk]
sigma_t = [900, 900, 950]     # 1/m; or sigma_a and sigma_s
albedo = [0.999, 0.998, 0.99] # absent: it only absorbs
phase = "henyey_greenstein"   # optional; its parameters as keys of their own
g = 0.7

[media.smoke]
sigma_t = 20
albedo = 0.8
density = "smoke.npy"         # beside the scene file: numbers (X, Y, Z), which scale sigma_t
corner = [-1, 0, -1]          # of the box that they fill, metres
size = [2, 2, 2]

[media.cloud]
sigma_t = 40
albedo = 0.999
density = "cloud.vdb"         # or .vol, .vtk, .nii: on its own lattice, where the file says
grid = "density"              # optional, of a .vdb: the first grid of scalars, if absent
corner = [-1, 0, -1]          # optional, with size: where to move and stretch it to
size = [2, 2, 2]
majorant = 3                  # optional: no density is ever larger, also when they are fitted

[[shapes]]
kind = "sphere"               # or any closed shape
material = "glass"            # or "boundary", which is not seen
interior = "milk"             # or "vacuum"
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from photograd.bsdf.phase import registry
from photograd.transport.density_files import is_placed, read_density
from photograd.transport.medium import VACUUM, DensityGrid, Medium
from photograd.transport.scene import Shape
from photograd.transport.scene_node import Node


def media_in(root: Node) -> tuple[dict[str, Medium], str | None]:
    """The media of a scene file, and the name of the world's.

    Raises:
        SceneError: with line and key, whatever is wrong with them.
    """
    tables = root.table("media") if root.has("media") else None
    media = {} if tables is None else {key: _medium(tables.table(key)) for key in tables.data}
    world = root.choice("world_medium", media) if root.has("world_medium") else None
    return media, world


def filled(node: Node, media: dict[str, Medium], shapes: list[Shape]) -> list[Shape]:
    """The shapes of a table with its `interior`, if it names one."""
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
        known = registry()
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
