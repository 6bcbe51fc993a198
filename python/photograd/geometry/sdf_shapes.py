"""What a body of signed distances can be made of.

Shapes stand at the origin; `placed` and `scaled` put them elsewhere. All functions return a new
description and leave their arguments alone; one description may be used several times, each time
with numbers of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from photograd_course.checks import require_number

from photograd.errors import RangeError, ShapeError, message

QUATERNION, SHIFT = ("w", "x", "y", "z"), ("shift x", "shift y", "shift z")
# In the order of the core's SdfKind: the names of the numbers of each.
KINDS: dict[str, tuple[str, ...]] = {
    "sphere": ("radius",),
    "plane": ("normal x", "normal y", "normal z", "height"),
    "torus": ("ring", "tube"),
    "box": ("half x", "half y", "half z"),
    "capsule": ("half length", "radius"),
    "union": (),
    "intersection": (),
    "difference": (),
    "smooth_union": ("width",),
    "placed": (*QUATERNION, *SHIFT),
    "scaled": ("factor",),
    "rounded": ("radius",),
}


@dataclass(frozen=True)
class Shape:
    """A node of the tree; made by the functions below.

    Attributes:
        kind: one of KINDS.
        numbers: its own, in the order of KINDS.
        children: what it is made of.
    """

    kind: str
    numbers: tuple[float, ...] = ()
    children: tuple[Shape, ...] = ()


def sphere(radius: float) -> Shape:
    """A ball of a radius in metres."""
    return Shape("sphere", (_length("sphere", "radius", radius),))


def box(half_sizes: Any) -> Shape:
    """A box that reaches half_sizes (3,) metres to each side."""
    half = _three("box", "half_sizes", half_sizes)
    return Shape("box", tuple(_length("box", "half_sizes", x) for x in half))


def rounded_box(half_sizes: Any, radius: float) -> Shape:
    """A box as large as `box` makes it, its edges rounded to `radius` metres.

    Raises:
        RangeError: a radius that is not below all half sizes.
    """
    half = np.asarray(_three("rounded_box", "half_sizes", half_sizes))
    _length("rounded_box", "radius", radius)
    if not radius < half.min():
        expected = f"less than the half sizes, the least of which is {half.min()} m"
        raise RangeError(message("rounded_box", "radius", expected, radius))
    return rounded(box(half - radius), radius)


def capsule(half_length: float, radius: float) -> Shape:
    """A rod along the Y axis with round ends: all within `radius` m of a line of 2 half_length."""
    return Shape(
        "capsule",
        (_length("capsule", "half_length", half_length), _length("capsule", "radius", radius)),
    )


def torus(ring: float, tube: float) -> Shape:
    """A ring around the Y axis: a tube of radius `tube` at the distance `ring`, both in metres."""
    return Shape("torus", (_length("torus", "ring", ring), _length("torus", "tube", tube)))


def plane(normal: Any, height: float) -> Shape:
    """Everything below a plane: `normal` (3,) points out of it, `height` metres from the origin."""
    way = _three("plane", "normal", normal)
    if not any(way):
        raise RangeError(message("plane", "normal", "some length", way))
    return Shape("plane", (*way, require_number("plane", "height", height)))


def union(*shapes: Shape) -> Shape:
    """All of them together; where they overlap there is no surface."""
    if not shapes:
        raise RangeError(message("union", "shapes", "at least one", "none"))
    half = len(shapes) // 2  # halves, not a chain: the tree stays low
    if half == 0:
        return shapes[0]
    return Shape("union", (), (union(*shapes[:half]), union(*shapes[half:])))


def intersection(a: Shape, b: Shape) -> Shape:
    """What both have in common."""
    return Shape("intersection", (), (a, b))


def difference(a: Shape, b: Shape) -> Shape:
    """The first without what the second takes away."""
    return Shape("difference", (), (a, b))


def smooth_union(a: Shape, b: Shape, width: float) -> Shape:
    """Both together, the seam filled and rounded where it is within `width` metres of both."""
    return Shape("smooth_union", (_length("smooth_union", "width", width),), (a, b))


def placed(shape: Shape, shift: Any = (0, 0, 0), quat: Any = (1, 0, 0, 0)) -> Shape:
    """A shape turned by `quat` (w, x, y, z), of any length but 0, then moved by `shift` (3,), m."""
    turn = _numbers("placed", "quat", quat, 4)
    if not any(turn):
        raise RangeError(message("placed", "quat", "some length", turn))
    return Shape("placed", (*turn, *_three("placed", "shift", shift)), (shape,))


def scaled(shape: Shape, factor: float) -> Shape:
    """A shape made larger by a factor, as seen from its origin."""
    return Shape("scaled", (_length("scaled", "factor", factor),), (shape,))


def rounded(shape: Shape, radius: float) -> Shape:
    """A shape swollen by `radius` metres, which rounds its edges."""
    return Shape("rounded", (_length("rounded", "radius", radius),), (shape,))


def _length(function: str, argument: str, value: float) -> float:
    return require_number(function, argument, value, least=0.0, open_ends=True)


def _three(function: str, argument: str, value: Any) -> tuple[float, ...]:
    return _numbers(function, argument, value, 3)


def _numbers(function: str, argument: str, value: Sequence[float], count: int) -> tuple[float, ...]:
    if np.shape(value) != (count,):
        raise ShapeError(message(function, argument, f"shape ({count},)", np.shape(value)))
    return tuple(require_number(function, argument, float(x)) for x in value)
