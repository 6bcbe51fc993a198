"""Three orthogonal planes through a box, drawn as seen from outside, to one common scale.

The world is right-handed with +Y up. No view is a mirror image: from the front (+Z) x runs to the
right; from the side (+X) z runs to the left; from the top (+Y) z runs down the page.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Colormap, Normalize
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from numpy.typing import NDArray

from . import style

AXIS_NAMES = "xyz"
MARGIN_LEFT, MARGIN_TOP, LABEL_WIDTH, LABEL_HEIGHT = 0.12, 0.36, 0.52, 0.46  # inches
PANEL_GAP, BAR_GAP, BAR_WIDTH, BAR_LABEL = 0.14, 0.16, 0.12, 0.68  # inches


@dataclass(frozen=True)
class Plane:
    """One view: the axis looked along and the axes that run across and up the page."""

    normal: int
    across: int
    up: int
    across_flipped: bool = False  # the coordinate grows towards the left
    up_flipped: bool = False  # the coordinate grows towards the bottom

    @property
    def viewpoint(self) -> str:
        """Where the eye is, for example ``+Z``."""
        return f"+{AXIS_NAMES[self.normal].upper()}"

    def image(self, section: NDArray[Any]) -> NDArray[Any]:
        """Turn an array over the two remaining axes, in x-y-z order, into rows (up) by columns."""
        return section if self.up < self.across else section.T


FRONT = Plane(normal=2, across=0, up=1)
SIDE = Plane(normal=0, across=2, up=1, across_flipped=True)
TOP = Plane(normal=1, across=0, up=2, up_flipped=True)
PLANES = (FRONT, SIDE, TOP)


@dataclass(frozen=True)
class PanelRow:
    """Where a row of panels ended: inches from the upper left corner of the figure."""

    axes: tuple[Axes, ...]
    right: float
    top: float
    bottom: float


def row_scale(bounds: NDArray[np.floating], planes: tuple[Plane, ...], room: float) -> float:
    """Inches per meter so that the row fits ``room`` and no panel is over 2.6 inches high."""
    extent = bounds[1] - bounds[0]
    widths = sum(float(extent[plane.across]) for plane in planes)
    tallest = max(float(extent[plane.up]) for plane in planes)
    fixed = MARGIN_LEFT + len(planes) * LABEL_WIDTH + (len(planes) - 1) * PANEL_GAP
    return min((room - fixed) / widths, 2.6 / tallest)


def row_height(bounds: NDArray[np.floating], planes: tuple[Plane, ...], room: float) -> float:
    """Inches from the top of the tallest panel of the row to its lower edge."""
    extent = bounds[1] - bounds[0]
    return row_scale(bounds, planes, room) * max(float(extent[plane.up]) for plane in planes)


def row_width(bounds: NDArray[np.floating], planes: tuple[Plane, ...], room: float) -> float:
    """Inches from the left edge of the figure to the right edge of the last panel."""
    extent = bounds[1] - bounds[0]
    widths = sum(float(extent[plane.across]) for plane in planes)
    fixed = MARGIN_LEFT + len(planes) * LABEL_WIDTH + (len(planes) - 1) * PANEL_GAP
    return fixed + row_scale(bounds, planes, room) * widths


def place_row(
    figure: Figure,
    bounds: NDArray[np.floating],
    planes: tuple[Plane, ...],
    *,
    room: float,
    head: float,
) -> PanelRow:
    """Axes for ``planes`` side by side, to one scale, tops in line ``head`` inches further down."""
    scale = row_scale(bounds, planes, room)
    extent = bounds[1] - bounds[0]
    left, top, panels = MARGIN_LEFT, head + MARGIN_TOP, []
    for plane in planes:
        left += LABEL_WIDTH
        width, height = scale * float(extent[plane.across]), scale * float(extent[plane.up])
        panels.append(style.place_axes(figure, left, top, width, height))
        left += width + PANEL_GAP
    bottom = top + row_height(bounds, planes, room)
    return PanelRow(tuple(panels), right=left - PANEL_GAP, top=top, bottom=bottom)


def draw_plane(
    axes: Axes,
    plane: Plane,
    section: NDArray[np.floating],
    bounds: NDArray[np.floating],
    *,
    color_map: Colormap,
    norm: Normalize,
) -> AxesImage:
    """Draw one section with axes in meters; every voxel is a flat square, nothing is blurred.

    Args:
        section: values over the two axes of the plane, in x-y-z order; gray where masked.
        bounds: (2, 3) outer faces of the grid, meters.
    """
    low_across, high_across = (float(face) for face in bounds[:, plane.across])
    low_up, high_up = (float(face) for face in bounds[:, plane.up])
    image = axes.imshow(
        plane.image(section),
        cmap=color_map.with_extremes(bad=style.MISSING),
        norm=norm,
        origin="lower",
        interpolation="nearest",
        extent=(low_across, high_across, low_up, high_up),
        aspect="auto",  # the axes box already has the right proportions
    )
    if plane.across_flipped:
        axes.invert_xaxis()
    if plane.up_flipped:
        axes.invert_yaxis()
    axes.locator_params(nbins=4)
    axes.set_xlabel(f"{AXIS_NAMES[plane.across]} [m]")
    axes.set_ylabel(f"{AXIS_NAMES[plane.up]} [m]")
    return image


def draw_outline(
    axes: Axes, plane: Plane, section: NDArray[np.bool_], bounds: NDArray[np.floating]
) -> None:
    """Draw the border of the True voxels of a section as a thin dark line along voxel faces."""
    inside = np.pad(plane.image(section), 1)
    rows, columns = (extent - 2 for extent in inside.shape)
    across = np.linspace(bounds[0, plane.across], bounds[1, plane.across], columns + 1)
    up = np.linspace(bounds[0, plane.up], bounds[1, plane.up], rows + 1)
    # A face belongs to the outline where the voxels on its two sides differ.
    row, column = np.nonzero(inside[1:-1, :-1] != inside[1:-1, 1:])
    upright = [
        ((across[c], up[r]), (across[c], up[r + 1])) for r, c in zip(row, column, strict=True)
    ]
    row, column = np.nonzero(inside[:-1, 1:-1] != inside[1:, 1:-1])
    level = [((across[c], up[r]), (across[c + 1], up[r])) for r, c in zip(row, column, strict=True)]
    lines = LineCollection(upright + level, colors=style.INK, linewidths=0.6, capstyle="round")
    axes.add_collection(lines, autolim=False)
