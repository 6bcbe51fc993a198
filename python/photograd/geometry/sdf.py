"""Signed distance functions: shapes, how they combine, and where rays meet them [Hart1996].

A shape is a description; `Body` makes it ready to be asked. All numbers of a body (radii, places)
are in one array, `Body.numbers`, to be printed, changed and fitted. The mathematics is in
cpp/photograd/ops/sdf_shapes.h, cpp/photograd/ops/sdf_combine.h and
cpp/photograd/geometry/reference/sphere_trace.h.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from photograd_course.checks import require_integer, require_number

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.errors import RangeError, message
from photograd.geometry.checks import checked_interval, checked_rays
from photograd.types import Array

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
    """A ball of a radius in meters."""
    return Shape("sphere", (_length("sphere", "radius", radius),))


def box(half_sizes: Any) -> Shape:
    """A box that reaches half_sizes (3,) meters to each side."""
    half = _three("box", "half_sizes", half_sizes)
    return Shape("box", tuple(_length("box", "half_sizes", x) for x in half))


def rounded_box(half_sizes: Any, radius: float) -> Shape:
    """A box as large as `box` makes it, its edges rounded to `radius` meters.

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
    """A ring around the Y axis: a tube of radius `tube` at the distance `ring`, both in meters."""
    return Shape("torus", (_length("torus", "ring", ring), _length("torus", "tube", tube)))


def plane(normal: Any, height: float) -> Shape:
    """Everything below a plane: `normal` (3,) points out of it, `height` meters from the origin."""
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
    """Both together, the seam filled and rounded where it is within `width` meters of both."""
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
    """A shape swollen by `radius` meters, which rounds its edges."""
    return Shape("rounded", (_length("rounded", "radius", radius),), (shape,))


def _length(function: str, argument: str, value: float) -> float:
    return require_number(function, argument, value, least=0.0, open_ends=True)


def _three(function: str, argument: str, value: Any) -> tuple[float, ...]:
    return _numbers(function, argument, value, 3)


def _numbers(function: str, argument: str, value: Sequence[float], count: int) -> tuple[float, ...]:
    return tuple(Arguments(function, np.float64).array(argument, value, (count,)).tolist())


# Signed distance functions: shapes, how they combine, and where rays meet them [Hart1996].


MISSED, HIT, GAVE_UP = 0, 1, 2


@typed_call
@dataclass(frozen=True, eq=False)
class SdfHits:
    """Where R rays met a body.

    Attributes:
        t: (R,) distance in lengths of the direction; infinite where the body was missed. Where the
            march gave up, how far the way is known to be free.
        steps: (R,) int32, how often the distance was asked.
        end: (R,) int8, MISSED, HIT or GAVE_UP (after max_steps).
        march: t_min, t_max, tolerance and max_steps, for `Body.trace_backward`.
    """

    t: Array
    steps: npt.NDArray[np.int32]
    end: npt.NDArray[np.int8]
    march: tuple[float, float, float, int]

    @property
    def hit(self) -> npt.NDArray[np.bool_]:
        """(R,) whether the body was met."""
        return np.asarray(self.end == HIT)


