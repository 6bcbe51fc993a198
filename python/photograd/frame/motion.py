"""Motion in the image, and the blur of a shutter that stays open while it happens.

The velocity of a pixel is how far its surface has moved in the image since the last frame, by the
motion of the camera and of the shape: both poses of both are asked for, as a pose of the last frame
alone would blur what stands still behind a moving shape.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from photograd_course.portable_math import matmul

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.capture.frames import invert_rigid
from photograd.frame.antialiasing import TemporalAntialiasing
from photograd.frame.gbuffer import GBuffer
from photograd.frame.pixels import color_argument, look_up, pixel_centers
from photograd.types import Array, FloatArray


@typed_call
@dataclass(frozen=True, eq=False)
class LastFrame:
    """What a frame needs of the one before it.

    Attributes:
        camera: that took it; for a first frame, its own.
        moved: {shape: matrix (4, 4)} of shapes that have moved: where they were in the last frame,
            from where they are in this one.
        history: its buffer of this name; None for a first frame.
    """

    camera: Camera
    moved: Mapping[int, FloatArray] = field(default_factory=dict)
    history: TemporalAntialiasing | None = None


@typed_call
def velocity(
    surfaces: GBuffer,
    previous: Camera,
    shape: Array | None = None,
    moved: Mapping[int, FloatArray] | None = None,
) -> FloatArray:
    """How far each pixel's surface has moved in the image since the last frame.

    Args:
        surfaces: of this frame's G-buffer.
        previous: the camera of the last frame, of the same size.
        shape: (H, W) the number of the shape in each pixel; needed with `moved`.
        moved: {shape: matrix (4, 4)} of shapes that have moved: where they were in the last frame,
            from where they are in this one.

    Returns:
        (H, W, 2) float64 pixels, this place minus the last; of the background, which is infinitely
        far away, by the turn of the camera alone. NaN where a surface was behind the last camera.

    Raises:
        ShapeError: buffers of another size than the camera's, or matrices that are not (4, 4).
    """
    camera = surfaces.camera
    call = Arguments("velocity", np.float64)
    size = (camera.height, camera.width)
    call.array("previous", np.zeros((previous.height, previous.width)), size)
    points = surfaces.position.astype(np.float64)
    for number, back in (moved or {}).items():
        matrix = call.array(f"moved[{number}]", back, (4, 4))
        which = call.array("shape", shape, size, dtype=np.int64) == number
        points[which] = matmul(points[which], matrix[:3, :3].T) + matrix[:3, 3]
    camera_from_world = invert_rigid(previous.world_from_camera)
    rays = camera.rays()[1].reshape(*size, 3)
    offset = np.where(surfaces.covered[..., None], camera_from_world[:3, 3], 0.0)
    far_or_near = np.where(surfaces.covered[..., None], points, rays)
    local = matmul(far_or_near.reshape(-1, 3), camera_from_world[:3, :3].T).reshape(*size, 3)
    local += offset
    depth = np.where(local[..., 2] > 0, local[..., 2], np.nan)
    x, y = pixel_centers(*size)
    was_x = previous.fx * local[..., 0] / depth + previous.cx
    was_y = previous.fy * local[..., 1] / depth + previous.cy
    return np.stack([x - was_x, y - was_y], axis=-1)


@typed_call
def motion_blur(color: Array, moved: Array, shutter: float = 1.0, *, samples: int = 16) -> Array:
    """The mean of a picture along its motion, as a shutter sees it that is open around this frame.

    Args:
        color: (H, W, 3) linear radiance, float32 or float64.
        moved: (H, W, 2) pixels since the last frame, of `velocity`; NaN counts as none.
        shutter: part of the time between two frames for which it is open, 0 to 1; 0 changes
            nothing.
        samples: along the way.

    Returns:
        (H, W, 3) of the dtype of `color`.

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other dtypes or sizes, or numbers out of
            range.
    """
    call = Arguments("motion_blur")
    color = color_argument(call, color)
    moved = call.array("moved", moved, (*color.shape[:2], 2), dtype=color.dtype, finite=False)
    shutter = call.number("shutter", shutter, low=0.0, high=1.0)
    count = call.integer("samples", samples, low=1, high=4096)
    if shutter == 0:
        return color.copy()
    moved = np.where(np.isfinite(moved), moved, 0.0).astype(color.dtype)
    height, width = color.shape[:2]
    x, y = pixel_centers(height, width, color.dtype)
    total = np.zeros_like(color)
    for k in range(count):
        along = shutter * ((k + 0.5) / count - 0.5)
        total += look_up(color, x + along * moved[..., 0], y + along * moved[..., 1])
    blurred: Array = total / color.dtype.type(count)
    return np.where((moved == 0).all(axis=-1, keepdims=True), color, blurred)
