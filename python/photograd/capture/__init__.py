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
from photograd.capture.undistort import (
    ColmapLens,
    Distortion,
    FisheyeDistortion,
    Lens,
    undistort_image,
)
from photograd.capture.view import View
from photograd.capture.write import write_blender_capture

__all__ = [
    "Bounds",
    "Camera",
    "Capture",
    "ColmapLens",
    "Distortion",
    "FisheyeDistortion",
    "Lens",
    "View",
    "blind_cameras",
    "estimate_bounds",
    "load_capture",
    "require_views_of",
    "sees_box",
    "undistort_image",
    "write_blender_capture",
]