@typed_call
class Body:
    """A shape, ready to be asked.

    Attributes:
        numbers: (P,) float64, the parameters of all shapes; change them freely.
        names: (P,) what each of them is, such as "sphere 0: radius".
    """

    def __init__(self, shape: Shape) -> None:
        """Lay out the tree.

        Raises:
            RangeError: a tree deeper than 256.
        """
        rows: list[tuple[int, int, int, int]] = []
        values: list[float] = []
        names: list[str] = []
        for number, (node, children) in enumerate(_postorder(shape)):
            kind = list(KINDS).index(node.kind)
            first, second = (*children, -1, -1)[:2]
            rows.append((kind, first, second, len(values)))
            values.extend(node.numbers)
            names.extend(f"{node.kind} {number}: {name}" for name in KINDS[node.kind])
        self._core = _core.Sdf(np.array(rows, np.int32))
        self.numbers: Array = np.array(values, np.float64)
        self.names = tuple(names)

    @property
    def parts(self) -> tuple[_core.Sdf, Array]:
        """The tree and a copy of the numbers (P,), as other parts of the core take them."""
        return self._core, self._numbers().copy()

    @property
    def box(self) -> Array:
        """(2, 3) lower and upper corner of a box around the body, meters.

        It is the tightest for shapes on their own; what a difference takes away, and where an
        intersection's parts do not reach their boxes, it does not see.

        Raises:
            SceneError: a body that is empty, or has no end.
        """
        found: Array = self._core.bounds(self._numbers())
        return found

    def distance(self, points: Any) -> Array:
        """Distances f (N,) in meters, negative inside; the surface is never nearer than |f|.

        Args:
            points: (N, 3), m.

        Raises:
            ShapeError, RangeError: points that are not (N, 3) or not finite; numbers that have
                become useless, such as a radius of 0.
        """
        call = Arguments("Body.distance", np.float64)
        rows = call.array("points", points, ("N", 3))
        found: Array = call.run(self._core.distance, self._numbers(), rows)
        return found

    def distance_backward(self, points: Any, d_f: Any) -> tuple[Array, Array]:
        """dL/dpoints (N, 3) and dL/dnumbers (P,) of d_f (N,)."""
        call = Arguments("Body.distance_backward", np.float64)
        rows = call.array("points", points, ("N", 3))
        d_points, d_numbers = np.zeros_like(rows), np.zeros_like(self.numbers)
        weights = call.array("d_f", d_f, ("N",), finite=False, low=-np.inf)
        call.run(self._core.distance_backward, self._numbers(), rows, weights, d_points, d_numbers)
        return d_points, d_numbers

    def normals(self, points: Any) -> Array:
        """Unit gradients of the distance (N, 3), which point out of the surface; 0 in a center."""
        rows = Arguments("Body.normals", np.float64).array("points", points, ("N", 3))
        gradient, _ = self.distance_backward(rows, np.ones(len(rows)))
        size = np.linalg.norm(gradient, axis=1, keepdims=True)
        return np.asarray(gradient / np.where(size > 0.0, size, 1.0))

    def trace(
        self,
        origins: Any,
        directions: Any,
        *,
        t_min: float = 0.0,
        t_max: float = 1e3,
        tolerance: float = 1e-6,
        max_steps: int = 1000,
    ) -> SdfHits:
        """Where each ray first meets the body, by steps of the distance.

        Args:
            origins, directions: (R, 3); directions of any length but 0. A ray that starts inside
                has its hit at t_min.
            t_min, t_max: in lengths of the direction; t_max must be finite.
            tolerance: m; nearer than this counts as a hit, and is then improved to rounding.
            max_steps: after which a ray gives up; grazing rays take many.

        Raises:
            ShapeError, RangeError: rays that are none, or options out of range.
        """
        call = Arguments("Body.trace", np.float64)
        rays = checked_rays(call, origins, directions)
        low, high = checked_interval(call, t_min, t_max)
        require_number("trace", "t_max", high)
        require_number("trace", "tolerance", tolerance, least=0.0, open_ends=True)
        require_integer("trace", "max_steps", max_steps, least=1, most=1 << 20)
        march = (low, high, float(tolerance), int(max_steps))
        t, steps, end = self._core.trace(self._numbers(), *rays, march)
        return SdfHits(t, steps, end, march)

    def trace_backward(
        self, origins: Any, directions: Any, hits: SdfHits, d_t: Any
    ) -> tuple[Array, Array, Array]:
        """dL/dnumbers (P,), dL/dorigins and dL/ddirections (R, 3) of d_t (R,).

        Interior term only: that a ray at a silhouette may come to miss is not in it. Rows that did
        not end in a hit beyond t_min count for nothing.

        Raises:
            RangeError: as `trace`.
            ShapeError: as `trace`, and for hits or d_t of other rays.
        """
        call = Arguments("Body.trace_backward", np.float64)
        rays = checked_rays(call, origins, directions)
        weights = call.array("d_t", d_t, ("R",), finite=False, low=-np.inf)
        t = call.array("hits.t", hits.t, ("R",), finite=False, low=-np.inf)
        d_numbers = np.zeros_like(self.numbers)
        d_origins, d_directions = np.zeros_like(rays[0]), np.zeros_like(rays[1])
        self._core.trace_backward(
            self._numbers(),
            *rays,
            hits.march,
            t,
            hits.end,
            weights,
            d_numbers,
            d_origins,
            d_directions,
        )
        return d_numbers, d_origins, d_directions

    def _numbers(self) -> Array:
        return np.ascontiguousarray(self.numbers, np.float64)


def _postorder(shape: Shape) -> list[tuple[Shape, tuple[int, ...]]]:
    """All shapes of the tree, children first, with the numbers of theirs."""
    found: list[tuple[Shape, tuple[int, ...]]] = []
    waiting: list[tuple[Shape, bool]] = [(shape, False)]  # no recursion: chains may be long
    done: list[int] = []
    while waiting:
        node, opened = waiting.pop()
        if not opened and node.children:
            waiting.append((node, True))
            waiting.extend((child, False) for child in reversed(node.children))
            continue
        keep = len(done) - len(node.children)
        children = tuple(done[keep:])
        del done[keep:]
        done.append(len(found))
        found.append((node, children))
    return found
