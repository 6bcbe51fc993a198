"""The parts of a design in a scene: a slab of glass, a light, and a rectangle that is lit.

The slab is a box of model glass. Of its three axes, the one nearest to the direction of the
receiver is the lens's; the side towards the receiver becomes the height field. The receiver is a
rectangle whose front faces the slab, upright as its texture coordinates are.
"""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
from photograd_course.suggest import choose_from

from photograd.caustics.lens import Lens
from photograd.caustics.light import Light
from photograd.errors import RangeError, SceneError, message
from photograd.lights import DirectionalLight, PointLight
from photograd.transport.particles import IrradianceSensor
from photograd.transport.scene import Scene
from photograd.transport.shapes import MeshShape, Shape
from photograd.types import FloatArray

NAME = re.compile(r"shapes\.(?P<shape>.+)\.heights")
BOX_CORNERS, RECTANGLE_CORNERS = 8, 4


def height_shape(parameter: str) -> str | None:
    """The shape of a parameter "shapes.NAME.heights"; None for others.

    Args:
        parameter: a name.
    """
    found = NAME.fullmatch(parameter)
    return found["shape"] if found else None


def shape_of(scene: Scene, name: str) -> Shape:
    """The shape of this name.

    Args:
        scene: that has it.
        name: of the shape.

    Raises:
        RangeError: no such shape.
    """
    for shape in scene.shapes:
        if shape.name == name:
            return shape
    near = choose_from(name, [shape.name for shape in scene.shapes])
    raise RangeError(message("recover", "shapes", "a shape of the scene", f"'{name}'", near))


def light_of_scene(scene: Scene) -> Light:
    """The one light of a scene.

    Args:
        scene: that has it.

    Raises:
        SceneError: none, several, or one that is neither directional nor a point.
    """
    found = [light for light in scene.lights if isinstance(light, DirectionalLight | PointLight)]
    if len(found) != 1 or len(scene.lights) != 1:
        kinds = ", ".join(type(light).__name__ for light in scene.lights) or "none"
        expected = "one light, directional or point"
        raise SceneError(message("recover", "lights", expected, kinds))
    return found[0]


def receiver_of(scene: Scene, name: str, height: int, width: int) -> IrradianceSensor:
    """A rectangle of the scene as a sensor of this many cells.

    Args:
        scene: that has it.
        name: of a shape of kind rectangle.
        height, width: rows and columns.

    Raises:
        RangeError: no such shape.
        SceneError: a shape that is no rectangle.
    """
    shape = shape_of(scene, name)
    if not isinstance(shape, MeshShape) or len(shape.vertices) != RECTANGLE_CORNERS:
        raise SceneError(message("recover", "receiver", "a rectangle", f"'{name}', which is none"))
    corner, right, _, up = shape.vertices.astype(np.float64)
    return IrradianceSensor(corner, right - corner, up - corner, height, width)


def lens_of(scene: Scene, name: str, receiver: IrradianceSensor, shape: tuple[int, int]) -> Lens:
    """A box of glass as a plane lens in front of a receiver.

    Args:
        scene: that has it.
        name: of a shape of kind box and model glass.
        receiver: what the light behind it falls onto.
        shape: (m, n) vertices of the height field.

    Raises:
        RangeError: no such shape, or glass that is tinted.
        SceneError: a shape that is no box, or of another material.
    """
    found = shape_of(scene, name)
    if not isinstance(found, MeshShape) or len(found.vertices) != BOX_CORNERS:
        raise SceneError(message("recover", "shapes", "a box of glass", f"'{name}', which is none"))
    material = scene.materials.get(found.material)
    if material is None or material.model != "glass":
        got = found.material if material is None else material.model
        raise SceneError(message("recover", f"{name}.material", "model glass", got))
    tint = np.asarray(material.values["tint"])
    if not (tint == 1).all():
        raise RangeError(message("recover", f"{found.material}.tint", "1, clear glass", tint))
    corners = found.vertices.astype(np.float64)  # numbered 4 i + 2 j + k
    edges = corners[[4, 2, 1]] - corners[0]
    middle = receiver.corner + 0.5 * (receiver.edge_x + receiver.edge_y)
    way = middle - corners.mean(axis=0)
    lengths = np.sqrt(np.square(edges).sum(axis=1))
    along = np.einsum("ek,k->e", edges, way) / lengths
    k = int(np.abs(along).argmax())
    axis = edges[k] if along[k] > 0 else -edges[k]
    front = corners[0] if along[k] > 0 else corners[0] + edges[k]
    x, y = _like(edges[(k + 1) % 3], edges[(k + 2) % 3], receiver)
    if float((np.cross(x, y) * axis).sum()) < 0:  # light goes along x cross y
        front, x = front + x, -x
    eta = float(np.asarray(material.values["eta"]))
    return Lens(front, x, y, float(lengths[k]), np.zeros(shape), eta)


def _like(
    one: FloatArray, two: FloatArray, receiver: IrradianceSensor
) -> tuple[FloatArray, FloatArray]:
    """Both edges, first the one that is nearer to the receiver's rows."""
    across = [
        abs(float((e * receiver.edge_x).sum()) / float(np.sqrt(np.square(e).sum())))
        for e in (one, two)
    ]
    return (one, two) if across[0] >= across[1] else (two, one)


def scene_with_lens(scene: Scene, name: str, lens: Lens) -> Scene:
    """The scene with a lens in place of a shape.

    Args:
        scene: stays as it is.
        name: of the shape.
        lens: that takes its place and its material.
    """
    old = shape_of(scene, name)
    new = lens.shape(name, old.material)
    return replace(scene, shapes=tuple(new if s is old else s for s in scene.shapes))
