"""A block of land: heights on a square net, with upright sides and a flat bottom."""

from __future__ import annotations

import numpy as np
from photograd_course.checks import require_number

from photograd.errors import RangeError, ShapeError, message
from photograd.scenes.surface import Surface, from_grid, joined
from photograd.types import FloatArray


def net_points(count: int, half_size: float) -> FloatArray:
    """(count, count, 2) positions (x, z) of a net: rows towards +Z, columns towards +X."""
    line = np.linspace(-half_size, half_size, count)
    x, z = np.meshgrid(line, line)
    return np.stack([x, z], axis=-1)


def land_block(
    heights: FloatArray, half_size: float, floor: float, *, layers: int = 24
) -> tuple[Surface, Surface]:
    """The top, and the sides with the bottom; together they are watertight.

    Args:
        heights: (M, M) metres at `net_points(M, half_size)`, M >= 2.
        half_size: metres from the middle to each side.
        floor: height of the bottom, below all heights.
        layers: number of faces between top and bottom.

    Returns:
        Two surfaces. The top keeps the order of `heights`: vertex row * M + column.

    Raises:
        ShapeError, RangeError, DtypeError: heights not square, not finite or not above the floor.
    """
    heights = np.asarray(heights, dtype=np.float64)
    if heights.ndim != 2 or heights.shape[0] != heights.shape[1] or len(heights) < 2:
        expected = "shape (M, M) with M >= 2"
        raise ShapeError(message("land_block", "heights", expected, heights.shape))
    require_number("land_block", "half_size", half_size, least=0.0, open_ends=True)
    if not bool((np.isfinite(heights) & (heights > floor)).all()):
        expected = f"finite heights above the floor at {floor:g}"
        raise RangeError(message("land_block", "heights", expected, float(heights.min())))
    plan = net_points(len(heights), half_size)
    top = np.stack([plan[..., 0], heights, plan[..., 1]], axis=-1)
    bottom = top.copy()
    bottom[..., 1] = floor
    share = np.linspace(0.0, 1.0, layers + 1)[:, None, None]
    edge_top, edge_bottom = _edge(top), _edge(bottom)
    # Written so that both ends are the very numbers of top and bottom.
    walls = (1.0 - share) * edge_top + share * edge_bottom
    walls[..., [0, 2]] = edge_top[:, [0, 2]]
    sides = from_grid(walls, closed_columns=True)
    return from_grid(top), joined([sides, from_grid(bottom[::-1])])


def _edge(points: FloatArray) -> FloatArray:
    """The net's outermost points (4 M - 4, 3), to the right as seen from outside, from (-X, +Z)."""
    front, right = points[-1, :-1], points[:0:-1, -1]
    back, left = points[0, :0:-1], points[:-1, 0]
    return np.concatenate([front, right, back, left])
