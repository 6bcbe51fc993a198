"""A drawing as arrays: what is optimized, and what stays as it is.

drawing = Drawing.of([Shape(...), Shape(...)])
drawing.parameters.points  # (P, 2), of all shapes
moved = drawing.with_parameters(replace(drawing.parameters, points=points))
moved.shapes  # again as shapes
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.errors import ShapeError, message
from photograd.types import Array, FloatArray
from photograd.vector.shapes import (
    CAPS,
    JOINS,
    LARGEST,
    RULES,
    LinearGradient,
    Paint,
    RadialGradient,
    Shape,
    Solid,
    Stroke,
    Subpath,
)

KINDS = (Solid, LinearGradient, RadialGradient)
"""Paints, by the number that the core gives them."""


@typed_call
@dataclass(frozen=True, eq=False)
class DrawingParameters:
    """All numbers of a drawing with respect to which it can be differentiated, or derivatives.

    Attributes:
        points: (P, 2) control points, in pixels.
        widths: (S,) of strokes, in pixels; of a fill 1, and without effect.
        opacities: (S,).
        geometry: (S, 4) of gradients: start and end, or center, radius and an unused number; of
            other paints without effect.
        offsets: (K,) of all stops; a solid paint has one, whose offset is without effect.
        colors: (K, 4) of all stops: red, green, blue, alpha.
    """

    points: FloatArray
    widths: FloatArray
    opacities: FloatArray
    geometry: FloatArray
    offsets: FloatArray
    colors: FloatArray

    def arrays(self) -> dict[str, FloatArray]:
        """By name."""
        return {each.name: getattr(self, each.name) for each in fields(self)}


@typed_call
@dataclass(frozen=True, eq=False)
class DrawingLayout:
    """What a drawing's numbers mean; C curves, L subpaths, S shapes.

    Attributes:
        degree: (C,).
        control: (C, 4) rows of `points`; past its end a curve repeats its last.
        curve_begin: (L + 1,) first curve of each subpath.
        point_begin: (L + 1,) first point of each subpath.
        closed: (L,) bool.
        subpath_begin: (S + 1,) first subpath of each shape.
        rule, stroked, cap, join, kind: (S,) uint8, numbers in RULES, CAPS, JOINS, KINDS.
        miter_limit: (S,).
        stop_begin: (S + 1,) first stop of each shape.
    """

    degree: npt.NDArray[np.int64]
    control: npt.NDArray[np.int64]
    curve_begin: npt.NDArray[np.int64]
    point_begin: npt.NDArray[np.int64]
    closed: npt.NDArray[np.bool_]
    subpath_begin: npt.NDArray[np.int64]
    rule: npt.NDArray[np.uint8]
    stroked: npt.NDArray[np.bool_]
    cap: npt.NDArray[np.uint8]
    join: npt.NDArray[np.uint8]
    kind: npt.NDArray[np.uint8]
    miter_limit: FloatArray
    stop_begin: npt.NDArray[np.int64]

    @property
    def shape_of_subpath(self) -> npt.NDArray[np.int64]:
        """(L,)."""
        return np.repeat(np.arange(len(self.rule)), np.diff(self.subpath_begin))


@typed_call
@dataclass(frozen=True, eq=False)
class Drawing:
    """Shapes, the first at the bottom.

    Attributes:
        layout: what stays as it is.
        parameters: what can be optimized.
    """

    layout: DrawingLayout
    parameters: DrawingParameters

    @classmethod
    def of(cls, shapes: Iterable[Shape]) -> Drawing:
        """The arrays of `shapes`; there may be none."""
        shapes = list(shapes)
        subpaths = [path for shape in shapes for path in shape.subpaths]
        strokes = [shape.stroke or Stroke(1.0) for shape in shapes]
        rows = [_paint_rows(shape.paint) for shape in shapes]
        points = _stacked([path.points for path in subpaths], (0, 2))
        layout = DrawingLayout(
            degree=np.array([d for path in subpaths for d in path.degrees], np.int64),
            control=_controls(subpaths),
            curve_begin=_begins([len(path.degrees) for path in subpaths]),
            point_begin=_begins([len(path.points) for path in subpaths]),
            closed=np.array([path.closed for path in subpaths], bool),
            subpath_begin=_begins([len(shape.subpaths) for shape in shapes]),
            rule=np.array([RULES.index(shape.rule) for shape in shapes], np.uint8),
            stroked=np.array([shape.stroke is not None for shape in shapes], bool),
            cap=np.array([CAPS.index(stroke.cap) for stroke in strokes], np.uint8),
            join=np.array([JOINS.index(stroke.join) for stroke in strokes], np.uint8),
            kind=np.array([KINDS.index(type(shape.paint)) for shape in shapes], np.uint8),
            miter_limit=np.array([stroke.miter_limit for stroke in strokes], np.float64),
            stop_begin=_begins([len(offsets) for _, offsets, _ in rows]),
        )
        parameters = DrawingParameters(
            points=points,
            widths=np.array([stroke.width for stroke in strokes], np.float64),
            opacities=np.array([shape.opacity for shape in shapes], np.float64),
            geometry=np.array([geometry for geometry, _, _ in rows], np.float64).reshape(-1, 4),
            offsets=_stacked([offsets for _, offsets, _ in rows], (0,)),
            colors=_stacked([colors for _, _, colors in rows], (0, 4)),
        )
        return cls(layout, parameters)

    def with_parameters(self, parameters: DrawingParameters) -> Drawing:
        """The same shapes with other numbers.

        Args:
            parameters: of the shapes of arrays that mine have.

        Raises:
            DtypeError, ShapeError, RangeError: other shapes of arrays, numbers that are not finite,
                widths below 0.
        """
        call = Arguments("Drawing.with_parameters", np.float64)
        checked = {}
        for name, mine in self.parameters.arrays().items():
            bound = LARGEST if name in ("points", "widths", "geometry") else None
            low = 0.0 if name == "widths" else -bound if bound else None
            value = getattr(parameters, name)
            checked[name] = call.array(name, value, mine.shape, low=low, high=bound)
        return Drawing(self.layout, DrawingParameters(**checked))

    @property
    def shapes(self) -> list[Shape]:
        """As a list, the first at the bottom; opacities and alphas are cut off at 0 and 1.

        Raises:
            RangeError: offsets of stops that fall.
        """
        layout, all_of = self.layout, self.parameters
        found = []
        for s in range(len(layout.rule)):
            first, end = layout.subpath_begin[s : s + 2]
            stroke = None
            if layout.stroked[s]:
                cap, join = CAPS[layout.cap[s]], JOINS[layout.join[s]]
                stroke = Stroke(float(all_of.widths[s]), cap, join, float(layout.miter_limit[s]))
            found.append(
                Shape(
                    tuple(self._subpath(k) for k in range(first, end)),
                    self._paint(s),
                    float(np.clip(all_of.opacities[s], 0, 1)),
                    RULES[layout.rule[s]],
                    stroke,
                )
            )
        return found

    def _subpath(self, k: int) -> Subpath:
        layout = self.layout
        points = self.parameters.points[layout.point_begin[k] : layout.point_begin[k + 1]]
        degrees = layout.degree[layout.curve_begin[k] : layout.curve_begin[k + 1]]
        return Subpath(points.copy(), tuple(degrees.tolist()), bool(layout.closed[k]))

    def _paint(self, s: int) -> Paint:
        stops = slice(self.layout.stop_begin[s], self.layout.stop_begin[s + 1])
        geometry = self.parameters.geometry[s]
        offsets, colors = (
            getattr(self.parameters, each)[stops].copy() for each in ("offsets", "colors")
        )
        colors[:, 3] = np.clip(colors[:, 3], 0, 1)
        kind = KINDS[self.layout.kind[s]]
        if kind is Solid:
            return Solid(colors[0, :3], float(colors[0, 3]))
        offsets = np.clip(offsets, 0, 1)
        if kind is LinearGradient:
            return LinearGradient(geometry[:2].copy(), geometry[2:].copy(), offsets, colors)
        return RadialGradient(geometry[:2].copy(), max(float(geometry[2]), 0.0), offsets, colors)


def joined(drawings: Iterable[Drawing]) -> Drawing:
    """The shapes of all `drawings`, in their order."""
    return Drawing.of(shape for drawing in drawings for shape in drawing.shapes)


def zeros_like(parameters: DrawingParameters) -> DrawingParameters:
    """Zeros, of the shapes of all `parameters`."""
    zeros = {name: np.zeros_like(array) for name, array in parameters.arrays().items()}
    return replace(parameters, **zeros)


def check_shape_number(function: str, drawing: Drawing, shape: int) -> int:
    """The number of a shape, checked.

    Args:
        function: on whose behalf errors speak.
        drawing: that has it.
        shape: its number.

    Raises:
        DtypeError, RangeError, ShapeError: no number of one.
    """
    count = len(drawing.layout.rule)
    if not count:
        raise ShapeError(message(function, "drawing", "shapes", "none"))
    return Arguments(function).integer("shape", shape, low=0, high=count - 1)


def _begins(counts: list[int]) -> npt.NDArray[np.int64]:
    return np.concatenate([[0], np.cumsum(np.array(counts, np.int64))]).astype(np.int64)


def _stacked(arrays: list[Array], empty: tuple[int, ...]) -> FloatArray:
    return np.concatenate(arrays) if arrays else np.zeros(empty)


def _controls(subpaths: list[Subpath]) -> npt.NDArray[np.int64]:
    rows, base = [], 0
    for path in subpaths:
        first, count = 0, len(path.points)
        for degree in path.degrees:
            rows.append([base + (first + min(k, degree)) % count for k in range(4)])
            first += degree
        base += count
    return np.array(rows, np.int64).reshape(-1, 4)


def _paint_rows(paint: Paint) -> tuple[list[float], FloatArray, FloatArray]:
    """Geometry (4,), offsets (K,), colors (K, 4)."""
    if isinstance(paint, Solid):
        return [0.0] * 4, np.zeros(1), np.append(paint.color, paint.alpha)[None]
    if isinstance(paint, LinearGradient):
        return [*paint.start, *paint.end], paint.offsets, paint.colors
    return [*paint.center, paint.radius, 0.0], paint.offsets, paint.colors
