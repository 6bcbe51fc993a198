"""Points on what a fitted scene shows: where Gaussians begin if there is a model already.

Whatever the representation, its renderings have opacity and depth. A pixel that is mostly covered
says that there is something at that depth along its ray; its color is the photograph's.
"""

from __future__ import annotations

import numpy as np
from photograd_course.portable_math import matmul
from photograd_course.random import choice

from photograd.capture.capture import Capture
from photograd.capture.view import View, display_color
from photograd.errors import SceneError, message
from photograd.fitting.evaluate import render_camera
from photograd.fitting.model import Model
from photograd.types import Array

COVERED = 0.5
"""Opacity of a pixel that is believed to show something."""

MAX_VIEWS = 60


def surface_points(model: Model, capture: Capture, count: int, *, seed: int) -> tuple[Array, Array]:
    """At most `count` points (N, 3) in meters that training views see, display colors (N, 3).

    Evenly over the covered pixels of at most 60 views.

    Args:
        model: what is drawn.
        capture: whose training cameras see it.
        count: at most so many points.
        seed: of the choice of pixels.

    Raises:
        SceneError: the model covers no pixel of any of them.
    """
    views = capture.train[:: max(1, -(-len(capture.train) // MAX_VIEWS))]
    share = -(-count // len(views))
    found = [
        _points_of(model, view, 2 * share, seed=seed, number=number)
        for number, view in enumerate(views)
    ]
    points, colors = (np.concatenate(part) for part in zip(*found, strict=True))
    if not len(points):
        remedy = "was it fitted to this capture?"
        raise SceneError(
            message("surface_points", "model", "one that the views see", "empty pictures", remedy)
        )
    rows = np.sort(choice(seed, len(points), min(count, len(points)), step=len(views)))
    return points[rows], colors[rows]


def _points_of(
    model: Model, view: View, count: int, *, seed: int, number: int
) -> tuple[Array, Array]:
    """At most `count` points that one view sees, and their colors in the photograph."""
    _, opacity, depth = render_camera(model, view.camera)
    covered = np.flatnonzero((opacity.ravel() > COVERED) & view.valid_mask().ravel())
    rows = covered[choice(seed, len(covered), min(count, len(covered)), step=number)]
    origins, directions = view.camera.rays(rows)
    distance = depth.ravel()[rows] / opacity.ravel()[rows]
    if "rays" not in model.field.capabilities:  # whose depth is along the viewing axis
        distance = distance / matmul(directions, view.camera.forward)
    rgba = view.rgba().reshape(-1, 4)[rows].astype(np.float64)
    color = display_color(rgba[:, :3], view.color_space)
    return origins + distance[:, None] * directions, color
