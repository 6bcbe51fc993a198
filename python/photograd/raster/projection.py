"""Vertices in the image of a pinhole camera, in homogeneous pixels, and their adjoint.

A vertex X of the world becomes V = K (R X + t) = (z x, z y, z): its depth z along the camera's axis
and its position (x, y) in pixels, multiplied. It is linear, holds behind the camera as well, and
nothing is divided by a depth.

    d_X += (K R)^T d_V        d_[R t] += K^T d_V (X, 1)^T        d_K += d_V (R X + t)^T
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from photograd_course.portable_math import matmul

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.capture.frames import invert_rigid
from photograd.types import Array, FloatArray


@typed_call
@dataclass(frozen=True, eq=False)
class ProjectionGradients:
    """dL/d of what `project` read, float64.

    Attributes:
        vertices: (V, 3).
        camera_from_world: (3, 4), of the inverse of `Camera.world_from_camera`.
        fx, fy, cx, cy: of the camera's numbers, in pixels.
    """

    vertices: FloatArray
    camera_from_world: FloatArray
    fx: float
    fy: float
    cx: float
    cy: float


@typed_call
def project(vertices: Array, camera: Camera) -> FloatArray:
    """Vertices in homogeneous pixels.

    Args:
        vertices: (V, 3) in the world, meters.
        camera: of the picture.

    Returns:
        (V, 3) float64, (z x, z y, z) with the depth z in meters, negative behind the camera, and
        the position (x, y) in pixels; the center of the top left pixel is (0.5, 0.5).

    Raises:
        DtypeError, ShapeError, RangeError: vertices that are not finite numbers (V, 3).
    """
    vertices = Arguments("project", np.float64).array("vertices", vertices, ("V", 3))
    positions = np.empty_like(vertices)
    intrinsics = (camera.fx, camera.fy, camera.cx, camera.cy)
    _core.project(vertices, camera_from_world(camera), intrinsics, positions)
    return positions


@typed_call
def project_backward(
    vertices: Array, camera: Camera, d_positions: FloatArray
) -> ProjectionGradients:
    """The adjoint of `project`.

    Args:
        vertices, camera: as for `project`.
        d_positions: (V, 3) dL/d of what it returned.

    Raises:
        DtypeError, ShapeError, RangeError: as for `project`.
    """
    call = Arguments("project_backward", np.float64)
    vertices = call.array("vertices", vertices, ("V", 3))
    d_positions = call.array("d_positions", d_positions, ("V", 3))
    pose = camera_from_world(camera)
    local = matmul(vertices, pose[:, :3].T) + pose[:, 3]
    d_x, d_y, d_z = d_positions.T
    d_local = np.stack(
        [camera.fx * d_x, camera.fy * d_y, camera.cx * d_x + camera.cy * d_y + d_z], axis=-1
    )
    with_one = np.concatenate([vertices, np.ones_like(vertices[:, :1])], axis=1)
    return ProjectionGradients(
        vertices=matmul(d_local, pose[:, :3]),
        camera_from_world=np.einsum("vi,vj->ij", d_local, with_one),
        fx=float((d_x * local[:, 0]).sum()),
        fy=float((d_y * local[:, 1]).sum()),
        cx=float((d_x * local[:, 2]).sum()),
        cy=float((d_y * local[:, 2]).sum()),
    )


def camera_from_world(camera: Camera) -> FloatArray:
    """(3, 4) rotation and translation into a camera's frame."""
    return invert_rigid(camera.world_from_camera)[:3]
