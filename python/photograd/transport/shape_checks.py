"""What scenes are made of, checked: places, triangles, rows of numbers, colors, materials."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

from photograd._arrays import Arguments
from photograd._registry import SPECULAR, ModelParameter
from photograd.errors import RangeError, ShapeError, message
from photograd.geometry.mesh import drop_degenerate
from photograd.types import Array

FLAT = 1e-9
"""A mesh whose volume has shrunk to less than this part is flat, as far as rounding can tell."""


def checked_instance(name: str, matrix: Any) -> Array:
    """World_from_object (4, 4) float64 of an instance of the shape `name`.

    Args:
        name: of the shape.
        matrix: (4, 4).

    Raises:
        ShapeError: another shape.
        RangeError: numbers that are not finite, a determinant that is not positive.
    """
    instance = np.array(
        Arguments("MeshShape", np.float64).array(f"{name}.instances", matrix, (4, 4))
    )
    volume = float(np.linalg.det(instance[:3, :3]))
    if not volume > 0:
        expected = "a positive determinant"
        raise RangeError(message("MeshShape", f"{name}.instances", expected, volume))
    return instance


def checked_closing_instances(
    name: str, instances: Sequence[Array], closing: Sequence[Any]
) -> tuple[Array, ...]:
    """World_from_object (4, 4) of each instance when the shutter closes.

    Args:
        name: of the shape.
        instances: world_from_object when it opens.
        closing: (4, 4) of each.

    Raises:
        ShapeError: another number of them than of instances, or what `checked_instance` refuses.
        RangeError: a mesh that would be flat or mirrored at some moment in between.
    """
    ends = tuple(checked_instance(name, matrix) for matrix in closing)
    starts = list(instances) or [np.eye(4)]
    if ends and len(ends) != len(starts):
        expected = f"{len(starts)}, one for each instance"
        raise ShapeError(message("MeshShape", f"{name}.closing_instances", expected, len(ends)))
    for start, end in zip(starts, ends, strict=False):
        least = _least_volume(start[:3, :3], end[:3, :3])
        if not least > FLAT:
            expected = "a positive determinant at every moment"
            remedy = "turn by less, points move straight on"
            raise RangeError(
                message("MeshShape", f"{name}.closing_instances", expected, least, remedy)
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


def usable_triangles(name: str, vertices: Array, faces: Array) -> tuple[Array, Array]:
    """Vertices that are all finite, and the triangles that can be hit; warns of what is dropped.

    Args:
        name: of the shape.
        vertices: (V, 3).
        faces: (F, 3).
    """
    finite = np.asarray(np.isfinite(vertices).all(axis=1))
    sound = faces[finite[faces].all(axis=1)] if len(faces) else faces
    vertices = np.where(finite[:, None], vertices, np.float32(0))
    kept = drop_degenerate(vertices, sound) if len(sound) else sound
    if len(kept) < len(faces):
        broken, flat = len(faces) - len(sound), len(sound) - len(kept)
        parts = [f"{broken} with corners that are not finite"] * (broken > 0)
        parts += [f"{flat} without area"] * (flat > 0)
        text = f"{name}: dropped {' and '.join(parts)} of {len(faces)} triangles"
        warnings.warn(text, UserWarning, stacklevel=4)
    return np.ascontiguousarray(vertices), kept


def checked_color(function: str, argument: str, value: Any) -> Array:
    """(3,) float64, a copy.

    Args:
        function: on whose behalf errors speak.
        argument: what they call the value.
        value: three numbers.

    Raises:
        ShapeError: not three numbers.
        RangeError: numbers that are negative or not finite.
    """
    return np.array(Arguments(function, np.float64).array(argument, value, (3,), low=0.0))


def check_range(model: str, parameter: ModelParameter, value: Any) -> None:
    """Whether a material may have this value: what is a share or a roughness has two ends.

    Derivatives and searches may step beyond; what somebody writes down there is a mistake, and
    draws negative or growing light. Other ranges, as of indices and exponents, say what is usual.

    Args:
        model: of reflectance.
        parameter: of the model.
        value: one number or three.

    Raises:
        RangeError: outside of the range.
    """
    least = parameter.lo if parameter.hi == 1.0 else min(parameter.lo, 0.0)
    most = parameter.hi if parameter.hi == 1.0 else np.inf
    if parameter.lo < 0 or ((np.asarray(value) >= least) & (np.asarray(value) <= most)).all():
        return
    expected = f"{least:g} to {most:g}" if most < np.inf else f"at least {least:g}"
    smooth = "roughness" in parameter.name and float(np.min(value)) < least
    remedy = SPECULAR if smooth else None
    raise RangeError(message("Material", f"{model}.{parameter.name}", expected, value, remedy))
