"""Registers the buffers of a frame and its gradients for the test of bits."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from photograd.frame import (
    FrameOptions,
    FrameScene,
    LastFrame,
    ShadowSettings,
    SsaoSettings,
    bloom_backward,
    draw_surfaces,
    frame_graph,
    ssao,
    ssao_backward,
    tone_map_backward,
)
from photograd.frame.options import SkyVisibility, Transparency
from photograd.transport import Material
from photograd.transport.scene import Environment
from photograd.transport.shapes import rectangle

from support.bits import same_bits
from tests.frame import scenes


@same_bits("frame")
def everything() -> list[Any]:
    """A frame of several chunks of pixels, by all passes."""
    scene = scenes.room(scenes.LIGHTS["point"])
    options = FrameOptions(
        sky_directions=0,
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


@same_bits("occlusion in screen space", kernels=("draw_span", "ssao_row"))
def occluded() -> list[Any]:
    """Widths that fill lanes and that do not, a narrow picture, and many samples."""
    made = []
    scene = FrameScene(scenes.room(None))
    for width, height, samples in ((96, 64, 8), (81, 35, 16), (1, 40, 5), (33, 1, 3)):
        camera = scenes.camera(width, height)
        visible = draw_surfaces(scene, camera, "opaque")[1]
        depth = visible.depth.astype(np.float32)
        settings = SsaoSettings(radius=0.7, falloff=1.3, distribution=0.8)
        made.append(ssao(depth, visible.shading, camera, settings, samples=samples))
    return made


@same_bits("frame of a sky")
def under_a_sky() -> list[Any]:
    """What hides a sky, light that is gathered, and surfaces that cover in part, in fog."""
    sky = Environment([0.6, 0.8, 1.0], [0.9, 0.9, 0.9], [0.2, 0.2, 0.2])
    veil = Material("lambert", {"albedo": [0.8, 0.2, 0.1], "alpha": 0.5})
    scene = scenes.room(scenes.LIGHTS["directional"], environment=sky)
    sheet = rectangle("veil", [-1, 0, 0.6], [2, 0, 0], [0, 1, 0], "veil", [0, 0, 0])
    scene = replace(
        scene, shapes=(*scene.shapes, sheet), materials={**scene.materials, "veil": veil}
    )
    ready, made = FrameScene(scene), []
    visibilities: tuple[SkyVisibility, ...] = ("horizon", "disks", "directional", "shadow_maps")
    blends: tuple[Transparency, ...] = ("peeled", "sorted", "weighted", "peeled")
    for visibility, transparency in zip(visibilities, blends, strict=True):
        options = FrameOptions(
            sky_directions=4,
            sky_visibility=visibility,
            gather_samples=2,
            transparency=transparency,
            fog=0.1,
            shadows=ShadowSettings(size=100),
        )
        found = frame_graph(ready, options).run({"camera": scene.camera})
        made += [found[name] for name in ("occlusion", "sky_light", "gathered", "display")]
    return made


@same_bits("frame in motion")
def in_motion() -> list[Any]:
    """Velocities, blur and the mean over frames, behind culled clusters and all effects."""
    scene = scenes.room(scenes.LIGHTS["spot"])
    pose = scene.camera.world_from_camera.copy()
    pose[:3, 3] += [0.1, 0.05, 0.0]
    cameras = (replace(scene.camera, world_from_camera=pose), scene.camera)
    options = FrameOptions(
        culling="facing",
        sky_directions=0,
        shadows=ShadowSettings(size=100),
        shutter=0.5,
        temporal=0.2,
        aberration=0.01,
        vignette=0.5,
        fxaa=True,
    )
    ready, made, last = FrameScene(scene), [], LastFrame(cameras[0])
    for camera in cameras:
        found = frame_graph(ready, options).run({"camera": camera, "last": last})
        last = LastFrame(camera, history=found["history"])
        made += [found[name] for name in ("velocity", "blurred", "accumulated", "display")]
    return [*made, ready.meshlets.number, ready.meshlets.boxes, ready.meshlets.spread]
