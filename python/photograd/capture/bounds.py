"""Where the scene is: a box for representations that need one, from the best evidence there is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from photograd_course.portable_math import matmul, norm

from photograd.capture.capture import Capture
from photograd.capture.convention import meeting_of_axes
from photograd.capture.hull import mean_coverage, silhouettes_of, visual_hull_box
from photograd.capture.visibility import blind_cameras, no_view
from photograd.errors import SceneError, message
from photograd.types import FloatArray

PADDING = 0.05
"""Share of the extent added on each side of an estimated box."""

LARGEST_VIEWS = 60
"""Enough silhouettes for a box; more only take time."""


@dataclass(frozen=True, eq=False)
class Bounds:
    """A box and how it was found.

    Attributes:
        box: (2, 3) lower and upper corner in the world.
        rule: one sentence for the log.
        blind: names of views that see no part of it.
    """

    box: FloatArray
    rule: str
    blind: tuple[str, ...]


def estimate_bounds(capture: Capture) -> Bounds:
    """Box around the scene, by the first rule that applies.

    1. Declared in the file. 2. Images with alpha: visual hull of the training silhouettes, padded
    by 5 %. 3. Sparse points: from the 2nd to the 98th percentile on each axis, padded by 5 %.
    4. A declared range of depths: all that the training cameras see in it. 5. A cube at the point
    where the optical axes meet, reaching half way to the cameras.

    Raises:
        SceneError: no camera sees the box (names them), or the axes do not meet.
    """
    box, rule = _find(capture)
    blind = blind_cameras(capture.views, box)
    if len(blind) == len(capture.views):
        raise SceneError(no_view(blind, len(blind), box))
    return Bounds(box, rule, blind)


def _find(capture: Capture) -> tuple[FloatArray, str]:
    if capture.bounds is not None:
        return capture.bounds, "declared in the file"
    if capture.has_alpha:
        hull = _hull(capture)
        if hull is not None:
            return hull, "visual hull of the training silhouettes, padded by 5 %"
    if capture.points is not None and len(capture.points) >= 8:
        corners = np.percentile(capture.points, [2.0, 98.0], axis=0)
        rule = f"2nd to 98th percentile of {len(capture.points)} sparse points, padded by 5 %"
        return _padded(corners), rule
    if capture.depth_range is not None:
        near, far = capture.depth_range
        corners = np.concatenate([_frustum(capture, depth) for depth in (near, far)])
        box = np.stack([corners.min(axis=0), corners.max(axis=0)])
        return box, f"all that the training cameras see at the declared depths {near:g} to {far:g}"
    centre, distance = _focus(capture)
    half = 0.5 * distance
    return np.stack([centre - half, centre + half]), "cube half way from the focus to the cameras"


def _focus(capture: Capture) -> tuple[FloatArray, float]:
    """Point nearest to all training axes, and the mean distance of the cameras from it."""
    poses = [view.camera.world_from_camera for view in capture.train]
    meeting = meeting_of_axes(poses)
    centres = np.array([pose[:3, 3] for pose in poses])
    distance = float(np.linalg.norm(meeting.point - centres, axis=1).mean())
    if len(poses) < 2 or meeting.spread < 1e-6 or not distance > 0.0:
        expected = "optical axes that meet, points, alpha or declared bounds"
        raise SceneError(message("estimate_bounds", "capture", expected, "parallel axes"))
    return meeting.point, distance


def _hull(capture: Capture) -> FloatArray | None:
    step = -(-len(capture.train) // LARGEST_VIEWS)
    views = capture.train[::step]
    silhouettes = silhouettes_of(views)
    if len(views) < 2 or mean_coverage(silhouettes) > 0.99:
        return None
    centre, _ = _focus(capture)
    half = 0.0
    for view in views:
        camera = view.camera
        distance = norm(camera.position - centre)
        half = max(half, 0.5 * distance * camera.width / camera.fx)
        half = max(half, 0.5 * distance * camera.height / camera.fy)
    box = visual_hull_box(silhouettes, np.stack([centre - half, centre + half]))
    return None if box is None else _padded(box)


def _frustum(capture: Capture, depth: float) -> FloatArray:
    corners = []
    for view in capture.train:
        camera = view.camera
        x = (np.array([0.0, camera.width]) - camera.cx) / camera.fx * depth
        y = (np.array([0.0, camera.height]) - camera.cy) / camera.fy * depth
        local = np.array([[a, b, depth] for a in x for b in y])
        corners.append(matmul(local, camera.world_from_camera[:3, :3].T) + camera.position)
    return np.concatenate(corners)


def _padded(box: FloatArray) -> FloatArray:
    """Add 5 % of the extent on each side; a flat axis gets 5 % of the longest one."""
    extent = box[1] - box[0]
    margin = PADDING * np.where(extent > 1e-9 * extent.max(), extent, extent.max())
    return np.stack([box[0] - margin, box[1] + margin])
