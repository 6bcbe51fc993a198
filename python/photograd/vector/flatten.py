"""Curves as polylines, and the adjoint.

A Bezier curve of degree d is the sum of its control points with the weights of Bernstein,

    B_k(t) = binomial(d, k) t^k (1 - t)^(d - k)

so points at fixed t are linear in the control points: d_P_k += B_k(t) g. With n pieces of equal
length in t, a polyline is off by at most M d (d - 1) / (8 n^2), where M is the longest second
difference P_k - 2 P_(k+1) + P_(k+2): its error falls with the square of n, and n from a tolerance
needs no search.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.types import FloatArray
from photograd.vector.drawing import DrawingLayout

BINOMIALS = np.array([[1, 0, 0, 0], [1, 1, 0, 0], [1, 2, 1, 0], [1, 3, 3, 1]], np.float64)
MOST_SEGMENTS = 1024
"""Of one curve."""
MANY_SEGMENTS = 64
"""Of more than these, a curve keeps those that a picture can see."""
CHUNK = 1 << 18
"""Vertices that are looked at together."""


@typed_call
@dataclass(frozen=True)
class Flattening:
    """How finely curves become polylines.

    Attributes:
        tolerance: pixels by which a polyline may be off its curve; chooses the segments of each.
        segments: of every curve, in place of a tolerance. A gradient holds the numbers of segments.
        arc: straight pieces that stand for half a circle, in round caps and joins.
    """

    tolerance: float = 0.05
    segments: int | None = None
    arc: int = 16

    def __post_init__(self) -> None:
        """Check the fields.

        Raises:
            DtypeError, RangeError: numbers out of range.
        """
        call = Arguments("Flattening")
        call.number("tolerance", self.tolerance, above=0)
        if self.segments is not None:
            call.integer("segments", self.segments, low=1, high=MOST_SEGMENTS)
        call.integer("arc", self.arc, low=1, high=MOST_SEGMENTS)


@dataclass(frozen=True, eq=False)
class VisibleArea:
    """What a picture can see of curves.

    Attributes:
        height, width: of the picture, in pixels.
        margin: (C,) pixels by which each curve's shape reaches beyond the curve.
    """

    height: int
    width: int
    margin: FloatArray

    def sides(self, at: FloatArray, margin: FloatArray) -> npt.NDArray[np.int8]:
        """(V,) 1 to 4 for points left, right, above and below of what is visible, 0 for others.

        Args:
            at: (V, 2) points.
            margin: (V,) of the curve of each.
        """
        x, y = at.T
        left, right = x < -margin, x > self.width + margin
        above, below = y < -margin, y > self.height + margin
        found: npt.NDArray[np.int8] = np.select([left, right, above, below], [1, 2, 3, 4], 0)
        return found.astype(np.int8)


@dataclass(frozen=True, eq=False)
class Polylines:
    """The polylines of a drawing's subpaths, as weights of its control points.

    Attributes:
        control: (V, 4) rows of `points` that each vertex depends on.
        weight: (V, 4) their weights.
        begin: (L + 1,) first vertex of each subpath.
        corner: (V,) whether a vertex is an end of a curve.
    """

    control: npt.NDArray[np.int64]
    weight: FloatArray
    begin: npt.NDArray[np.int64]
    corner: npt.NDArray[np.bool_]

    @classmethod
    def of(
        cls,
        layout: DrawingLayout,
        points: FloatArray,
        flattening: Flattening,
        visible: VisibleArea | None = None,
    ) -> Polylines:
        """Of all subpaths; of a closed one, the first vertex is not repeated at its end.

        Args:
            layout: of the drawing.
            points: (P, 2) its control points.
            flattening: how finely.
            visible: leaves out what lies beyond one side of a picture, where it is many; None keeps
                everything.
        """
        count = segment_counts(layout, points, flattening)
        filled = np.diff(layout.curve_begin) > 0
        last = layout.curve_begin[1:][filled & ~layout.closed] - 1  # their ends are vertices, too
        vertices = count.copy()
        vertices[last] += 1
        # A single point without curves is no line, and has no vertices.
        kept = _kept_vertices(layout, points, count, vertices, visible)
        curve, number = (np.concatenate(each) for each in zip(*kept, strict=True))
        begin = np.searchsorted(curve, np.arange(len(count) + 1))
        t = number / count[curve]
        return cls(
            layout.control[curve],
            bernstein(layout.degree[curve], t),
            begin[layout.curve_begin],
            (number == 0) | (number == count[curve]),
        )

    def vertices(self, points: FloatArray) -> FloatArray:
        """(V, 2) from control points (P, 2)."""
        found: FloatArray = np.einsum("vk,vki->vi", self.weight, points[self.control])
        return found

    def backward(self, d_vertices: FloatArray, points: int) -> FloatArray:
        """dL/dpoints (P, 2); sums in the order of the vertices.

        Args:
            d_vertices: (V, 2) dL/d of the vertices.
            points: how many control points there are.
        """
        rows = self.control.reshape(-1)
        found = [
            np.bincount(rows, (self.weight * d_vertices[:, i : i + 1]).reshape(-1), points)
            for i in range(2)
        ]
        return np.stack(found, axis=1)


def _kept_vertices(
    layout: DrawingLayout,
    points: FloatArray,
    count: npt.NDArray[np.int64],
    vertices: npt.NDArray[np.int64],
    visible: VisibleArea | None,
) -> Iterator[tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]]:
    """Curve and number of each vertex, a chunk of curves after the other.

    A vertex between neighbors that lie beyond the same side of the picture is left out. The chord
    lies there, too, and passes every visible height as often and in the same direction: a
    fill inside of the picture stays what it is.
    """
    end = np.cumsum(vertices)
    total = int(end[-1]) if len(end) else 0
    borders = np.searchsorted(end, np.arange(CHUNK, total, CHUNK))
    for curves in np.split(np.arange(len(count)), np.unique(borders)):
        curve = np.repeat(curves, vertices[curves])
        first = np.concatenate([[0], np.cumsum(vertices[curves])])[:-1]
        number = np.arange(len(curve)) - np.repeat(first, vertices[curves])
        many = count[curve] > MANY_SEGMENTS
        if visible is not None and many.any():
            weight = bernstein(layout.degree[curve], number / count[curve])
            at = np.einsum("vk,vki->vi", weight, points[layout.control[curve]])
            side = visible.sides(at, visible.margin[curve])
            inner = (number > 0) & (number < vertices[curve] - 1) & many
            inner[1:-1] &= (side[1:-1] > 0) & (side[1:-1] == side[:-2]) & (side[1:-1] == side[2:])
            inner[[0, -1]] = False
            curve, number = curve[~inner], number[~inner]
        yield curve, number


def bernstein(degree: npt.NDArray[np.int64], t: FloatArray) -> FloatArray:
    """(N, 4) weights of the control points of curves of `degree` (N,) at t (N,)."""
    rise, fall = ([np.ones_like(t)] for _ in range(2))
    for _ in range(3):
        rise.append(rise[-1] * t)
        fall.append(fall[-1] * (1 - t))
    powers = np.stack(fall, axis=1)
    left = np.clip(degree[:, None] - np.arange(4), 0, 3)
    remaining = np.take_along_axis(powers, left, axis=1)
    found: FloatArray = BINOMIALS[degree] * np.stack(rise, axis=1) * remaining
    return found


def segment_counts(
    layout: DrawingLayout, points: FloatArray, flattening: Flattening
) -> npt.NDArray[np.int64]:
    """(C,) segments of each curve; 1 of a line, at most 1024.

    Args:
        layout: of the drawing.
        points: (P, 2) its control points.
        flattening: how finely.
    """
    if flattening.segments is not None:
        fixed: npt.NDArray[np.int64] = np.where(layout.degree > 1, flattening.segments, 1)
        return fixed
    p = points[layout.control]
    bend = p[:, 2:] - 2 * p[:, 1:-1] + p[:, :-2]
    size = np.sqrt(np.square(bend).sum(axis=2))
    size[layout.degree < 3, 1] = 0  # of a quadratic curve the fourth point repeats the third
    size[layout.degree < 2] = 0
    d = layout.degree
    needed = np.sqrt(size.max(axis=1, initial=0) * d * (d - 1) / (8 * flattening.tolerance))
    found: npt.NDArray[np.int64] = np.clip(np.ceil(needed), 1, MOST_SEGMENTS).astype(np.int64)
    return found
