"""Captures: posed photographs from every common format, in one frame, and back to disk.

capture = load_capture("folder")
print(*capture.conversions, sep="; ")
box = estimate_bounds(capture).box
"""

from __future__ import annotations

from .bounds import Bounds, estimate_bounds
from .camera import Camera
from .capture import Capture
from .image_write import write_exr, write_jpeg, write_png, write_radiance
from .images import ColorSpace, downscale_image, read_image, read_radiance
from .load import load_capture
from .undistort import Distortion, distort, undistort, undistort_image
from .view import View
from .visibility import blind_cameras, require_views_of, sees_box
from .write import write_blender_capture

__all__ = [
    "Bounds",
    "Camera",
    "Capture",
    "ColorSpace",
    "Distortion",
    "View",
    "blind_cameras",
    "distort",
    "downscale_image",
    "estimate_bounds",
    "load_capture",
    "read_image",
    "read_radiance",
    "require_views_of",
    "sees_box",
    "undistort",
    "undistort_image",
    "write_blender_capture",
    "write_exr",
    "write_jpeg",
    "write_png",
    "write_radiance",
]
