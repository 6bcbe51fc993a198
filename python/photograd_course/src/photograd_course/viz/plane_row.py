"""One row of three orthogonal views with a common color bar, for slices and projections alike."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from . import planes, style
from .planes import PLANES, Plane
from .scale import Scale

ROOM = 7.0  # inches for the panels and their labels


def draw_plane_row(
    sections: Sequence[NDArray[Any]],
    bounds: NDArray[np.float64],
    *,
    headings: Sequence[str],
    scale: Scale,
    quantity: str,
    unit: str,
    outlines: Sequence[NDArray[Any]] | None = None,
    crosshair: NDArray[np.float64] | None = None,
    title: str | None = None,
    caption: str | None = None,
) -> Figure:
    """Front, side and top view side by side, in meters, with one signed color bar.

    Args:
        sections: three arrays, over the axes that remain, for the planes of ``planes.PLANES``;
            gray where masked.
        bounds: (2, 3) outer faces, meters.
        headings: one line above each panel.
        outlines: boolean sections whose border is drawn.
        crosshair: (3,) meters; dashed lines at its coordinates.
    """
    head = 0.26 if title else 0.0
    with style.house_style():
        width = planes.row_width(bounds, PLANES, ROOM)
        width += planes.BAR_GAP + planes.BAR_WIDTH + planes.BAR_LABEL
        room_for_text = width - 2 * planes.MARGIN_LEFT
        height = head + planes.MARGIN_TOP + planes.row_height(bounds, PLANES, ROOM)
        height += planes.LABEL_HEIGHT + style.caption_height(caption, room_for_text)
        figure = style.new_figure(width, height)
        row = planes.place_row(figure, bounds, PLANES, room=ROOM, head=head)
        for number, (axes, plane) in enumerate(zip(row.axes, PLANES, strict=True)):
            image = planes.draw_plane(
                axes,
                plane,
                sections[number],
                bounds,
                color_map=style.signed_color_map(),
                norm=style.symmetric_scale(scale.limit),
            )
            axes.set_title(headings[number])
            if outlines is not None:
                planes.draw_outline(axes, plane, outlines[number], bounds)
            if crosshair is not None:
                _draw_crosshair(axes, plane, crosshair)
        box = (row.right + planes.BAR_GAP, row.top, planes.BAR_WIDTH, row.bottom - row.top)
        style.color_bar(figure, box, image, quantity, unit=unit, extend=scale.extend)
        style.write_title(figure, title, left=planes.MARGIN_LEFT)
        style.write_caption(figure, caption, left=planes.MARGIN_LEFT, right=planes.MARGIN_LEFT)
    return figure


def _draw_crosshair(axes: Axes, plane: Plane, point: NDArray[np.float64]) -> None:
    for draw, axis in ((axes.axvline, plane.across), (axes.axhline, plane.up)):
        draw(float(point[axis]), color=style.GUIDE, linewidth=0.6, dashes=(4, 3), alpha=0.8)
