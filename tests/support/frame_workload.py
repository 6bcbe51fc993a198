"""A little of everything that the passes of a frame ask of the core."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from photograd.frame import (
    FrameOptions,
    FrameScene,
    ShadowSettings,
    SsaoSettings,
    bloom_backward,
    frame_graph,
    ssao_backward,
    tone_map_backward,
)
from photograd.frame.light_views import background
from photograd.lights import PointLight
from photograd.transport.builtin import builtin_scene
from photograd.transport.scene import Environment


def frames() -> None:
    scene = builtin_scene("furnace-box", 6)
    light = PointLight([0.0, 1.0, 0.0], [1.0, 1.0, 1.0])
    scene = replace(scene, lights=(light,), environment=Environment.constant(1.0))
    options = FrameOptions(
        surface_points=1,
        sky_directions=2,
        shadows=ShadowSettings(size=8),
        occlusion=SsaoSettings(radius=0.2),
        bloom_weights=(0.1,),
        tone_curve="agx",
    )
    result = frame_graph(FrameScene(scene), options).run({"camera": scene.camera})
    visible, radiance = result["gbuffer"], result["radiance"]
    for technique in ("horizon", "disks", "directional"):
        options = replace(options, sky_visibility=technique, gather_samples=1, disk_edge=2.0)
        frame_graph(FrameScene(scene), options).run({"camera": scene.camera}, ["radiance"])
    background(scene, scene.camera)
    d = np.ones_like(radiance)
    depth = visible.depth.astype(np.float32)
    ssao_backward(depth, visible.shading, scene.camera, d[..., 0].copy())
    bloom_backward(radiance, [0.1], d)
    tone_map_backward(radiance, d)
