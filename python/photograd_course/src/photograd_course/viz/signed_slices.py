"""Where a signed quantity lives in space: three orthogonal slices through a grid.

Made for gradients such as dL/dsigma_t: gradient descent adds matter where it is negative (blue) and
takes matter away where it is positive (red).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from ..checks import require_mask
from ..errors import RangeError, ShapeError, message
from . import style
from .checks import check_bounds, check_field
from .plane_row import draw_plane_row
from .planes import AXIS_NAMES, PLANES
from .scale import signed_scale


def signed_slices(
    values: NDArray[np.floating],
    bounds: ArrayLike,
    *,
    at: Sequence[float] | None = None,
    quantity: str = style.GRADIENT,
    unit: str = "",
    limit: float | None = None,
    outline: NDArray[np.bool_] | None = None,
    active: NDArray[np.bool_] | None = None,
    title: str | None = None,
    caption: str | None = None,
) -> Figure:
    """Three slices of a scalar grid; thin dashed lines show where the other two slices cut.

    Args:
        values: (X, Y, Z) float32 or float64, any sign.
        bounds: (2, 3) outer faces of the grid in meters; world right-handed, +Y up.
        at: the point (x, y, z) in meters that all three slices pass through; the middle if None.
        quantity: name for the color bar (mathtext allowed).
        unit: unit for the color bar.
        limit: the colors span [-limit, limit]; by default the 99.9 % quantile of the non-zero
            magnitudes, rounded up. Clipped ends are shown as arrows on the color bar.
        outline: (X, Y, Z) boolean; the border of its True voxels is drawn, e.g. the true object.
        active: (X, Y, Z) boolean, the voxels that exist; the others are gray. All of them if None.
        title: a line above the pictures.
        caption: text below the pictures.

    Returns:
        A figure for :func:`photograd_course.viz.style.save_figure`.

    Raises:
        DtypeError, ShapeError, RangeError: an argument is not as described.
    """
    function = "signed_slices"
    field, box = check_field(function, "values", values), check_bounds(function, bounds)
    mask = None if outline is None else require_mask(function, "outline", outline, field.shape)
    index = _voxel_at(function, at, box, field.shape)
    center = box[0] + (index + 0.5) * (box[1] - box[0]) / np.array(field.shape)
    slices = [_cut(field, index, plane.normal) for plane in PLANES]
    if active is not None:
        require_mask(function, "active", active, field.shape)
        slices = [
            np.ma.array(part, mask=~_cut(active, index, plane.normal))
            for part, plane in zip(slices, PLANES, strict=True)
        ]
    return draw_plane_row(
        slices,
        box,
        headings=[f"slice {AXIS_NAMES[p.normal]} = {_meters(center[p.normal])} m" for p in PLANES],
        scale=signed_scale(function, [field], limit),
        quantity=quantity,
        unit=unit,
        outlines=None if mask is None else [_cut(mask, index, p.normal) for p in PLANES],
        crosshair=center,
        title=title,
        caption=caption,
    )


def _cut(grid: NDArray[Any], index: NDArray[np.int64], axis: int) -> NDArray[Any]:
    return np.asarray(np.take(grid, index[axis], axis=axis))


def _meters(value: float) -> str:
    """Centimeters are enough; a true minus sign, and no negative zero."""
    return f"{round(float(value), 2) + 0.0:.2f}".replace("-", "\N{MINUS SIGN}")


def _voxel_at(
    function: str, at: Sequence[float] | None, box: NDArray[np.float64], shape: tuple[int, ...]
) -> NDArray[np.int64]:
    """Index (3,) of the voxel that contains ``at``."""
    counts = np.array(shape)
    if at is None:
        return np.asarray(counts // 2, dtype=np.int64)
    point = np.asarray(at, dtype=np.float64)
    if point.shape != (3,):
        raise ShapeError(message(function, "at", "a point (x, y, z)", point.shape))
    if not ((box[0] <= point) & (point <= box[1])).all():
        expected = f"a point inside the box {box[0].tolist()} .. {box[1].tolist()}"
        raise RangeError(message(function, "at", expected, point.tolist()))
    index = np.floor((point - box[0]) / (box[1] - box[0]) * counts).astype(np.int64)
    return np.asarray(np.minimum(index, counts - 1))
