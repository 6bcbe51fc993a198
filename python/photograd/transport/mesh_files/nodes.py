"""Where everything in a glTF file stands: its tree of nodes [Khronos2021, Sec. 3.5]."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from photograd._json_node import JsonNode
from photograd.errors import IoError, message
from photograd.transport.mesh_files.container import NAME, Container, whole
from photograd.types import Array

NodeTransform = tuple[JsonNode, Array]
"""A node and world_from_node (4, 4)."""


def placed_nodes(container: Container) -> list[NodeTransform]:
    """All nodes of the scene that the file shows first, in the order of the tree.

    Args:
        container: the file.

    Raises:
        IoError: nodes that are no tree, or matrices that are none.
    """
    root = container.root
    if "nodes" not in root:
        return []
    nodes = root["nodes"].items()
    found: list[NodeTransform] = []
    visited: set[int] = set()
    waiting = [(number, np.eye(4)) for number in reversed(_roots(container, nodes))]
    while waiting:
        number, parent = waiting.pop()
        node = nodes[number]
        if number in visited:
            got = "a node with two parents, or its own"
            raise IoError(message(NAME, node.where, "a tree of nodes", got))
        visited.add(number)
        world = parent @ _local(node)
        found.append((node, world))
        children = _references(node, "children", len(nodes)) if "children" in node else []
        waiting += [(child, world) for child in reversed(children)]
    return found


def transforms_of_meshes(nodes: Sequence[NodeTransform]) -> dict[int, list[Array]]:
    """{mesh number: world_from_object (4, 4) of each node that shows it}, in the order of nodes.

    Raises:
        IoError: what is no number of a mesh.
    """
    found: dict[int, list[Array]] = {}
    for node, world in nodes:
        if "mesh" in node:
            found.setdefault(whole(node, 0, 1 << 31, "mesh"), []).append(world)
    return found


def _roots(container: Container, nodes: list[JsonNode]) -> list[int]:
    """Nodes of the scene that the file shows first; without scenes, those that are no children."""
    root = container.root
    if "scenes" in root:
        scenes = root["scenes"].items()
        scene = scenes[whole(root, 0, len(scenes) - 1, "scene", 0)] if scenes else None
        return _references(scene, "nodes", len(nodes)) if scene and "nodes" in scene else []
    children = {
        child
        for node in nodes
        if "children" in node
        for child in _references(node, "children", len(nodes))
    }
    return [number for number in range(len(nodes)) if number not in children]


def _references(node: JsonNode, key: str, count: int) -> list[int]:
    return [whole(item, 0, count - 1) for item in node[key].items()]


def _local(node: JsonNode) -> Array:
    """parent_from_node: a matrix by columns, or translation, rotation (x, y, z, w) and scale."""
    if "matrix" in node:
        matrix: Array = node["matrix"].numbers((16,)).reshape(4, 4).T
        return matrix
    matrix = np.eye(4)
    if "rotation" in node:
        quaternion = node["rotation"].numbers((4,))
        length = float(np.linalg.norm(quaternion))
        if not 0.5 < length < 2:
            raise node["rotation"].wrong("a quaternion of length 1")
        x, y, z, w = quaternion / length
        matrix[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    if "scale" in node:
        matrix[:3, :3] *= node["scale"].numbers((3,))
    if "translation" in node:
        matrix[:3, 3] = node["translation"].numbers((3,))
    return matrix
