"""Cameras of a glTF file, and ours as glTF has them [Khronos2021, Sec. 3.10].

A camera of glTF looks along -Z of its node with +Y up; what the node scales is ignored. Pixels are
square and as many as the reader likes: `yfov` holds, and `aspectRatio` gives the width. Clipping
planes are not looked at, since rays need none; one has to be written, and is `ZNEAR`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from photograd._json_node import JsonNode
from photograd.capture.frames import MAX_COORDINATE, OPENGL_FROM_OPENCV, RIGID_TOLERANCE
from photograd.errors import IoError, message
from photograd.transport.mesh_files.container import NAME, Container, whole
from photograd.transport.mesh_files.model_camera import ModelCamera
from photograd.transport.mesh_files.model_file import UniqueNames
from photograd.transport.mesh_files.nodes import NodeTransform
from photograd.types import Array

ZNEAR = 0.01  # meters


def read_cameras(
    container: Container, nodes: Sequence[NodeTransform], note: Callable[[str], None]
) -> tuple[ModelCamera, ...]:
    """One for each node that has a camera; `note` takes orthographic and distorted ones.

    Args:
        container: the file.
        nodes: with their transforms.
        note: called with sentences.

    Raises:
        IoError, RangeError: values that no camera of glTF has, by node or camera.
    """
    found: list[ModelCamera] = []
    names = UniqueNames()
    for node, world in nodes:
        if "camera" not in node:
            continue
        table = container.root["cameras"].items() if "cameras" in container.root else []
        number = whole(node, 0, len(table) - 1, "camera")
        projection = _projection(table[number], note)
        if projection is None:
            continue
        pose = _pose(world)
        if pose is None:
            note(f"{node.where}: a camera that is mirrored, sheared or out of reach, left out")
            continue
        name = next((n["name"].text() for n in (table[number], node) if "name" in n), "camera")
        found.append(ModelCamera(names.unique_name(name), projection[0], pose, projection[1]))
    return tuple(found)


def _projection(camera: JsonNode, note: Callable[[str], None]) -> tuple[float, float | None] | None:
    """Vertical field of view and aspect; None, with a note, of a camera without perspective."""
    kind = camera["type"].text()
    if kind == "orthographic":
        note(f"{camera.where}: orthographic: not supported, left out")
        return None
    if kind != "perspective":
        expected = "perspective or orthographic"
        raise IoError(message(NAME, camera["type"].where, expected, kind[:60]))
    lens = camera["perspective"]
    angle = lens["yfov"].number()
    if not 0 < angle < np.pi:
        expected = "radians between 0 and pi"
        raise IoError(message(NAME, lens["yfov"].where, expected, angle))
    if "aspectRatio" not in lens:
        return angle, None
    aspect = lens["aspectRatio"].number()
    if not aspect > 0:
        raise IoError(message(NAME, lens["aspectRatio"].where, "a number above 0", aspect))
    return angle, aspect


def _pose(world: Array) -> Array | None:
    """world_from_camera of a node without what it scales; None if no rotation is left."""
    if not (np.isfinite(world).all() and np.abs(world).max() < MAX_COORDINATE):
        return None
    lengths = np.linalg.norm(world[:3, :3], axis=0)
    if not lengths.min() > 0:
        return None
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = world[:3, :3] / lengths, world[:3, 3]
    turn = pose[:3, :3]
    skew = float(np.abs(turn.T @ turn - np.eye(3)).max())
    if skew > RIGID_TOLERANCE or np.linalg.det(turn) < 0:
        return None
    return np.asarray(pose @ OPENGL_FROM_OPENCV)


def gltf_camera(camera: ModelCamera) -> tuple[dict[str, Any], list[float]]:
    """An entry of the table of cameras, and the matrix of its node.

    Args:
        camera: to be written.
    """
    lens = {"yfov": camera.field_of_view, "znear": ZNEAR}
    if camera.aspect is not None:
        lens["aspectRatio"] = camera.aspect
    entry = {"name": camera.name, "type": "perspective", "perspective": lens}
    return entry, (camera.world_from_camera @ OPENGL_FROM_OPENCV).T.ravel().tolist()
