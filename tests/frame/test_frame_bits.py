"""Registers the buffers of a frame and its gradients for the test of bits."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd.frame import (
    FrameOptions,
    FrameScene,
    ShadowSettings,
    bloom_backward,
    frame_graph,
    ssao_backward,
    tone_map_backward,
)

from support.bits import same_bits
from tests.frame import scenes


@same_bits("frame")
def everything() -> list[Any]:
    """A frame of several chunks of pixels, by all passes."""
    scene = scenes.room(scenes.LIGHTS["point"])
    options = FrameOptions(
        sky_directions=0,
        sky_visibility="occlusion",
        shadows=ShadowSettings(size=200),
        bloom_weights=(0.1, 0.1),
        tone_curve="agx",
    )
    result = frame_graph(FrameScene(scene), options).run({"camera": scene.camera})
    visible, radiance = result["gbuffer"], result["radiance"]
    d = np.random.default_rng(1).uniform(-1, 1, radiance.shape).astype(np.float32)
    depth = visible.depth.astype(np.float32)
    occlusion = ssao_backward(depth, visible.shading, scene.camera, d[..., 0].copy())
    spread = bloom_backward(radiance, [0.1, 0.1], d)
    tones = tone_map_backward(radiance, d)
    shadow = result["shadows"]["lights.0"].depths
    buffers = [visible.position, visible.shading, shadow, result["direct"], result["display"]]
    return [*buffers, *occlusion.values(), *spread, tones[0], *tones[1].values()]
