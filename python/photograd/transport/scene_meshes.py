"""Mesh files and textures in scene files, and the cameras and lights that mesh files bring."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from photograd_course.suggest import choose_from

from photograd.capture.camera import Camera
from photograd.images.read import read_image
from photograd.lights import DirectionalLight, Light, PointLight, SpotLight
from photograd.transport.material import Material
from photograd.transport.medium import Medium
from photograd.transport.mesh_files import ModelFile, read_model
from photograd.transport.mesh_files.model_file import moved
from photograd.transport.scene_node import Node
from photograd.transport.shapes import MeshShape
from photograd.transport.texture import (
    ENCODINGS,
    FILTERS,
    WRAPS,
    Filter,
    NormalMap,
    Texture,
    TextureUse,
    read_texture,
)
from photograd.types import Array


def camera_of_file(node: Node) -> Camera:
    """The camera that a table [camera] with a `file` names: its pose and vertical field of view.

    Args:
        node: the table.

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


def lights_of(node: Node, model: ModelFile, instances: Sequence[Array]) -> list[Light]:
    """The lights of a model at each instance (4, 4), if a table of kind "mesh" wants them.

    Args:
        node: the table.
        model: what its file holds.
        instances: world_from_object of the model.

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
    return [placed_light(light, instance) for instance in instances for light in model.lights]


def placed_light(light: Light, world_from_object: Array) -> Light:
    """A light of a mesh file, moved and turned; no scale changes what it sends.

    Args:
        light: of the file.
        world_from_object: (4, 4).
    """

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


# Mesh files and textures in scene files.


def textures_in(root: Node) -> dict[str, Texture]:
    """The tables [textures.NAME] of a scene file.

    Args:
        root: of the scene file.
    """
    if not root.has("textures"):
        return {}
    tables = root.table("textures")
    return {name: _texture(tables.table(name)) for name in tables.data}


def _texture(node: Node) -> Texture:
    encoding = node.choice("encoding", ENCODINGS) if node.has("encoding") else "srgb"
    wrap = node.choice("wrap", WRAPS) if node.has("wrap") else "repeat"
    looked_up = node.choice("filter", FILTERS) if node.has("filter") else "bilinear"
    path = node.path.parent / node.text("file")
    node.refuse_other_keys()
    return node.built(lambda: read_texture(path, encoding, (wrap, wrap), looked_up))


def pictures_of(node: Node) -> tuple[dict[str, TextureUse], NormalMap | None]:
    """`textures` and `normal_map` of a table [materials.NAME].

    Args:
        node: the table.
    """
    uses: dict[str, TextureUse] = {}
    if node.has("textures"):
        table = node.table("textures")
        uses = {parameter: texture_use(table, parameter) for parameter in table.data}
    if not node.has("normal_map"):
        return uses, None
    path = node.path.parent / node.text("normal_map")
    return uses, node.built(lambda: NormalMap.from_image(read_image(path)))


def texture_use(node: Node, key: str) -> TextureUse:
    """A texture's name, or its name and a channel.

    Args:
        node: the table.
        key: of the value.
    """
    found = node.value(key)
    name, channel = found if isinstance(found, list) and len(found) == 2 else (found, 0)
    if not isinstance(name, str) or type(channel) is not int:
        raise node.wrong(key, 'a texture\'s name, or ["name", channel]', found)
    return TextureUse(name, channel)


@dataclass
class ImportedMeshes:
    """What mesh files bring along: lights; materials, textures and media by names of their own."""

    materials: dict[str, Material] = field(default_factory=dict)
    textures: dict[str, Texture] = field(default_factory=dict)
    media: dict[str, Medium] = field(default_factory=dict)
    lights: list[Light] = field(default_factory=list)

    def update(self, other: ImportedMeshes) -> None:
        """Add what another file brings.

        Args:
            other: what is added.
        """
        self.materials.update(other.materials)
        self.textures.update(other.textures)
        self.media.update(other.media)
        self.lights.extend(other.lights)


def mesh_shapes(
    node: Node, name: str, material: str | None, emission: Any
) -> tuple[list[MeshShape], ImportedMeshes]:
    """The shapes of a table of kind "mesh", and what they bring along.

    Names of the file get the shape's name and a slash in front. Emission is the file's where the
    table has none.

    Args:
        node: the table.
        name: of the shape.
        material: its name; None takes those of the file.
        emission: (3,) radiance, or None.
    """
    path = node.path.parent / node.text("file")
    inner = matrix_of(node)
    instances = (
        [matrix_of(instance) for instance in node.tables("instances")]
        if node.has("instances")
        else []
    )
    model = node.built(lambda: read_model(path))
    meshes = [shape for shape in model.shapes if isinstance(shape, MeshShape)]
    shapes = node.built(
        lambda: [_placed(mesh, name, material, emission, inner, instances) for mesh in meshes]
    )
    lights = lights_of(node, model, [far @ inner for far in instances or [np.eye(4)]])
    imported = _renamed(model, name, node.choice("filter", FILTERS) if node.has("filter") else None)
    imported.lights.extend(lights)
    if material is None:
        return shapes, imported
    lit = {shape.emission_texture.texture for shape in shapes if shape.emission_texture is not None}
    textures = {key: texture for key, texture in imported.textures.items() if key in lit}
    return shapes, ImportedMeshes(textures=textures, lights=lights)


def _placed(
    shape: MeshShape,
    name: str,
    material: str | None,
    emission: Any,
    inner: Array,
    instances: list[Array],
) -> MeshShape:
    """A shape of the file, moved, with the instances of the file and of the table multiplied."""
    vertices, faces, normals, uv = shape.vertices, shape.faces, shape.normals, shape.uv
    own = [np.asarray(inner @ instance) for instance in shape.instances]
    if not own:
        vertices, faces, normals, uv = moved((vertices, faces, normals, uv), inner)
    outer = instances or [np.eye(4)]
    both = [far @ near for far in outer for near in (own or [np.eye(4)])]
    shining = shape.emission if emission is None else np.asarray(emission, np.float64)
    emission_texture = shape.emission_texture if emission is None else None
    if emission_texture is not None:
        emission_texture = replace(emission_texture, texture=f"{name}/{emission_texture.texture}")
    return replace(
        shape,
        name=f"{name}/{shape.name}",
        vertices=vertices,
        faces=faces,
        normals=normals,
        uv=uv,
        material=material or f"{name}/{shape.material}",
        emission=shining,
        instances=tuple(both) if own or instances else (),
        emission_texture=emission_texture,
        interior=f"{name}/{shape.interior}" if material is None and shape.interior else None,
    )


def _renamed(model: ModelFile, name: str, looked_up: Filter | None) -> ImportedMeshes:
    materials = {
        f"{name}/{own}": replace(
            material,
            textures={
                parameter: TextureUse(f"{name}/{use.texture}", use.channel)
                for parameter, use in material.textures.items()
            },
        )
        for own, material in model.materials.items()
    }
    textures = {
        f"{name}/{own}": replace(texture, filter=looked_up or texture.filter)
        for own, texture in model.textures.items()
    }
    media = {f"{name}/{own}": medium for own, medium in model.media.items()}
    return ImportedMeshes(materials, textures, media)


def matrix_of(node: Node) -> Array:
    """(4, 4): scale, then rotate about x, y and z, then translate.

    Args:
        node: a table with `scale`, `rotate` and `translate`.
    """
    matrix = np.eye(4)
    if node.has("scale"):
        found = node.value("scale")
        one = [node.number("scale")] * 3 if not isinstance(found, list) else None
        size = one or node.numbers("scale", 3)
        if min(size) <= 0:
            raise node.wrong("scale", "factors above 0", found)
        matrix[:3, :3] *= size
    if node.has("rotate"):
        for axis, degrees in enumerate(node.numbers("rotate", 3)):
            c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
            i, j = (axis + 1) % 3, (axis + 2) % 3
            turn = np.eye(4)
            turn[i, i], turn[i, j], turn[j, i], turn[j, j] = c, -s, s, c
            matrix = turn @ matrix
    if node.has("translate"):
        matrix[:3, 3] = node.numbers("translate", 3)
    return matrix
