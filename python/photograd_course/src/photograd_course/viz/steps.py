"""A fit as a row of pictures: the same signed projection at chosen steps, side by side."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike, NDArray

from ..checks import require_integer, require_mask
from ..errors import RangeError, ShapeError, message
from . import style
from .checks import check_bounds, check_field
from .planes import PLANES, Plane, draw_plane
from .projections import signed_projection
from .scale import Scale, signed_scale

COLUMNS = 4
LEFT, TOP, GAP, BELOW, BAR_ROOM = 0.66, 0.04, 0.16, 0.12, 0.96  # inches
WIDTH, TALLEST = 7.8, 2.6  # inches


def projection_steps(
    fields: Mapping[int, NDArray[np.floating]],
    bounds: ArrayLike,
    *,
    view: Literal["front", "side", "top"] = "front",
    active: Mapping[int, NDArray[np.bool_]] | None = None,
    common_scale: bool = True,
    quantity: str = style.GRADIENT,
    unit: str = "",
    title: str | None = None,
    caption: str | None = None,
) -> Figure:
    """One signed projection per step, in order of the steps, up to four in a line.

    Args:
        fields: step -> (X, Y, Z) float32 or float64; resolutions may differ, the box may not.
        bounds: (2, 3) outer faces of the box in meters; world right-handed, +Y up.
        view: from which side the box is seen (+Z, +X or +Y).
        active: step -> (X, Y, Z) boolean, the voxels that exist; gray is where a line of sight
            meets none. All of them if None.
        common_scale: one color bar for all panels. If False every panel has its own scale, which
            its heading states, since gradients shrink by orders of magnitude during a fit.
        quantity: name for the color bar (mathtext allowed).
        unit: unit for the color bar.
        title: a line above the pictures.
        caption: text below the pictures.

    Raises:
        DtypeError, ShapeError, RangeError: an argument is not as described.
    """
    box, plane = check_bounds("projection_steps", bounds), _plane(view)
    steps = _steps(fields)
    views = [_project(step, fields[step], plane) for step in steps]
    hidden = [_hidden(step, fields, active, plane) for step in steps]
    shared = signed_scale("projection_steps", views, None)
    own = [shared if common_scale else _own_scale(picture) for picture in views]
    with style.house_style():
        heading_height = 0.3 if common_scale else 0.46
        head = heading_height, 0.26 if title else 0.0
        figure, panels = _layout(box, plane, len(views), head, caption)
        for panel, step, picture, gray, scale in zip(
            panels, steps, views, hidden, own, strict=True
        ):
            limit = 1.0 if common_scale else scale.limit  # own scales: shown as shares of the limit
            image = draw_plane(
                panel,
                plane,
                np.ma.array(picture / limit, mask=gray),
                box,
                color_map=style.signed_color_map(),
                norm=style.symmetric_scale(scale.limit / limit),
            )
            panel.set_title(_heading(step, None if common_scale else scale.limit, unit))
        _label_outer_axes(panels)
        style.color_bar(
            figure,
            _bar_box(figure, panels),
            image,
            quantity if common_scale else f"{quantity}, each to its own scale",
            unit=unit if common_scale else "",
            extend=shared.extend if common_scale else _joined(own),
        )
        style.write_title(figure, title, left=0.12)
        style.write_caption(figure, caption, left=0.12, right=0.12)
    return figure


def _heading(step: int, limit: float | None, unit: str) -> str:
    """The step, and below it the panel's own scale if it has one."""
    heading = f"step {step:,}".replace(",", "\N{THIN SPACE}")
    if limit is None:
        return heading
    return f"{heading}\n$\\pm${style.power_text(limit)} {unit}".rstrip()


def _steps(fields: Mapping[int, object]) -> list[int]:
    """The steps in order, at least one."""
    if not fields:
        raise ShapeError(message("projection_steps", "fields", "at least one step", "none"))
    return sorted(require_integer("projection_steps", "fields", step, least=0) for step in fields)


