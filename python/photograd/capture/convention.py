"""Do the poses look like the convention that the format promises, or like another one?

Two mistakes are common: camera axes of the other library (OpenCV where OpenGL is expected, which
turns every camera around), and camera_from_world where world_from_camera is expected. Both keep
every matrix rigid, and a fit then merely fails to converge. In a capture that looks inward the
optical axes nearly meet in one point in front of all cameras; we test whether they do so as
declared, or only after undoing one of the mistakes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from photograd_course.portable_math import matmul, norm

from photograd.capture.frames import OPENGL_FROM_OPENCV, invert_rigid, mean_camera_up
from photograd.capture.view import View
from photograd.errors import SceneError, message
from photograd.types import FloatArray

MIN_CAMERAS = 4
"""Fewer axes can meet by accident."""

MIN_SPREAD = 0.02
"""Mean sin^2 to the common direction below which axes are too parallel to meet anywhere."""


@dataclass(frozen=True)
class FocusPoint:
    """The point nearest to all optical axes.

    Attributes:
        point: (3,) with the least squared distance to all axes.
        miss: root mean square distance of the axes to it, over the mean distance of the cameras.
        in_front: fraction of cameras that have it in front of them.
        spread: how far the axes are from parallel; 0 if they are, up to 2/3.
    """

    point: FloatArray
    miss: float
    in_front: float
    spread: float

    @property
    def is_inward(self) -> bool:
        """All cameras look at (nearly) one point."""
        return self.spread > MIN_SPREAD and self.miss < 0.25 and self.in_front >= 0.9


def focus_point_of_axes(poses: Sequence[FloatArray]) -> FocusPoint:
    """Least-squares focus point of the optical axes of world_from_camera poses (OpenCV axes).

    The squared distance of a point x to the axis through c along unit d is |(1 - d d^T)(x - c)|^2;
    the normal equations sum (1 - d d^T) x = sum (1 - d d^T) c are solved with the pseudo-inverse,
    so parallel axes give the point nearest to the origin of the mean camera.
    """
    centers = np.array([pose[:3, 3] for pose in poses])
    axes = np.array([pose[:3, 2] for pose in poses])
    normals = np.eye(3) - axes[:, :, None] * axes[:, None, :]
    mean_center = centers.mean(axis=0)
    offsets = np.einsum("nij,nj->ni", normals, centers - mean_center)
    values, vectors = _eigen(normals.mean(axis=0))
    spread = float(values.min())
    inverse = np.where(values > 1e-9 * values.max(), 1.0 / np.maximum(values, 1e-300), 0.0)
    along = inverse * matmul(vectors.T, offsets.mean(axis=0))
    point = matmul(vectors, along) + mean_center
    towards = point - centers
    missed = np.linalg.norm(np.einsum("nij,nj->ni", normals, towards), axis=1)
    distance = float(np.linalg.norm(towards, axis=1).mean())
    miss = float(np.sqrt(np.square(missed).mean())) / distance if distance > 0.0 else np.inf
    in_front = float((np.einsum("ni,ni->n", towards, axes) > 0.0).mean())
    return FocusPoint(point, miss, in_front, spread)


def _eigen(matrix: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Eigenvalues (3,) and eigenvectors, as columns, of a symmetric matrix (3, 3).

    By Jacobi's rotations, since the last bits of LAPACK depend on the processor, and a fit's box on
    the point that is found here. Five sweeps reach rounding; ten leave nothing.
    """
    turned, vectors = matrix.copy(), np.eye(3)
    for p, q in 10 * ((0, 1), (0, 2), (1, 2)):
        if abs(turned[p, q]) <= 1e-18 * np.trace(matrix):
            continue
        theta = (turned[q, q] - turned[p, p]) / (2.0 * turned[p, q])
        tangent = np.copysign(1.0, theta) / (abs(theta) + np.sqrt(theta * theta + 1.0))
        cosine = 1.0 / np.sqrt(tangent * tangent + 1.0)
        rotation = np.eye(3)
        rotation[p, p] = rotation[q, q] = cosine
        rotation[p, q], rotation[q, p] = tangent * cosine, -tangent * cosine
        turned = matmul(matmul(rotation.T, turned), rotation)
        vectors = matmul(vectors, rotation)
    return np.diag(turned), vectors


def check_convention(
    function: str, views: Sequence[View], world_from_source: FloatArray, *, up_is_known: bool
) -> list[str]:
    """Refuse poses that look like a named other convention; return warnings where it is unsure.

    Args:
        function: reader on whose behalf the error speaks.
        views: with their poses in our frame, as declared.
        world_from_source: the turn from the file's world, which is taken back: an inverse pose has
            the world on its other side.
        up_is_known: the format promises which way is up, so that cameras that look outwards but
            stand upright count as an outward-looking capture and not as a mistake.

    Raises:
        SceneError: the poses look like those of the other camera axes, or like camera_from_world.
    """
    if len(views) < MIN_CAMERAS:
        return []
    declared = [view.camera.world_from_camera for view in views]
    focus = focus_point_of_axes(declared)
    if focus.is_inward:
        return _warn_about_up(declared) if up_is_known else []
    remedy = "convert the poses, or pass trust_poses=True if the cameras really stood like this"
    names = ", ".join(view.name for view in views[:3]) + (", ..." if len(views) > 3 else "")
    suspect = _better_convention(declared, world_from_source)
    if suspect == "axes":
        if up_is_known and float(mean_camera_up(declared)[1]) > 0.0:
            return ["warning: all cameras look away from one point (an outward-looking capture?)"]
        got = (
            f"cameras ({names}) that look away from the point where their axes meet: "
            "these look like OpenCV poses where the format has OpenGL axes, or the reverse"
        )
        raise SceneError(message(function, "poses", "the format's camera axes", got, remedy))
    if suspect == "inverse":
        got = f"poses ({names}) that look like camera_from_world: their inverses face one point"
        raise SceneError(message(function, "poses", "world_from_camera", got, remedy))
    return []


def _better_convention(declared: Sequence[FloatArray], world_from_source: FloatArray) -> str:
    """Which mistake, taken back, makes the axes meet best in front: "axes", "inverse" or ""."""
    source_from_world = invert_rigid(world_from_source)
    stored = [matmul(source_from_world, pose) for pose in declared]
    inverses = [invert_rigid(pose) for pose in stored]
    best, smallest = "", np.inf
    for label, poses in (
        ("axes", [matmul(pose, OPENGL_FROM_OPENCV) for pose in stored]),
        ("inverse", inverses),
        ("inverse", [matmul(pose, OPENGL_FROM_OPENCV) for pose in inverses]),
    ):
        focus = focus_point_of_axes(poses)
        if focus.is_inward and focus.miss < smallest:
            best, smallest = label, focus.miss
    return best


def _warn_about_up(poses: Sequence[FloatArray]) -> list[str]:
    up = mean_camera_up(poses)
    length = norm(up)
    if length < 0.3 or float(up[1]) > 0.5 * length:
        return []
    listed = ", ".join(f"{component:.2f}" for component in up / length)
    return [
        f"warning: the cameras' mean up is ({listed}), far from +Y: is the file's up axis right?"
    ]
