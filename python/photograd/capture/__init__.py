"""Captures: posed photographs from every common format, in one frame, and back to disk.

capture = load_capture("folder")
print(*capture.conversions, sep="; ")
box = estimate_bounds(capture).box
"""

from __future__ import annotations

from photograd.capture.bounds import (
    Bounds,
    blind_cameras,
    estimate_bounds,
    require_views_of,
    sees_box,
)
from photograd.capture.camera import Camera
from photograd.capture.capture import Capture
from photograd.capture.load import load_capture
from photograd.capture.undistort import Distortion, distort, undistort, undistort_image
from photograd.capture.view import View
from photograd.capture.write import write_blender_capture

__all__ = [
    "Bounds",
    "Camera",
    "Capture",
    "Distortion",
    "View",
    "blind_cameras",
    "distort",
    "estimate_bounds",
    "load_capture",
    "require_views_of",
    "sees_box",
    "undistort",
    "undistort_image",
    "write_blender_capture",
]
