"""Paths, strokes, paints and shapes: what a vector drawing is made of, in pixels, y downwards.

A drawing composites the numbers that it is given. Colors are linear values unless the caller says
otherwise; viewers of SVG composite sRGB values, and `read_svg` and `write_svg` convert.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

import numpy as np

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.errors import RangeError, ShapeError, message
from photograd.types import Array, FloatArray

Cap = Literal["butt", "round", "square"]
Join = Literal["miter", "round", "bevel"]
FillRule = Literal["nonzero", "evenodd"]
CAPS: tuple[Cap, ...] = get_args(Cap)
JOINS: tuple[Join, ...] = get_args(Join)
RULES: tuple[FillRule, ...] = get_args(FillRule)
LARGEST = 1e6
"""Pixels: coordinates and widths beyond it are refused."""
CIRCLE = 0.5522847498307936
"""4/3 (sqrt(2) - 1): a quarter of the unit circle as a cubic Bezier, off by 2.7e-4 at most."""


@typed_call
@dataclass(frozen=True, eq=False)
class Subpath:
    """Bezier curves that follow one another; neighbors share an end.

    Attributes:
        points: (K, 2) control points in pixels, y downwards.
        degrees: of each curve: 1 a line, 2 quadratic, 3 cubic. An open subpath has one point more
            than the sum of the degrees; of a closed one the last curve ends at the first point.
        closed: whether a stroke joins the ends. A fill closes an open subpath with a line.
    """

    points: FloatArray
    degrees: tuple[int, ...]
    closed: bool = False

    def __post_init__(self) -> None:
        """Check and convert the fields.

        Raises:
            DtypeError, ShapeError, RangeError: points that are not finite, not within a million
                pixels, not as many as the degrees need; degrees other than 1, 2 and 3.
        """
        call = Arguments("Subpath", np.float64)
        points = call.array("points", self.points, ("K", 2), low=-LARGEST, high=LARGEST)
        degrees = tuple(call.integer("degrees", d, low=1, high=3) for d in self.degrees)
        needed = sum(degrees) + (not self.closed)
        if len(points) != needed:
            expected = f"{needed} points for degrees that sum up to {sum(degrees)}"
            raise ShapeError(message("Subpath", "points", expected, len(points)))
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "degrees", degrees)

    @classmethod
    def lines(cls, points: Array | Sequence[Sequence[float]], *, closed: bool = False) -> Subpath:
        """Straight lines.

        Args:
            points: (K, 2).
            closed: adds a line from the last to the first.
        """
        points = Arguments("Subpath", np.float64).array("points", points, ("K", 2))
        count = len(points)
        return cls(points, (1,) * (count if closed else max(count - 1, 0)), closed)

    @classmethod
    def circle(cls, center: Sequence[float], radius: float) -> Subpath:
        """Four cubic curves, clockwise as the picture shows them.

        Args:
            center: (x, y) in pixels.
            radius: in pixels.
        """
        call = Arguments("Subpath.circle", np.float64)
        middle = call.array("center", center, (2,), low=-LARGEST, high=LARGEST)
        call.number("radius", radius, low=0, high=LARGEST)
        c = CIRCLE
        quarter = np.array([[1.0, 0], [1, c], [c, 1]])
        turns = [np.array(rows) for rows in ([[1, 0], [0, 1]], [[0, 1], [-1, 0]])]
        turns += [-turn for turn in turns]
        unit = np.concatenate([np.einsum("ni,ij->nj", quarter, turn) for turn in turns])
        return cls(middle + radius * unit, (3, 3, 3, 3), closed=True)


@typed_call
@dataclass(frozen=True)
class Stroke:
    """A pen that follows a path.

    Attributes:
        width: in pixels; 0 draws nothing, and has the derivative 0 with respect to everything.
        cap: at the ends of open subpaths. A subpath without length draws nothing, caps included.
        join: at corners, where curves of a subpath meet. Inside a curve it is always round.
        miter_limit: the longest miter over the width, at least 1; beyond it the join is a bevel.
    """

    width: float
    cap: Cap = "butt"
    join: Join = "miter"
    miter_limit: float = 4.0

    def __post_init__(self) -> None:
        """Check the fields.

        Raises:
            DtypeError, RangeError: numbers out of range, names that are no cap or join.
        """
        call = Arguments("Stroke")
        call.number("width", self.width, low=0, high=LARGEST)
        call.number("miter_limit", self.miter_limit, low=1)
        check_choice("Stroke", "cap", self.cap, CAPS)
        check_choice("Stroke", "join", self.join, JOINS)


@typed_call
@dataclass(frozen=True, eq=False)
class Solid:
    """One color everywhere.

    Attributes:
        color: (3,) red, green, blue.
        alpha: 0 to 1.
    """

    color: FloatArray
    alpha: float = 1.0

    def __post_init__(self) -> None:
        """Check and convert the fields.

        Raises:
            DtypeError, ShapeError, RangeError: not three finite numbers, an alpha out of range.
        """
        call = Arguments("Solid", np.float64)
        object.__setattr__(self, "color", call.array("color", self.color, (3,)))
        call.number("alpha", self.alpha, low=0, high=1)


@typed_call
@dataclass(frozen=True, eq=False)
class LinearGradient:
    """Colors along the line from `start` to `end`, constant across it and beyond its ends.

    Attributes:
        start, end: (2,) pixels.
        offsets: (K,) from 0 at the start to 1 at the end; they do not fall.
        colors: (K, 4) red, green, blue, alpha at the stops, not premultiplied; between the stops
            each of the four is blended on its own.
    """

    start: FloatArray
    end: FloatArray
    offsets: FloatArray
    colors: FloatArray

    def __post_init__(self) -> None:
        """Check and convert the fields.

        Raises:
            DtypeError, ShapeError, RangeError: other shapes, numbers out of range.
        """
        call = Arguments("LinearGradient", np.float64)
        for name in ("start", "end"):
            point = call.array(name, getattr(self, name), (2,), low=-LARGEST, high=LARGEST)
            object.__setattr__(self, name, point)
        _check_stops(self, call)


@typed_call
@dataclass(frozen=True, eq=False)
class RadialGradient:
    """Colors by the distance from `center`, over `radius`; constant beyond it.

    Attributes:
        center: (2,) pixels.
        radius: pixels; with 0 the color is that of the last stop.
        offsets: (K,) from 0 at the center to 1 at the radius; they do not fall.
        colors: (K, 4), as of a `LinearGradient`.
    """

    center: FloatArray
    radius: float
    offsets: FloatArray
    colors: FloatArray

    def __post_init__(self) -> None:
        """Check and convert the fields.

        Raises:
            DtypeError, ShapeError, RangeError: other shapes, numbers out of range.
        """
        call = Arguments("RadialGradient", np.float64)
        center = call.array("center", self.center, (2,), low=-LARGEST, high=LARGEST)
        object.__setattr__(self, "center", center)
        call.number("radius", self.radius, low=0, high=LARGEST)
        _check_stops(self, call)


Paint = Solid | LinearGradient | RadialGradient


@typed_call
@dataclass(frozen=True, eq=False)
class Shape:
    """A path that is filled, or stroked where `stroke` is given; for both take two shapes.

    Attributes:
        subpaths: of the path; none, or ones without area, draw nothing.
        paint: taken at the centers of pixels.
        opacity: 0 to 1; multiplies the alpha of the paint.
        rule: of a fill: where subpaths overlap. A stroke is the union of its parts.
        stroke: None fills.
    """

    subpaths: tuple[Subpath, ...]
    paint: Paint = field(default_factory=lambda: Solid(np.zeros(3)))
    opacity: float = 1.0
    rule: FillRule = "nonzero"
    stroke: Stroke | None = None

    def __post_init__(self) -> None:
        """Check the fields.

        Raises:
            DtypeError, RangeError: an opacity out of range, a name that is no fill rule.
        """
        Arguments("Shape").number("opacity", self.opacity, low=0, high=1)
        check_choice("Shape", "rule", self.rule, RULES)
        object.__setattr__(self, "subpaths", tuple(self.subpaths))


def check_choice(function: str, argument: str, value: object, choices: Sequence[str]) -> None:
    """Refuse what is none of some choices.

    Args:
        function, argument: for the error.
        value: what was given.
        choices: what there is.

    Raises:
        RangeError: names them.
    """
    if value not in choices:
        expected = " or ".join(repr(choice) for choice in choices)
        raise RangeError(message(function, argument, expected, repr(value)))


def _check_stops(paint: Any, call: Arguments) -> None:
    offsets = call.array("offsets", paint.offsets, ("K",), min_length=1, low=0, high=1)
    colors = call.array("colors", paint.colors, ("K", 4))
    if (np.diff(offsets) < 0).any():
        expected = "offsets that do not fall"
        raise RangeError(message(call.function, "offsets", expected, offsets.tolist()))
    call.array("alpha of colors", colors[:, 3], ("K",), low=0, high=1)
    object.__setattr__(paint, "offsets", offsets)
    object.__setattr__(paint, "colors", colors)
