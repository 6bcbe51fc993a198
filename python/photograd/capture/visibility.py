"""Does a camera see a box? Two convex bodies are apart exactly if some axis separates them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from photograd_course.portable_math import matmul

from photograd.capture.assemble import box_corners
from photograd.capture.camera import Camera
from photograd.capture.capture import check_box
from photograd.capture.view import View
from photograd.errors import SceneError, message
from photograd.types import FloatArray


def sees_box(camera: Camera, box: FloatArray) -> bool:
    """Whether any part of a (2, 3) box lies inside the viewing pyramid.

    The pyramid is the camera's position plus all non-negative sums of its four corner directions.
    It is apart from the box exactly if a plane through some face of either, or along an edge of
    each, lies between them (the separating axis theorem) [Gottschalk1996].
    """
    u = np.array([0.0, camera.width, camera.width, 0.0])
    v = np.array([0.0, 0.0, camera.height, camera.height])
    local = np.stack(
        [(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones(4)], axis=-1
    )
    edges = matmul(local, camera.world_from_camera[:3, :3].T)
    sides = np.cross(edges, np.roll(edges, -1, axis=0))
    crossed = np.cross(edges[:, None, :], np.eye(3)[None, :, :]).reshape(-1, 3)
    axes = np.concatenate([np.eye(3), sides, crossed])
    axes = np.concatenate([axes, -axes])
    relative = box_corners(check_box("sees_box", "box", box)) - camera.position
    slack = 1e-12 * (1.0 + float(np.abs(edges).max()))
    pyramid_below = (matmul(axes, edges.T) <= slack).all(axis=1)
    box_above = matmul(axes, relative.T).min(axis=1) > 0.0
    degenerate = np.linalg.norm(axes, axis=1) < 1e-12
    return not bool((pyramid_below & box_above & ~degenerate).any())


def blind_cameras(views: Sequence[View], box: FloatArray) -> tuple[str, ...]:
    """Names of the views that see no part of the (2, 3) box."""
    return tuple(view.name for view in views if not sees_box(view.camera, box))


def require_views_of(views: Sequence[View], box: FloatArray) -> None:
    """Refuse a box that some camera does not see.

    Raises:
        SceneError: names the cameras.
    """
    blind = blind_cameras(views, box)
    if blind:
        raise SceneError(no_view(blind, len(views), box))


def no_view(blind: Sequence[str], count: int, box: FloatArray) -> str:
    """The sentence that names cameras which do not see the box."""
    names = ", ".join(blind[:8]) + (", ..." if len(blind) > 8 else "")
    corners = " to ".join(str(tuple(round(float(x), 4) for x in corner)) for corner in box)
    got = f"{len(blind)} of {count} that do not: {names}"
    remedy = "check the bounds and the convention of the poses"
    return message("require_views_of", "views", f"cameras that see the box {corners}", got, remedy)
