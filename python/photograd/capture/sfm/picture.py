"""Where the cameras stood and what they saw, from above and from the side."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from photograd_course.viz import style

from photograd.capture import Capture
from photograd.capture.view import View
from photograd.types import FloatArray

WIDTH, HEIGHT = 5.2, 4.6  # inches of a panel
_FRUSTUM = 0.06  # length of a drawn camera, of the width of the picture


def draw_cameras(capture: Capture, path: Path, title: str) -> None:
    """Write a PNG of the points in their colors and the cameras as wedges that open forwards.

    Args:
        capture: with points.
        path: of the picture.
        title: a line above it.
    """
    with style.house_style():
        figure = style.new_figure(2 * WIDTH + 1.6, HEIGHT + 1.3)
        panels = [(0, 2, "from above", "x", "z"), (0, 1, "from the side", "x", "y")]
        for index, (right, up, heading, across, along) in enumerate(panels):
            axes = style.place_axes(figure, 0.65 + index * (WIDTH + 0.7), 0.75, WIDTH, HEIGHT)
            _draw(axes, capture, right, up)
            axes.set_title(heading)
            axes.set_xlabel(f"{across}, in the units of the reconstruction")
            axes.set_ylabel(along)
        figure.suptitle(title, fontsize=style.TITLE_SIZE + 1)
        style.save_figure(figure, path)


def _draw(axes: Axes, capture: Capture, right: int, up: int) -> None:
    centers = np.array([view.camera.position for view in capture.views])[:, [right, up]]
    shown = centers
    if capture.points is not None and len(capture.points):
        points = capture.points[:, [right, up]]
        low, high = np.percentile(points, [2, 98], axis=0)
        shown = np.concatenate([centers, [low, high]])
        colors = capture.point_colors
        axes.scatter(
            points[:, 0],
            points[:, 1],
            s=1.5,
            linewidths=0,
            c=style.GRAY if colors is None else colors / 255.0,
        )
    middle = 0.5 * (shown.min(axis=0) + shown.max(axis=0))
    half = 0.56 * max(float(np.ptp(shown, axis=0).max()), 1e-9)
    for views, color, name in (
        (capture.train, style.BLUE, "cameras to fit to"),
        (capture.test, style.ORANGE, "held out"),
    ):
        for index, view in enumerate(views):
            wedge = _wedge(view, 2 * half * _FRUSTUM)[:, [right, up]]
            label = name if index == 0 else None
            axes.plot(wedge[:, 0], wedge[:, 1], color=color, linewidth=1.0, label=label)
    axes.set_xlim(middle[0] - half, middle[0] + half)
    axes.set_ylim(middle[1] - half, middle[1] + half)
    if up == 2:
        axes.invert_yaxis()  # +z points to the reader: y is up, x to the right
    axes.set_aspect("equal")
    axes.grid(visible=True)
    axes.set_axisbelow(True)
    axes.legend(loc="upper right", frameon=True, framealpha=0.85, edgecolor="none")


def _wedge(view: View, length: float) -> FloatArray:
    """Corners (4, 3) of the visible wedge in the camera's horizontal plane, closed."""
    camera = view.camera
    slopes = [-camera.cx / camera.fx, (camera.width - camera.cx) / camera.fx]
    corners = np.array([[0.0, 0, 0], [slopes[0], 0, 1], [slopes[1], 0, 1], [0.0, 0, 0]]) * length
    wedge: FloatArray = corners @ camera.world_from_camera[:3, :3].T + camera.position
    return wedge
