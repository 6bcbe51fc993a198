"""Shapes that move while the shutter is open: each point straight on, at one speed.

A path sees them, and what they shadow, at one moment, which it samples
(cpp/photograd/render/path/camera_sample.h). A medium fills the shape wherever that is; a grid of
densities stays where it is in the world.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from photograd.errors import SceneError, message
from photograd.transport.shapes import MeshShape, Shape, SphereShape
from photograd.types import Array


def moves(shape: Shape) -> bool:
    """Whether a shape is elsewhere when the shutter closes."""
    if isinstance(shape, MeshShape):
        both = zip(shape.instances or (np.eye(4),), shape.closing_instances, strict=False)
        return any(not np.array_equal(*ends) for ends in both)
    if isinstance(shape, SphereShape):
        return shape.closing is not None and not np.array_equal(shape.closing, shape.center)
    return False


def check_motion(shapes: Sequence[Shape]) -> None:
    """Raise SceneError for lights that move.

    Args:
        shapes: of the scene.
    """
    for shape in shapes:
        if moves(shape) and shape.emission.any():
            expected, remedy = "lights that stand still", "let it shine, or let it move"
            got = f"'{shape.name}', which moves"
            raise SceneError(message("Scene", f"{shape.name}.emission", expected, got, remedy))


def refuse_motion(function: str, shapes: Sequence[Shape]) -> None:
    """Raise SceneError, naming `function`, for shapes of a scene that move."""
    for shape in shapes:
        if moves(shape):
            expected, remedy = "shapes that stand still", "leave out their motion"
            got = f"'{shape.name}', which moves"
            raise SceneError(message(function, "scene.shapes", expected, got, remedy))


def moved_on(shape: Shape, way: Array) -> Shape:
    """A mesh or a sphere that `way` (4, 4) moves, in the world, while the shutter is open.

    Args:
        shape: when the shutter opens.
        way: (4, 4) in the world.

    Raises:
        SceneError: a sphere that would turn or grow, or a signed distance function.
        RangeError, SceneError: as `MeshShape`.
    """
    if isinstance(shape, MeshShape):
        starts = shape.instances or (np.eye(4),)
        return replace(shape, closing_instances=tuple(way @ instance for instance in starts))
    if not isinstance(shape, SphereShape):
        expected, remedy = "a mesh or a sphere", "leave out its motion"
        got = "a signed distance function"
        raise SceneError(message("Scene", f"{shape.name}.closing", expected, got, remedy))
    if not np.array_equal(way[:3, :3], np.eye(3)):
        expected = "a sphere that is moved straight on, by translate alone"
        raise SceneError(message("Scene", f"{shape.name}.closing", expected, "a turn or a scale"))
    return replace(shape, closing=shape.center + way[:3, 3])


def closing_arrays(
    meshes: Sequence[MeshShape], spheres: Sequence[SphereShape]
) -> dict[str, Array | None]:
    """World_from_object (I, 3, 4) float64 and spheres (K, 4) float32 when the shutter closes.

    None where no mesh, or no sphere, moves.

    Args:
        meshes: of the scene.
        spheres: of the scene.
    """
    matrices = [
        instance[:3]
        for mesh in meshes
        for instance in (mesh.closing_instances or mesh.instances or (np.eye(4),))
    ]
    balls = [
        [*(ball.center if ball.closing is None else ball.closing), ball.radius] for ball in spheres
    ]
    return {
        "closing_matrices": np.array(matrices) if any(map(moves, meshes)) else None,
        "closing_spheres": np.array(balls, np.float32) if any(map(moves, spheres)) else None,
    }