def _project(step: int, field: object, plane: Plane) -> NDArray[np.floating]:
    grid = check_field("projection_steps", f"fields[{step}]", field)
    return signed_projection(grid, plane.normal)


def _hidden(
    step: int,
    fields: Mapping[int, NDArray[np.floating]],
    active: Mapping[int, NDArray[np.bool_]] | None,
    plane: Plane,
) -> NDArray[np.bool_]:
    """Where the projection of a step shows no voxel."""
    if active is None:
        return np.zeros(np.delete(fields[step].shape, plane.normal), np.bool_)
    if step not in active:
        raise RangeError(message("projection_steps", "active", f"a mask for step {step}", "none"))
    mask = require_mask("projection_steps", f"active[{step}]", active[step], fields[step].shape)
    return np.asarray(~mask.any(axis=plane.normal))


def _own_scale(picture: NDArray[np.floating]) -> Scale:
    return signed_scale("projection_steps", [picture], None)


def _plane(view: str) -> Plane:
    named = dict(zip(("front", "side", "top"), PLANES, strict=True))
    if view not in named:
        expected = "one of front, side, top"
        raise RangeError(message("projection_steps", "view", expected, repr(view)))
    return named[view]


def _layout(
    box: NDArray[np.float64],
    plane: Plane,
    count: int,
    head: tuple[float, float],
    caption: str | None,
) -> tuple[Figure, list[Axes]]:
    """An empty figure with ``count`` axes in reading order, at most ``COLUMNS`` in a line.

    ``head`` is the height of a panel's heading and that of the figure's title, in inches.
    """
    heading, title = head
    extent = box[1] - box[0]
    columns = min(count, COLUMNS)
    rows = -(-count // columns)
    room = WIDTH - LEFT - BAR_ROOM - (columns - 1) * GAP
    scale = min(room / columns / float(extent[plane.across]), TALLEST / float(extent[plane.up]))
    width, height = scale * float(extent[plane.across]), scale * float(extent[plane.up])
    total_width = LEFT + columns * width + (columns - 1) * GAP + BAR_ROOM
    top = TOP + title
    total_height = top + rows * (heading + height + BELOW) + 0.36
    total_height += style.caption_height(caption, total_width - 0.24)
    figure = style.new_figure(total_width, total_height)
    panels = [
        style.place_axes(
            figure,
            LEFT + (i % columns) * (width + GAP),
            top + heading + (i // columns) * (heading + height + BELOW),
            width,
            height,
        )
        for i in range(count)
    ]
    return figure, panels


def _label_outer_axes(panels: list[Axes]) -> None:
    """Leave labels only where no neighbor has them: left column and lowest panel of each."""
    for i, panel in enumerate(panels):
        panel.xaxis.set_major_locator(MaxNLocator(nbins=4, prune="both"))
        if i % COLUMNS:
            panel.set_ylabel("")
            panel.tick_params(labelleft=False)
        if i + COLUMNS < len(panels):
            panel.set_xlabel("")
            panel.tick_params(labelbottom=False)


def _bar_box(figure: Figure, panels: list[Axes]) -> tuple[float, float, float, float]:
    """A color bar beside the first line of panels, as (left, top, width, height) in inches."""
    total_width, total_height = figure.get_size_inches()
    last = panels[min(len(panels), COLUMNS) - 1].get_position()
    top = (1.0 - last.y1) * total_height
    return last.x1 * total_width + 0.16, top, 0.12, (last.y1 - last.y0) * total_height


def _joined(scales: list[Scale]) -> Literal["neither", "min", "max", "both"]:
    below = any(scale.extend in {"min", "both"} for scale in scales)
    above = any(scale.extend in {"max", "both"} for scale in scales)
    if below and above:
        return "both"
    return "min" if below else "max" if above else "neither"
