"""Signed distance functions in scene files: tables [sdfs.NAME] (docs/scene_file.md)."""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce

import numpy as np

from photograd.errors import SceneError
from photograd.geometry import sdf
from photograd.geometry.sdf import Shape
from photograd.transport.scene_node import Node

DEEPEST = 64  # names within names
MOST_PARTS = 4096  # of one body, each use of a name counted
COMBINATIONS = ("union", "intersection", "difference", "smooth_union", "rounded")


def bodies_in(root: Node) -> dict[str, Shape]:
    """The tables [sdfs.NAME] of a scene file.

    Args:
        root: of the scene file.
    """
    if not root.has("sdfs"):
        return {}
    tables = root.table("sdfs")
    found = _Bodies({name: tables.table(name) for name in tables.data})
    for name in tables.data:
        found.body(name)
    return found.built


class _Bodies:
    """Bodies by name, made of one another in any order."""

    def __init__(self, nodes: dict[str, Node]) -> None:
        self._nodes = nodes
        self._open: list[str] = []
        self._parts: dict[str, int] = {}
        self.built: dict[str, Shape] = {}

    def body(self, name: str) -> Shape:
        if name not in self.built:
            node = self._nodes[name]
            self._open.append(name)
            parts = self._named_parts(node)
            self._parts[name] = 1 + sum(self._parts[part] for part in parts)
            if self._parts[name] > MOST_PARTS:
                raise node.wrong("of", f"at most {MOST_PARTS} parts in all", self._parts[name])
            shapes = [self.built[part] for part in parts]
            shape = node.built(lambda: _placed(node, _shape(node, shapes)))
            node.refuse_other_keys()
            self._open.pop()
            self.built[name] = shape
        return self.built[name]

    def _named_parts(self, node: Node) -> list[str]:
        """The names in `of`, all of them built."""
        kind = node.choice("kind", (*SHAPES, *COMBINATIONS))
        if kind in SHAPES:
            return []
        names = node.value("of")
        least, most = (1, 1) if kind == "rounded" else (2, MOST_PARTS)
        if not isinstance(names, list) or not least <= len(names) <= most:
            what = "a list of one name" if kind == "rounded" else "a list of two names or more"
            raise node.wrong("of", what, names)
        for name in names:
            if not isinstance(name, str) or name not in self._nodes:
                raise node.wrong("of", f"names among {', '.join(self._nodes)}", name)
            if name in self._open:
                raise node.wrong("of", "bodies that are not made of themselves", name)
            if len(self._open) >= DEEPEST:
                raise node.wrong("of", f"at most {DEEPEST} names within names", "more")
            self.body(name)
        return names


def _shape(node: Node, parts: list[Shape]) -> Shape:
    kind = node.text("kind")
    return SHAPES[kind](node) if kind in SHAPES else _combined(node, kind, parts)


def _length(node: Node, key: str) -> float:
    number = node.number(key)
    if not number > 0:
        raise node.wrong(key, "a length above 0 m", number)
    return number


def _half_sizes(node: Node) -> list[float]:
    half = node.numbers("half_sizes", 3)
    if not min(half) > 0:
        raise node.wrong("half_sizes", "lengths above 0 m", half)
    return half


def _plane(node: Node) -> Shape:
    return sdf.plane(node.numbers("normal", 3), node.number("height"))


SHAPES: dict[str, Callable[[Node], Shape]] = {
    "sphere": lambda node: sdf.sphere(_length(node, "radius")),
    "box": lambda node: sdf.box(_half_sizes(node)),
    "rounded_box": lambda node: sdf.rounded_box(_half_sizes(node), _length(node, "radius")),
    "torus": lambda node: sdf.torus(_length(node, "ring"), _length(node, "tube")),
    "capsule": lambda node: sdf.capsule(_length(node, "half_length"), _length(node, "radius")),
    "plane": _plane,
}


def _combined(node: Node, kind: str, parts: list[Shape]) -> Shape:
    if kind == "rounded":
        return sdf.rounded(parts[0], _length(node, "radius"))
    if kind == "union":
        return sdf.union(*parts)
    if kind == "smooth_union":
        width = _length(node, "width")
        return reduce(lambda a, b: sdf.smooth_union(a, b, width), parts)
    pair = sdf.intersection if kind == "intersection" else sdf.difference
    return reduce(pair, parts)


def _placed(node: Node, shape: Shape) -> Shape:
    if node.has("scale"):
        factor = node.number("scale")
        if not factor > 0:
            raise node.wrong("scale", "one factor above 0, the same along all axes", factor)
        shape = sdf.scaled(shape, factor)
    turn, shift = (node.numbers(key, 3, [0.0] * 3) for key in ("rotate", "translate"))
    if not (node.has("rotate") or node.has("translate")):
        return shape
    return sdf.placed(shape, shift, quaternion_of(turn))


def quaternion_of(degrees: list[float]) -> list[float]:
    """(w, x, y, z) of turns about x, then y, then z.

    Args:
        degrees: about x, y and z.
    """
    total = np.array([1.0, 0.0, 0.0, 0.0])
    for axis, angle in enumerate(np.radians(degrees)):
        w, v = np.cos(angle / 2), np.zeros(3)
        v[axis] = np.sin(angle / 2)
        # (w, v) times what has been: the later turn stands on the left.
        real = w * total[0] - v @ total[1:]
        total = np.array([real, *(w * total[1:] + total[0] * v + np.cross(v, total[1:]))])
    return [float(x) for x in total]


def body_of(node: Node, bodies: dict[str, Shape]) -> Shape:
    """The body that a table of kind "sdf" names.

    Args:
        node: the table.
        bodies: by name.

    Raises:
        SceneError: none of this name, or emission; names the line and the key.
    """
    if not bodies:
        raise node.wrong("kind", "tables [sdfs.NAME] to take a body from", "none")
    if any(node.color("emission", [0.0, 0.0, 0.0])):
        raise _shines(node)
    return bodies[node.choice("body", bodies)]


def _shines(node: Node) -> SceneError:
    remedy = "let a mesh or a sphere shine"
    return node.wrong("emission", "0 of a signed distance function", node.value("emission"), remedy)
