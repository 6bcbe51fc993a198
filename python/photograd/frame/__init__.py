"""The real-time frame: passes over a rasterized scene, each beside the path traced truth.

    scene = FrameScene(builtin_scene("cornell-box"))
    graph = frame_graph(scene, FrameOptions(tone_curve="agx"))
    frame = graph.run({"camera": scene.scene.camera})

Surfaces are lit by the reflectance models, textures and lights of `photograd.transport`.
"""

from __future__ import annotations

from photograd.frame.antialiasing import TemporalAntialiasing, fxaa
from photograd.frame.bloom import bloom, bloom_backward
from photograd.frame.depth_of_field import circle_of_confusion, depth_of_field
from photograd.frame.detail import SceneDetail
from photograd.frame.disks import Disks, scene_disks
from photograd.frame.display_tuning import TunedBloom, TunedToneCurve, tune_bloom, tune_tone_curve
from photograd.frame.dithering import dither
from photograd.frame.fog import add_fog
from photograd.frame.gathering import gather, reflectance_pdf, sample_reflectance
from photograd.frame.gbuffer import GBuffer, draw_surfaces, fill_gbuffer, reflect, reflect_parallel
from photograd.frame.graph import FrameResult, Pass, PassGraph
from photograd.frame.horizon import HorizonSettings, horizon_occlusion
from photograd.frame.lens_effects import chromatic_aberration, vignette
from photograd.frame.light_views import (
    FrameLight,
    background,
    delta_lights,
    infinite_lights,
    sky_lights,
    surface_lights,
)
from photograd.frame.lighting import draw_shadow_maps, light_surfaces
from photograd.frame.meshlets import Meshlets, meshlets
from photograd.frame.motion import LastFrame, motion_blur, velocity
from photograd.frame.occlusion import SsaoSettings, ssao, ssao_backward
from photograd.frame.options import FrameOptions
from photograd.frame.pipeline import frame_graph
from photograd.frame.scene import FrameScene
from photograd.frame.screen_rays import ScreenRaySettings, follow_screen_rays
from photograd.frame.shadows import ShadowMap, ShadowSettings, draw_shadow_map, look_up_shadow
from photograd.frame.tone_mapping import tone_map, tone_map_backward
from photograd.frame.transparency import Layer, blend_nearest_first, blend_weighted
from photograd.frame.tuning import TunedOcclusion, traced_occlusion, tune_occlusion

__all__ = [
    "Disks",
    "FrameLight",
    "FrameOptions",
    "FrameResult",
    "FrameScene",
    "GBuffer",
    "HorizonSettings",
    "LastFrame",
    "Layer",
    "Meshlets",
    "Pass",
    "PassGraph",
    "SceneDetail",
    "ScreenRaySettings",
    "ShadowMap",
    "ShadowSettings",
    "SsaoSettings",
    "TemporalAntialiasing",
    "TunedBloom",
    "TunedOcclusion",
    "TunedToneCurve",
    "add_fog",
    "background",
    "blend_nearest_first",
    "blend_weighted",
    "bloom",
    "bloom_backward",
    "chromatic_aberration",
    "circle_of_confusion",
    "delta_lights",
    "depth_of_field",
    "dither",
    "draw_shadow_map",
    "draw_shadow_maps",
    "draw_surfaces",
    "fill_gbuffer",
    "follow_screen_rays",
    "frame_graph",
    "fxaa",
    "gather",
    "horizon_occlusion",
    "infinite_lights",
    "light_surfaces",
    "look_up_shadow",
    "meshlets",
    "motion_blur",
    "reflect",
    "reflect_parallel",
    "reflectance_pdf",
    "sample_reflectance",
    "scene_disks",
    "sky_lights",
    "ssao",
    "ssao_backward",
    "surface_lights",
    "tone_map",
    "tone_map_backward",
    "traced_occlusion",
    "tune_bloom",
    "tune_occlusion",
    "tune_tone_curve",
    "velocity",
    "vignette",
]
