"""Procedural scenes: described, not rendered; a capture of one can be recovered like photographs.

toys = scene("toy_table", seed=0)
render_view = DirectLight(toys).render_view  # of photograd.scenes.direct_light
splits = capture_scene(toys, render_view, views=60, test_views=8, size=128, seed=0, spp=64)
write_blender_capture(folder, splits, aabb=toys.bounds)
"""

from __future__ import annotations

from photograd.scenes.capture import capture_cameras, capture_scene
from photograd.scenes.description import (
    SceneDescription,
    SceneMesh,
    SkyDescription,
    SunDescription,
    bounds_of,
)
from photograd.scenes.registry import DEFAULT_SCENE, scene, scenes

__all__ = [
    "DEFAULT_SCENE",
    "SceneDescription",
    "SceneMesh",
    "SkyDescription",
    "SunDescription",
    "bounds_of",
    "capture_cameras",
    "capture_scene",
    "scene",
    "scenes",
]
