"""What drawing would cost, counted before it is done.

In each row of pixels the edges of a shape are cut where they cross, and passed from left to right
between each two cuts: (cuts) x (edges that stand side by side) steps. In drawings that people make
that grows with their size. Thousands of edges that all cross each other in one row take the third
power of their number, so a file of 50 kB could take minutes; drawings beyond

    PHOTOGRAD_MAX_CROSSINGS + STEPS_OF_AN_EDGE for each edge

are refused. A step is about a nanosecond.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from photograd_course.limits import CROSSINGS

from photograd.errors import RangeError, message
from photograd.types import FloatArray

STEPS_OF_AN_EDGE = 1 << 14
FEW = 128
"""Edges of a shape whose crossings need no counting."""


def require_affordable(
    vertices: FloatArray,
    contours: npt.NDArray[np.int64],
    shapes: npt.NDArray[np.int64],
    height: int,
    width: int,
) -> None:
    """Raise RangeError for a drawing whose edges cross each other too often.

    Args:
        vertices: (V, 2) of all contours, one after the other.
        contours: (C + 1,) first vertex of each.
        shapes: (S + 1,) first contour of each shape.
        height, width: of the picture.
    """
    allowed = CROSSINGS.value() + STEPS_OF_AN_EDGE * len(vertices)
    first = contours[shapes]
    steps = 0.0
    for shape in np.flatnonzero(np.diff(first) > FEW):
        edges = _edges(vertices, contours[shapes[shape] : shapes[shape + 1] + 1], height, width)
        if _most_steps(edges, height) > allowed - steps:
            steps += _steps(edges, height, allowed - steps)
        if steps > allowed:
            expected = f"edges that cross rarely, {CROSSINGS.expected()}"
            got = f"about {steps:.0e} in shape {shape}"
            raise RangeError(message("Rendering", "drawing", expected, got, CROSSINGS.remedy()))


def _edges(
    vertices: FloatArray, contours: npt.NDArray[np.int64], height: int, width: int
) -> FloatArray:
    """(4, E) top, bottom, left and right of the edges of a shape that meet the picture."""
    a = vertices[contours[0] : contours[-1]]
    following = np.arange(1, len(a) + 1)
    size = np.diff(contours)
    following[(contours[1:] - contours[0] - 1)[size > 0]] = (contours[:-1] - contours[0])[size > 0]
    b = a[following]
    low, high = np.minimum(a, b), np.maximum(a, b)
    top, bottom = np.clip([low[:, 1], high[:, 1]], 0, height)
    meets = (bottom > top) & (low[:, 0] < width)
    found: FloatArray = np.stack([top, bottom, low[:, 0], high[:, 0]])[:, meets]
    return found


def _rows(edges: FloatArray) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """First and last row of each edge, the last one excluded."""
    return np.floor(edges[0]).astype(np.int64), np.ceil(edges[1]).astype(np.int64)


def _most_steps(edges: FloatArray, height: int) -> float:
    """A bound of the steps: if all edges of a row crossed each other side by side."""
    begin, end = _rows(edges)
    change = np.bincount(begin, minlength=height + 1) - np.bincount(end, minlength=height + 1)
    each = np.cumsum(change).astype(np.float64)
    return float((0.5 * each**3 + 2 * each**2).sum())


def _steps(edges: FloatArray, height: int, allowed: float) -> float:
    """About the steps: pairs that may cross in a row, times the edges at one height of it.

    Edges at one place cross others at one height, however many they are.
    """
    edges, times = np.unique(edges, axis=1, return_counts=True)
    begin, end = _rows(edges)
    by_begin = np.argsort(begin, kind="stable")
    edges, times = edges[:, by_begin], times[by_begin]
    begin, end = begin[by_begin], end[by_begin]
    first = np.searchsorted(begin, np.arange(height + 1))
    total = 0.0
    waiting = np.zeros(0, np.int64)
    for y in range(height):
        waiting = np.concatenate([waiting[end[waiting] > y], np.arange(first[y], first[y + 1])])
        count, everyone = len(waiting), float(times[waiting].sum())
        top, bottom, left, right = edges[:, waiting]
        heights = np.minimum(bottom, y + 1) - np.maximum(top, y)
        side_by_side = float((heights * times[waiting]).sum())
        pairs = float(np.searchsorted(np.sort(left), right, "right").sum())
        total += everyone * everyone  # they are brought into an order
        total += (2 * count + pairs - count * (count + 1) / 2) * max(side_by_side, 1.0)
        if total > allowed:
            break
    return total
