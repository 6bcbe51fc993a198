"""Depths and normals of a frame as the core reads them, in the coordinates of its camera."""

from __future__ import annotations

import numpy as np

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd.capture.camera import Camera
from photograd.types import Array

Intrinsics = tuple[float, float, float, float]


def screen_arguments(
    call: Arguments, depth: Array, normals: Array, camera: Camera
) -> tuple[Array, Array, Intrinsics]:
    """1 / depth (H, W), normals (H, W, 3) along the camera's axes, and (fx, fy, cx, cy).

    Args:
        call: names the arguments in errors.
        depth: (H, W) along the camera's axis, meters; infinite where nothing is visible.
        normals: (H, W, 3) unit, in the world.
        camera: of the frame.

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other types or sizes than the camera's.
    """
    size = (camera.height, camera.width)
    depth = call.array("depth", depth, size, finite=False, above=0.0)
    normals = call.array("normals", normals, (*size, 3))
    inverse = np.divide(1.0, depth, dtype=depth.dtype)
    intrinsics = (camera.fx, camera.fy, camera.cx, camera.cy)
    return inverse, along_camera_axes(normals, camera), intrinsics


def along_camera_axes(vectors: Array, camera: Camera) -> Array:
    """Components of vectors (..., 3) of the world along the axes of a camera."""
    rotation = np.ascontiguousarray(camera.world_from_camera[:3, :3], vectors.dtype)
    out = np.empty(vectors.shape, vectors.dtype)
    _core.turn_vectors(vectors.reshape(-1, 3), rotation, out.reshape(-1, 3))
    return out
