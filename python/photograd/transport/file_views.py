"""Cameras and lights that a scene file takes from a mesh file."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from photograd_course.suggest import choose_from

from photograd.capture.camera import Camera
from photograd.lights import DirectionalLight, Light, PointLight, SpotLight
from photograd.transport.mesh_files import ModelFile, read_model
from photograd.transport.scene_node import Node
from photograd.types import Array


def camera_of_file(node: Node) -> Camera:
    """The camera that a table [camera] with a `file` names: its place and vertical field of view.

    Raises:
        SceneError: no such file, or no such camera in it.
    """
    path = node.path.parent / node.text("file")
    width, height = node.picture_size()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of its shapes, which are not looked at
        model = node.built(lambda: read_model(path))
    by_name = {camera.name: camera for camera in model.cameras}
    if not by_name:
        raise node.wrong("file", "a .glb or .gltf with a perspective camera", path.name)
    name = node.text("name", model.cameras[0].name)
    if name not in by_name:
        expected = f"a camera of {path.name}: {', '.join(by_name)}"
        raise node.wrong("name", expected, name, choose_from(name, by_name))
    node.refuse_other_keys()
    return node.built(lambda: by_name[name].camera(width, height))


def lights_of(node: Node, model: ModelFile, places: Sequence[Array]) -> list[Light]:
    """The lights of a model at each place (4, 4), if a table of kind "mesh" wants them.

    Raises:
        SceneError: a model that moves.
    """
    if not node.flag("lights"):
        if model.lights:
            told = f"{node.text('file')}: its lights are left out; lights = true brings them"
            warnings.warn(told, UserWarning, stacklevel=2)
        return []
    if model.lights and node.has("closing"):
        expected, got = "no motion of a file whose lights are wanted", "one"
        raise node.wrong("closing", expected, got, "leave out its lights, or its motion")
    return [placed_light(light, place) for place in places for light in model.lights]


def placed_light(light: Light, world_from_object: Array) -> Light:
    """A light of a mesh file, moved and turned; no scale changes what it sends."""

    def at(position: Any) -> Array:
        moved: Array = world_from_object[:3, :3] @ np.asarray(position) + world_from_object[:3, 3]
        return moved

    def turned(direction: Any) -> Array:
        way: Array = world_from_object[:3, :3] @ np.asarray(direction)
        return way

    if isinstance(light, PointLight):
        return replace(light, position=at(light.position))
    if isinstance(light, SpotLight):
        return replace(light, position=at(light.position), axis=turned(light.axis))
    assert isinstance(light, DirectionalLight)
    return replace(light, direction=turned(light.direction))
