"""A whole signed volume on one page: projections of maximum magnitude along the three axes.

Summing along an axis would let gains and losses cancel; the largest magnitude keeps its sign and
does not hide behind anything.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from ..checks import require_integer, require_mask
from . import style
from .checks import check_bounds, check_field
from .plane_row import draw_plane_row
from .planes import PLANES
from .scale import signed_scale


def signed_projection(values: NDArray[np.floating], axis: int) -> NDArray[np.floating]:
    """The value of largest magnitude along ``axis``, sign kept; of equals the first.

    Args:
        values: (X, Y, Z) float32 or float64.
        axis: 0, 1 or 2.

    Returns:
        The two remaining axes, in order, in the dtype of ``values``.

    Raises:
        DtypeError, ShapeError, RangeError: an argument is not as described.
    """
    field = check_field("signed_projection", "values", values)
    axis = require_integer("signed_projection", "axis", axis, least=0, most=2)
    strongest = np.expand_dims(np.abs(field).argmax(axis=axis), axis)
    return np.take_along_axis(field, strongest, axis=axis).squeeze(axis)


def signed_projections(
    values: NDArray[np.floating],
    bounds: ArrayLike,
    *,
    quantity: str = style.GRADIENT,
    unit: str = "",
    limit: float | None = None,
    outline: NDArray[np.bool_] | None = None,
    active: NDArray[np.bool_] | None = None,
    title: str | None = None,
    caption: str | None = None,
) -> Figure:
    """Front, side and top view of a scalar grid by :func:`signed_projection`.

    Args:
        values: (X, Y, Z) float32 or float64, any sign.
        bounds: (2, 3) outer faces of the grid in meters; world right-handed, +Y up.
        quantity: name for the color bar (mathtext allowed).
        unit: unit for the color bar.
        limit: the colors span [-limit, limit]; by default the 99.9 % quantile of the non-zero
            magnitudes of what is shown, rounded up.
        outline: (X, Y, Z) boolean; the silhouette of its True voxels is drawn.
        active: (X, Y, Z) boolean, the voxels that exist; gray is where a line of sight meets none.
            All of them if None.
        title: a line above the pictures.
        caption: text below the pictures.

    Raises:
        DtypeError, ShapeError, RangeError: an argument is not as described.
    """
    function = "signed_projections"
    field, box = check_field(function, "values", values), check_bounds(function, bounds)
    mask = None if outline is None else require_mask(function, "outline", outline, field.shape)
    views = [signed_projection(field, plane.normal) for plane in PLANES]
    shown = views
    if active is not None:
        require_mask(function, "active", active, field.shape)
        shown = [
            np.ma.array(view, mask=~active.any(axis=plane.normal))
            for view, plane in zip(views, PLANES, strict=True)
        ]
    return draw_plane_row(
        shown,
        box,
        headings=[f"seen from {plane.viewpoint}" for plane in PLANES],
        scale=signed_scale(function, views, limit),
        quantity=quantity,
        unit=unit,
        outlines=None if mask is None else [np.any(mask, axis=p.normal) for p in PLANES],
        title=title,
        caption=caption,
    )
