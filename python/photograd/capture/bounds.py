"""Where the scene is: a box for representations that need one, from the best evidence there is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from photograd_course.portable_math import matmul, norm

from photograd._arrays import Arguments
from photograd._checks import require_instance
from photograd._typed import typed_call
from photograd.capture.assemble import box_corners
from photograd.capture.camera import Camera
from photograd.capture.capture import Capture
from photograd.capture.convention import focus_point_of_axes
from photograd.capture.view import View
from photograd.errors import SceneError, message
from photograd.types import FloatArray

RESOLUTIONS = (32, 64)
"""The second pass carves inside the box of the first, whose voxels were coarse."""

Silhouette: TypeAlias = tuple[Camera, npt.NDArray[np.int64]]
"""A camera and the summed-area table (H + 1, W + 1) of its pixels that may show the object."""


def visual_hull_box(
    silhouettes: Sequence[Silhouette], box: FloatArray, resolutions: Sequence[int] = RESOLUTIONS
) -> FloatArray | None:
    """Box (2, 3) of the voxels of `box` that no view shows to be empty; None if none is left.

    A voxel is empty if its footprint meets no pixel with alpha in some view that shows it, or if
    fewer than half of the views show it. A voxel is kept in doubt, so that the hull contains the
    object; its box is at most a voxel and a pixel too large on each side.

    Args:
        silhouettes: alpha of the views, with their cameras.
        box: (2, 3) to look in.
        resolutions: voxels along the longest edge, coarse to fine; each box is looked through next.
    """
    for resolution in resolutions:
        alive = _carve(silhouettes, box, resolution)
        if not bool(alive.any()):
            return None
        size = (box[1] - box[0]) / resolution
        found = np.argwhere(alive.reshape((resolution,) * 3))
        box = np.stack([box[0] + found.min(axis=0) * size, box[0] + (found.max(axis=0) + 1) * size])
    return box


def silhouettes_of(views: Sequence[View]) -> list[Silhouette]:
    """Read the alpha of each view; pixels that are not valid may show anything.

    Args:
        views: with alpha.
    """
    result: list[Silhouette] = []
    for view in views:
        occupied = (view.rgba()[..., 3] > 0.0) | ~view.valid_mask()
        table = np.zeros((occupied.shape[0] + 1, occupied.shape[1] + 1), dtype=np.int64)
        table[1:, 1:] = occupied.cumsum(axis=0, dtype=np.int64).cumsum(axis=1)
        result.append((view.camera, table))
    return result


def mean_coverage(silhouettes: Sequence[Silhouette]) -> float:
    """Fraction of pixels that may show the object; near 1, the silhouettes say nothing."""
    covered = sum(int(table[-1, -1]) for _, table in silhouettes)
    return covered / sum(camera.width * camera.height for camera, _ in silhouettes)


def _carve(
    silhouettes: Sequence[Silhouette], box: FloatArray, resolution: int
) -> npt.NDArray[np.bool_]:
    size = (box[1] - box[0]) / resolution
    radius = 0.5 * norm(size)
    steps = [box[0, a] + (np.arange(resolution) + 0.5) * size[a] for a in range(3)]
    centers = np.stack(np.meshgrid(*steps, indexing="ij"), axis=-1).reshape(-1, 3)
    alive = np.ones(len(centers), dtype=np.bool_)
    view_count = np.zeros(len(centers), dtype=np.int64)
    for camera, table in silhouettes:
        ids = np.flatnonzero(alive)
        pixels, depth = camera.project(centers[ids])
        shown = depth > radius
        shown &= (pixels > 0.0).all(axis=1)
        shown &= (pixels < [camera.width, camera.height]).all(axis=1)
        ids, pixels, depth = ids[shown], pixels[shown], depth[shown]
        reach = radius * max(camera.fx, camera.fy) / (depth - radius)
        low = np.floor(pixels - reach[:, None]).astype(np.int64).clip(min=0)
        high = np.ceil(pixels + reach[:, None]).astype(np.int64)
        right = high[:, 0].clip(max=camera.width)
        bottom = high[:, 1].clip(max=camera.height)
        left, top = low[:, 0], low[:, 1]
        covered = table[bottom, right] - table[top, right] - table[bottom, left] + table[top, left]
        view_count[ids] += 1
        alive[ids[covered == 0]] = False
    return alive & (2 * view_count >= len(silhouettes))


# Does a camera see a box? Two convex bodies are apart exactly if some axis separates them.


@typed_call
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
    relative = box_corners(Arguments("sees_box", np.float64).box("box", box)) - camera.position
    slack = 1e-12 * (1.0 + float(np.abs(edges).max()))
    pyramid_below = (matmul(axes, edges.T) <= slack).all(axis=1)
    box_above = matmul(axes, relative.T).min(axis=1) > 0.0
    degenerate = np.linalg.norm(axes, axis=1) < 1e-12
    return not bool((pyramid_below & box_above & ~degenerate).any())


@typed_call
def blind_cameras(views: Sequence[View], box: FloatArray) -> tuple[str, ...]:
    """Names of the views that see no part of the (2, 3) box."""
    return tuple(view.name for view in views if not sees_box(view.camera, box))


@typed_call
def require_views_of(views: Sequence[View], box: FloatArray) -> None:
    """Refuse a box that some camera does not see.

    Args:
        views: whose cameras are asked.
        box: (2, 3) of the scene.

    Raises:
        SceneError: names the cameras.
    """
    blind = blind_cameras(views, box)
    if blind:
        raise SceneError(no_view(blind, len(views), box))


def no_view(blind: Sequence[str], count: int, box: FloatArray) -> str:
    """The sentence that names cameras which do not see the box.

    Args:
        blind: names of the cameras that see nothing.
        count: how many cameras there are.
        box: (2, 3) of the scene.
    """
    names = ", ".join(blind[:8]) + (", ..." if len(blind) > 8 else "")
    corners = " to ".join(str(tuple(round(float(x), 4) for x in corner)) for corner in box)
    got = f"{len(blind)} of {count} that do not: {names}"
    remedy = "check the bounds and the convention of the poses"
    return message("require_views_of", "views", f"cameras that see the box {corners}", got, remedy)


# Where the scene is: a box for representations that need one, from the best evidence there is.


PADDING = 0.05
"""Share of the extent added on each side of an estimated box."""

MAX_VIEWS = 60
"""Enough silhouettes for a box; more only take time."""


@typed_call
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


@typed_call
def estimate_bounds(capture: Capture) -> Bounds:
    """Box around the scene, by the first rule that applies.

    1. Declared in the file. 2. Images with alpha: visual hull of the training silhouettes, padded
    by 5 %. 3. Sparse points: from the 2nd to the 98th percentile on each axis, padded by 5 %.
    4. A declared range of depths: all that the training cameras see in it. 5. A cube at the point
    where the optical axes meet, reaching half way to the cameras.

    Args:
        capture: as `load_capture` returns it.

    Returns:
        The box, the rule that gave it, and the names of views that see no part of it.

    Raises:
        DtypeError: no `Capture`.
        SceneError: no camera sees the box (names them), or the axes do not meet.

    Example:
        >>> bounds = photograd.estimate_bounds(photograd.load_capture("photos"))
        >>> bounds.box.shape, bounds.rule
        ((2, 3), 'declared in the file')
    """
    require_instance("estimate_bounds", "capture", capture, Capture, "load_capture reads one")
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
    center, distance = _focus(capture)
    half = 0.5 * distance
    return np.stack([center - half, center + half]), "cube half way from the focus to the cameras"


def _focus(capture: Capture) -> tuple[FloatArray, float]:
    """Point nearest to all training axes, and the mean distance of the cameras from it."""
    poses = [view.camera.world_from_camera for view in capture.train]
    focus = focus_point_of_axes(poses)
    centers = np.array([pose[:3, 3] for pose in poses])
    distance = float(np.linalg.norm(focus.point - centers, axis=1).mean())
    if len(poses) < 2 or focus.spread < 1e-6 or not distance > 0.0:
        expected = "optical axes that meet, points, alpha or declared bounds"
        raise SceneError(message("estimate_bounds", "capture", expected, "parallel axes"))
    return focus.point, distance


def _hull(capture: Capture) -> FloatArray | None:
    step = -(-len(capture.train) // MAX_VIEWS)
    views = capture.train[::step]
    silhouettes = silhouettes_of(views)
    if len(views) < 2 or mean_coverage(silhouettes) > 0.99:
        return None
    center, _ = _focus(capture)
    half = 0.0
    for view in views:
        camera = view.camera
        distance = norm(camera.position - center)
        half = max(half, 0.5 * distance * camera.width / camera.fx)
        half = max(half, 0.5 * distance * camera.height / camera.fy)
    box = visual_hull_box(silhouettes, np.stack([center - half, center + half]))
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
