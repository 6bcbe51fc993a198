"""Depth of field after the fact: a picture of a pinhole, blurred by its depths.

A thin lens of radius R that is focused at F sees a point at depth d as a disk, whose radius in
pixels is the circle of confusion

    c(d) = f R |1 / F - 1 / d|

with f the focal length in pixels. Each pixel gathers from the disks that reach it [Demers2004].
What the pinhole does not see, because something hides it, no blur can bring back.
"""

from __future__ import annotations

import numpy as np
from photograd_course.portable_math import cos, sin

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.frame.pixels import pixel_centers
from photograd.transport.lens import Lens
from photograd.types import Array

GOLDEN_ANGLE = 2.39996322972865332


@typed_call
def circle_of_confusion(depth: Array, camera: Camera, lens: Lens) -> Array:
    """Radius of the disk that each depth is seen as, in pixels.

    Args:
        depth: of any shape, meters along the camera's axis, above 0; may be infinite.
        camera: of which the focal length counts.
        lens: its opening and focus.

    Raises:
        RangeError: a depth that is not above 0.
    """
    call = Arguments("circle_of_confusion", np.float64)
    depth = call.array("depth", depth, (...,), finite=False, above=0.0)
    radius: Array = camera.fx * lens.radius * np.abs(1.0 / lens.focus - 1.0 / depth)
    return radius


@typed_call
def depth_of_field(
    color: Array, depth: Array, camera: Camera, lens: Lens, *, samples: int = 64
) -> Array:
    """A picture as a thin lens would have taken it.

    Args:
        color: (H, W, 3) linear radiance of a pinhole, float32 or float64.
        depth: (H, W) meters along the axis; infinite where nothing is visible.
        camera: of the picture.
        lens: its opening, 0 of which changes nothing, and its focus.
        samples: on the disk around each pixel, on a spiral of equal areas.

    Returns:
        (H, W, 3) of the dtype of `color`.

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other dtypes or sizes than the camera's,
            radiance that is not finite, or samples out of range.
    """
    call = Arguments("depth_of_field")
    size = (camera.height, camera.width)
    color = call.array("color", color, (*size, 3))
    depth = call.array("depth", depth, size, dtype=np.float64, finite=False, above=0.0)
    count = call.integer("samples", samples, low=1, high=4096)
    own = circle_of_confusion(depth, camera, lens)
    widest = float(own.max())
    if widest == 0:
        return color.copy()
    x, y = pixel_centers(*size)
    least = 0.5  # a pixel's own extent
    own = np.maximum(own, least)
    weight = 1.0 / (own * own)
    total, summed = weight.copy(), color * weight[..., None]
    spacing = (widest + least) * (widest + least) / count  # pi times this is a sample's area
    for k in range(count):
        reach = (widest + least) * np.sqrt((k + 0.5) / count)
        along_x, along_y = reach * cos(GOLDEN_ANGLE * k), reach * sin(GOLDEN_ANGLE * k)
        at_x = np.clip(np.floor(x + along_x).astype(int), 0, size[1] - 1)
        at_y = np.clip(np.floor(y + along_y).astype(int), 0, size[0] - 1)
        blur, behind = own[at_y, at_x], depth[at_y, at_x] > depth
        # A blurred background does not cover what is sharp before it.
        spread = np.where(behind, np.minimum(blur, own), blur)
        part = spacing * np.clip(spread - reach + 0.5, 0.0, 1.0) / (spread * spread)
        total += part
        summed += color[at_y, at_x] * part[..., None]
    return np.asarray(summed / total[..., None], color.dtype)
