"""Scenes in TOML files: camera, environment, materials and shapes (docs/scene_file.md)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from photograd_course.input_files import read_text
from photograd_course.toml_limits import parse_toml

from photograd._arrays import Arguments
from photograd._registry import ModelParameter, ModelParameters
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.geometry.sdf import Shape as SdfNode
from photograd.transport.builtin import camera_at
from photograd.transport.lens import PINHOLE, Lens, Shutter
from photograd.transport.material import ALPHA, MODELS, Material
from photograd.transport.medium import BOUNDARY
from photograd.transport.motion import moved_on
from photograd.transport.scene import Environment, Scene
from photograd.transport.scene_meshes import (
    ImportedMeshes,
    camera_of_file,
    matrix_of,
    mesh_shapes,
    pictures_of,
    texture_use,
    textures_in,
)
from photograd.transport.scene_node import Node, key_lines
from photograd.transport.scene_tables import filled, light_of, media_in
from photograd.transport.sdf_nodes import bodies_in, body_of
from photograd.transport.shape_checks import check_range
from photograd.transport.shapes import MeshShape, SdfShape, Shape, SphereShape, box, rectangle


@typed_call
def read_scene(path: str | Path) -> Scene:
    """The scene that a TOML file describes; docs/scene_file.md has all that may stand there.

    Args:
        path: of the file.

    Raises:
        IoError: the file is missing, no regular file, no TOML, or exceeds a limit of `parse_toml`.
        SceneError: what it says is no scene; names the line and the key.

    Example:
        >>> room = photograd.PathTracer(photograd.read_scene("room.toml"))
        >>> image = room.render(spp=4, seed=0).mean  # (H, W, 3), linear radiance
        >>> gradients = room.render_backward(np.ones_like(image), spp=4, seed=1)
        >>> gradients["materials.wall.albedo"].shape
        (3,)
    """
    path = Path(path)
    text = read_text("read_scene", path)
    root = Node(path, parse_toml("read_scene", f"{path}", text), (), key_lines(text))
    scene = root.built(lambda: _scene(root, path.stem))
    root.refuse_other_keys()
    return scene


def _scene(root: Node, name: str) -> Scene:
    camera, lens, shutter = _camera(root.table("camera"))
    environment = _environment(root.table("environment")) if root.has("environment") else None
    materials: dict[str, Material] = {}
    if root.has("materials"):
        tables = root.table("materials")
        materials = {key: _material(tables.table(key)) for key in tables.data}
    media, world = media_in(root)
    bodies = bodies_in(root)
    imported = ImportedMeshes(dict(materials), textures_in(root), dict(media))
    shapes = [
        shape
        for i, node in enumerate(root.tables("shapes"))
        for shape in filled(
            node, media, _moving(node, _shapes(node, i, materials, imported, bodies))
        )
    ]
    lights = tuple(map(light_of, root.tables("lights"))) if root.has("lights") else ()
    lights += tuple(imported.lights)
    return Scene(
        name,
        tuple(shapes),
        imported.materials,
        camera,
        environment,
        lights,
        textures=imported.textures,
        lens=lens,
        shutter=shutter,
        media=imported.media,
        world=world,
    )


def _camera(node: Node) -> tuple[Camera, Lens, Shutter | None]:
    if node.has("file"):
        return camera_of_file(node), PINHOLE, None
    pixels = node.picture_size()
    position, target = _view(node)
    field_of_view = node.number("field_of_view")
    if not 0 < field_of_view < 180:
        raise node.wrong("field_of_view", "degrees between 0 and 180", field_of_view)
    radius = node.number("aperture", 0.0)
    focus = node.number("focus", float(np.linalg.norm(np.subtract(target, position))))
    closing = node.table("closing") if node.has("closing") else None
    node.refuse_other_keys()
    lens = node.built(lambda: Lens(radius, focus))
    camera = node.built(lambda: camera_at(position, target, field_of_view, *pixels))
    if closing is None:
        return camera, lens, None
    end = _view(closing)
    closing.refuse_other_keys()
    moved = closing.built(lambda: camera_at(*end, field_of_view, *pixels))
    return camera, lens, Shutter(moved.world_from_camera)


def _view(node: Node) -> tuple[list[float], list[float]]:
    """Where a camera is, and the point it looks at."""
    position, target = node.numbers("position", 3), node.numbers("look_at", 3)
    way = np.subtract(target, position)
    if np.linalg.norm(way[[0, 2]]) < 1e-6 * np.linalg.norm(way) or not way.any():
        raise node.wrong("look_at", "a point that is not straight above, below or here", target)
    return position, target


def _environment(node: Node) -> Environment:
    if node.has("radiance"):
        radiance = node.color("radiance")
        node.refuse_other_keys()
        return node.built(lambda: Environment.constant(radiance))
    parts = [np.array(node.color(name)) for name in ("zenith", "horizon", "ground")]
    node.refuse_other_keys()
    return node.built(lambda: Environment(*parts))


def _check_value(model: str, parameter: ModelParameter, values: Mapping[str, Any]) -> None:
    named = {parameter.name: values[parameter.name]}
    ModelParameters((parameter,)).pack_one(Arguments("Material", np.float64), model, named)
    check_range(model, parameter, named[parameter.name])


def _material(node: Node) -> Material:
    model = node.text("model")
    others = ("model", "textures", "normal_map", "alpha_cutoff")
    values = {key: node.value(key) for key in node.data if key not in others}
    uses, bent = pictures_of(node)
    for parameter in (*MODELS[model].parameters, ALPHA) if model in MODELS else ():
        if parameter.name in values:  # one at a time: the error then has the line of the key
            node.built(partial(_check_value, model, parameter, values), parameter.name)
    cutoff = node.number("alpha_cutoff") if node.has("alpha_cutoff") else None
    return node.built(lambda: Material(model, values, uses, bent, cutoff))


def _shapes(
    node: Node,
    index: int,
    materials: dict[str, Material],
    imported: ImportedMeshes,
    bodies: dict[str, SdfNode],
) -> list[Shape]:
    """What a table describes; materials, textures and media of its file are added to `imported`."""
    node.has("interior")  # read by `filled`
    node.has("closing")  # read by `_moving`
    kind = node.choice("kind", (*KINDS, "mesh", "sdf"))
    if kind == "sdf":
        return [_sdf(node, index, materials, bodies)]
    if kind != "mesh":
        return [_shape(node, index, materials)]
    name = node.text("name", f"mesh {index}")
    material = node.choice("material", (*materials, BOUNDARY)) if node.has("material") else None
    emission = node.color("emission") if node.has("emission") else None
    shapes, own = mesh_shapes(node, name, material, emission)
    node.refuse_other_keys()
    imported.update(own)
    return [*shapes]


def _moving(node: Node, shapes: list[Shape]) -> list[Shape]:
    """The shapes, as they move while the shutter is open."""
    if not node.has("closing"):
        return shapes
    table = node.table("closing")
    way = matrix_of(table)
    table.refuse_other_keys()
    return [table.built(partial(moved_on, shape, way)) for shape in shapes]


def _shape(node: Node, index: int, materials: dict[str, Material]) -> Shape:
    kind = node.choice("kind", KINDS)
    name = node.text("name", f"{kind} {index}")
    material = node.choice("material", (*materials, BOUNDARY))
    emission = node.color("emission", [0.0, 0.0, 0.0])
    shape = node.built(lambda: KINDS[kind](node, name, material, emission))
    if isinstance(shape, MeshShape) and node.has("emission_texture"):
        shape = replace(shape, emission_texture=texture_use(node, "emission_texture"))
    node.refuse_other_keys()
    return shape


def _sdf(
    node: Node, index: int, materials: dict[str, Material], bodies: dict[str, SdfNode]
) -> SdfShape:
    name = node.text("name", f"sdf {index}")
    material, body = node.choice("material", (*materials, BOUNDARY)), body_of(node, bodies)
    node.refuse_other_keys()
    return node.built(lambda: SdfShape(name, body, material))


def _rectangle(node: Node, name: str, material: str, emission: Any) -> MeshShape:
    corner, u, v = (node.numbers(key, 3) for key in ("corner", "edge_u", "edge_v"))
    return rectangle(name, corner, u, v, material, emission)


def _box(node: Node, name: str, material: str, emission: Any) -> MeshShape:
    return box(
        name,
        node.numbers("center", 3),
        node.numbers("size", 3),
        material,
        emission,
        turn=node.number("turn", 0.0),
        inward=node.flag("inward"),
    )


def _sphere(node: Node, name: str, material: str, emission: Any) -> SphereShape:
    center = np.array(node.numbers("center", 3))
    return SphereShape(name, center, node.number("radius"), material, emission)


def _triangles(node: Node, name: str, material: str, emission: Any) -> MeshShape:
    vertices = node.rows("vertices", float)
    normals = node.rows("normals", float) if node.has("normals") else None
    return MeshShape(name, vertices, node.rows("faces", int), material, emission, normals)


KINDS: dict[str, Callable[[Node, str, str, Any], Shape]] = {
    "rectangle": _rectangle,
    "box": _box,
    "sphere": _sphere,
    "triangles": _triangles,
}
