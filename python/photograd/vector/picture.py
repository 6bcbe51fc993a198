"""Drawings to pictures, and gradients back: exact areas in place of samples.

The pixel filter is a box: a pixel holds the area that a shape covers of it. Curves become polylines
(`Flattening`), strokes become outlines, and the areas of what is left are exact, under overlaps and
self-intersections too: in each row of pixels the edges are cut where they cross, and those at which
the fill rule changes bound the area (cpp/photograd/vector/row_boundary.h). No other sum of signed
areas is right where contours overlap, as those of strokes always do. When an edge moves, the area
changes by the motion along its normal, summed over the part that bounds the shape in the pixel:
that is the derivative, with no samples and no noise. [Li2020] samples edges instead, and finds the
closest points of curves.

Where two edges lie on one another, or an edge on the border between pixels, the area has a kink;
the derivative is then that of one side.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._memory import require_room
from photograd._typed import typed_call
from photograd.types import Array, FloatArray
from photograd.vector.cost import require_affordable
from photograd.vector.drawing import (
    Drawing,
    DrawingLayout,
    DrawingParameters,
    check_shape_number,
    zeros_like,
)
from photograd.vector.flatten import Flattening, Polylines, VisibleArea

TRANSPARENT = (0.0, 0.0, 0.0, 0.0)


@typed_call
@dataclass(frozen=True, eq=False)
class RenderingGradients:
    """Derivatives of a loss.

    Attributes:
        parameters: with respect to the numbers of the drawing.
        background: (4,) with respect to the background.
    """

    parameters: DrawingParameters
    background: FloatArray


@typed_call
class Rendering:
    """A drawing with its picture, and what its gradient needs.

    Attributes:
        drawing: as given.
        picture: (H, W, 4) float64: red, green and blue times alpha, and alpha. Linear values if
            the colors are.
    """

    def __init__(
        self,
        drawing: Drawing,
        size: tuple[int, int],
        *,
        flattening: Flattening | None = None,
        background: Sequence[float] | Array = TRANSPARENT,
    ) -> None:
        """Draw.

        Args:
            drawing: its shapes in order, each over those before it.
            size: (height, width) in pixels.
            flattening: of curves; None takes the defaults.
            background: (4,) premultiplied red, green, blue, alpha.

        Raises:
            DtypeError, ShapeError, RangeError: a background that is not four finite numbers, a size
                of no or more than 2^26 pixels or beyond memory, outlines that leave the million
                pixels, edges that cross too often (PHOTOGRAD_MAX_CROSSINGS).
        """
        self._call = call = Arguments("Rendering", np.float64)
        self.drawing = drawing
        self._background = call.array("background", background, (4,))
        height, width = (call.integer("size", each, low=1, high=1 << 26) for each in size)
        parameters, layout = drawing.parameters, drawing.layout
        visible = VisibleArea(height, width, _margins(layout, parameters.widths))
        self._lines = Polylines.of(layout, parameters.points, flattening or Flattening(), visible)
        vertices = self._lines.vertices(parameters.points)
        self._strokes = self._outlined(vertices, (flattening or Flattening()).arc)
        outlines, sizes, owners = self._strokes.outlines()
        self._order, contours, shapes = self._contours(len(vertices), sizes, owners)
        everything = np.concatenate([vertices, outlines])[self._order]
        rule = np.where(layout.stroked, 0, layout.rule).astype(np.uint8)
        require_affordable(everything, contours, shapes, height, width)
        self._shapes = call.run(
            _core.VectorShapes, everything, contours, shapes, rule, height, width
        )
        require_room("Rendering", "the picture", 64 * height * width, argument="size")
        self._paints = (
            layout.kind,
            layout.stop_begin,
            parameters.opacities,
            parameters.geometry,
            parameters.offsets,
            parameters.colors,
            self._background,
        )
        self.picture: FloatArray = np.zeros((height, width, 4))
        call.run(self._shapes.draw, *self._paints, self.picture)

    def coverage(self, shape: int) -> FloatArray:
        """(H, W) the area that a shape covers of each pixel, whatever lies over it.

        Args:
            shape: its number.

        Raises:
            DtypeError, RangeError, ShapeError: no number of a shape.
        """
        shape = check_shape_number("Rendering.coverage", self.drawing, shape)
        out = np.zeros(self.picture.shape[:2])
        self._shapes.area(shape, out)
        return out

    def coverage_backward(self, shape: int, d_coverage: Array) -> DrawingParameters:
        """Derivatives of a loss through `coverage`: with respect to points and widths, others 0.

        Args:
            shape: as for `coverage`.
            d_coverage: (H, W) dL/d of what it returned.

        Raises:
            DtypeError, RangeError, ShapeError: no number of a shape, another shape of the array.
        """
        call = Arguments("Rendering.coverage_backward", np.float64)
        shape = check_shape_number(call.function, self.drawing, shape)
        d_coverage = call.array("d_coverage", d_coverage, self.picture.shape[:2])
        d_vertices = np.zeros((len(self._order), 2))
        self._shapes.area_backward(shape, d_coverage, d_vertices)
        points, widths = self._paths_backward(d_vertices)
        return replace(zeros_like(self.drawing.parameters), points=points, widths=widths)

    def backward(self, d_picture: Array) -> RenderingGradients:
        """Derivatives of a loss.

        Args:
            d_picture: (H, W, 4) dL/d of the picture.

        Raises:
            DtypeError, ShapeError, RangeError: another shape, numbers that are not finite.
        """
        call = Arguments("Rendering.backward", np.float64)
        d_picture = call.array("d_picture", d_picture, self.picture.shape)
        d_vertices, d_background = np.zeros((len(self._order), 2)), np.zeros(4)
        mine = self.drawing.parameters
        names = ("opacities", "geometry", "offsets", "colors")
        d = {name: np.zeros_like(getattr(mine, name)) for name in names}
        self._shapes.draw_backward(*self._paints, d_picture, d_vertices, *d.values(), d_background)
        points, widths = self._paths_backward(d_vertices)
        return RenderingGradients(DrawingParameters(points, widths, **d), d_background)

    def _outlined(self, vertices: FloatArray, arc: int) -> _core.VectorStrokes:
        """The subpaths of strokes; those of fills are of width 0, which have no outlines."""
        layout, shape = self.drawing.layout, self.drawing.layout.shape_of_subpath
        widths = np.where(layout.stroked, self.drawing.parameters.widths, 0.0)
        strokes: _core.VectorStrokes = self._call.run(
            _core.VectorStrokes,
            vertices,
            self._lines.corner.astype(np.uint8),
            self._lines.begin.astype(np.int64),
            layout.closed.astype(np.uint8),
            0.5 * widths[shape],
            layout.cap[shape],
            layout.join[shape],
            layout.miter_limit[shape],
            arc,
        )
        return strokes

    def _contours(
        self, vertices: int, sizes: npt.NDArray[np.int64], owners: npt.NDArray[np.int64]
    ) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], npt.NDArray[np.int64]]:
        """Contours of fills and strokes by shape: their vertices, first vertices, first contours.

        Args:
            vertices: of polylines, which come before those of outlines.
            sizes: (C,) vertices of each contour of outlines.
            owners: (C,) its subpath.
        """
        layout = self.drawing.layout
        filled = np.flatnonzero(~layout.stroked[layout.shape_of_subpath])
        size = np.concatenate([np.diff(self._lines.begin)[filled], sizes])
        first = np.concatenate(
            [self._lines.begin[filled], vertices + np.cumsum(sizes) - sizes]
        ).astype(np.int64)
        shape = layout.shape_of_subpath[np.concatenate([filled, owners])]
        by_shape = np.argsort(shape, kind="stable")
        size, first = size[by_shape], first[by_shape]
        begin = np.concatenate([[0], np.cumsum(size)]).astype(np.int64)
        order = np.repeat(first - begin[:-1], size) + np.arange(begin[-1])
        shapes = np.searchsorted(shape[by_shape], np.arange(len(layout.rule) + 1))
        return order, begin, shapes.astype(np.int64)

    def _paths_backward(self, d_vertices: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Derivatives with respect to points and widths, from those of the contours' vertices."""
        parameters, shape = self.drawing.parameters, self.drawing.layout.shape_of_subpath
        lines = len(self._lines.corner)
        outlines = len(self._strokes.outlines()[0])
        d_all = np.zeros((lines + outlines, 2))
        d_all[self._order] = d_vertices
        d_half = np.zeros(len(shape))
        d_lines = d_all[:lines].copy()
        self._strokes.backward(d_all[lines:], d_lines, d_half)
        points = self._lines.backward(d_lines, len(parameters.points))
        widths: FloatArray = np.bincount(shape, d_half, len(parameters.widths)).astype(np.float64)
        return points, 0.5 * widths


def _margins(layout: DrawingLayout, widths: FloatArray) -> FloatArray:
    """(C,) pixels that a stroke reaches beyond each curve: corners of caps, and miters."""
    reach = np.where(layout.stroked, 0.5 * widths * np.maximum(layout.miter_limit, 1.5), 0.0)
    found: FloatArray = np.repeat(reach[layout.shape_of_subpath], np.diff(layout.curve_begin)) + 1
    return found


@typed_call
def render(
    drawing: Drawing,
    size: tuple[int, int],
    *,
    flattening: Flattening | None = None,
    background: Sequence[float] | Array = TRANSPARENT,
) -> FloatArray:
    """The picture (H, W, 4) of a `Rendering`, where no gradient is needed.

    Args:
        drawing, size, flattening, background: as for a `Rendering`.

    Raises:
        DtypeError, ShapeError, RangeError: as of `Rendering`.
    """
    return Rendering(drawing, size, flattening=flattening, background=background).picture
