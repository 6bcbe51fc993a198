"""Shapes that move while the shutter is open: each point straight on, at one speed.

A path sees them, and what they shadow, at one moment, which it samples
(cpp/photograd/render/path/camera_sample.h). A medium fills the shape wherever that is; a grid of
densities stays where it is in the world.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from photograd.errors import RangeError, SceneError, ShapeError, message
from photograd.transport.shape_checks import checked_place
from photograd.types import Array

if TYPE_CHECKING:
    from photograd.transport.scene import MeshShape, Scene, Shape, SphereShape

FLAT = 1e-9
"""A mesh whose volume has shrunk to less than this part is flat, as far as rounding can tell."""


def checked_closing_places(
    name: str, places: Sequence[Array], closing: Sequence[Any]
) -> tuple[Array, ...]:
    """World_from_object (4, 4) of each instance when the shutter closes.

    Raises:
        ShapeError: another number of them than of places, or what `checked_place` refuses.
        RangeError: a mesh that would be flat or mirrored at some moment in between.
    """
    ends = tuple(checked_place(name, matrix) for matrix in closing)
    starts = list(places) or [np.eye(4)]
    if ends and len(ends) != len(starts):
        expected = f"{len(starts)}, one for each place"
        raise ShapeError(message("MeshShape", f"{name}.closing_places", expected, len(ends)))
    for start, end in zip(starts, ends, strict=False):
        least = _least_volume(start[:3, :3], end[:3, :3])
        if not least > FLAT:
            expected = "a positive determinant at every moment"
            remedy = "turn by less, points move straight on"
            raise RangeError(
                message("MeshShape", f"{name}.closing_places", expected, least, remedy)
            )
    return ends


def _least_volume(a: Array, b: Array) -> float:
    """The least determinant of (1 - s) a + s b, s in [0, 1], as a part of the largest; a cubic."""
    s = np.array([0.0, 1 / 3, 2 / 3, 1.0])
    volume = [np.linalg.det((1 - x) * a + x * b) for x in s]
    cubic = np.linalg.solve(np.vander(s, increasing=True), volume)
    # Both roots of the derivative, also where it is of lower degree; or the end nearby.
    c0, c1, c2 = cubic[1:] * [1, 2, 3]
    q = -0.5 * (c1 + np.copysign(np.sqrt(max(c1 * c1 - 4 * c0 * c2, 0.0)), c1))
    turning = [x / y for x, y in ((q, c2), (c0, q)) if abs(y) > 0]
    found = np.polyval(cubic[::-1], np.clip([0.0, 1.0, *turning], 0, 1))
    return float(found.min() / np.abs(found).max())


def moves(shape: Shape) -> bool:
    """Whether a shape is elsewhere when the shutter closes."""
    it: Any = shape
    if hasattr(it, "closing_places"):
        both = zip(it.places or (np.eye(4),), it.closing_places, strict=False)
        return any(not np.array_equal(*ends) for ends in both)
    closing = getattr(it, "closing", None)
    return closing is not None and not np.array_equal(closing, it.center)


def check_motion(scene: Scene) -> None:
    """Raise SceneError for lights that move."""
    for shape in scene.shapes:
        if moves(shape) and shape.emission.any():
            expected, remedy = "lights that stand still", "let it shine, or let it move"
            got = f"'{shape.name}', which moves"
            raise SceneError(message("Scene", f"{shape.name}.emission", expected, got, remedy))


def refuse_motion(function: str, scene: Scene) -> None:
    """Raise SceneError, naming `function`, for a scene in which shapes move."""
    for shape in scene.shapes:
        if moves(shape):
            expected, remedy = "shapes that stand still", "leave out their motion"
            got = f"'{shape.name}', which moves"
            raise SceneError(message(function, "scene.shapes", expected, got, remedy))


def moved_on(shape: Shape, way: Array) -> Shape:
    """A mesh or a sphere that `way` (4, 4) moves, in the world, while the shutter is open.

    Raises:
        SceneError: a sphere that would turn or grow, or a body of signed distances.
        As `MeshShape`.
    """
    if hasattr(shape, "places"):
        mesh: MeshShape = shape  # type: ignore[assignment]
        starts = mesh.places or (np.eye(4),)
        return replace(mesh, closing_places=tuple(way @ place for place in starts))
    if not hasattr(shape, "radius"):
        expected, remedy = "a mesh or a sphere", "leave out its motion"
        got = "a body of signed distances"
        raise SceneError(message("Scene", f"{shape.name}.closing", expected, got, remedy))
    if not np.array_equal(way[:3, :3], np.eye(3)):
        expected = "a sphere that is moved straight on, by translate alone"
        raise SceneError(message("Scene", f"{shape.name}.closing", expected, "a turn or a scale"))
    ball: SphereShape = shape  # type: ignore[assignment]
    return replace(ball, closing=ball.center + way[:3, 3])


def closing_arrays(
    meshes: Sequence[MeshShape], spheres: Sequence[SphereShape]
) -> dict[str, Array | None]:
    """World_from_object (I, 3, 4) float64 and spheres (K, 4) float32 when the shutter closes.

    None where no mesh, or no sphere, moves.
    """
    matrices = [
        place[:3]
        for mesh in meshes
        for place in (mesh.closing_places or mesh.places or (np.eye(4),))
    ]
    balls = [
        [*(ball.center if ball.closing is None else ball.closing), ball.radius] for ball in spheres
    ]
    return {
        "closing_matrices": np.array(matrices) if any(map(moves, meshes)) else None,
        "closing_spheres": np.array(balls, np.float32) if any(map(moves, spheres)) else None,
    }
