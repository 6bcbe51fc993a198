"""The passes of a frame, as a graph: what `photograd frame` runs.

    scene = FrameScene(builtin_scene("cornell-box"))
    frame = frame_graph(scene, FrameOptions(tone_curve="agx")).run({"camera": scene.scene.camera})
    frame["display"]  # (H, W, 3), linear

Buffers, in the order in which they are made:

    samples         the camera with several pixels in the place of one
    visibility      of what covers whole, and
    gbuffer         its surfaces
    shadows         shadow maps of the lights
    occlusion       of the sky
    direct          light of points, spots, directions and surfaces that emit
    sky_light       light of the sky, of environment maps and suns
    background      radiance behind everything
    opaque          all of these
    layered         with surfaces before it that cover in part
    focused         blurred by the depth of field
    radiance        of the pixels
    bloom, lens     with bloom; with the lens's aberration and vignette
    toned, display  tone mapped; with edges blended
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from photograd_course.color import srgb_decode, srgb_encode

from photograd.capture.camera import Camera
from photograd.frame.antialiasing import fxaa
from photograd.frame.bloom import bloom
from photograd.frame.depth_of_field import depth_of_field
from photograd.frame.gbuffer import GBuffer, draw_surfaces, fill_gbuffer
from photograd.frame.graph import Pass, PassGraph
from photograd.frame.lens_effects import chromatic_aberration, vignette
from photograd.frame.light_views import background, delta_lights, sky_lights, surface_lights
from photograd.frame.lighting import Shadows, draw_shadow_maps, light_forward, light_surfaces
from photograd.frame.occlusion import ssao
from photograd.frame.options import FrameOptions
from photograd.frame.scene import KINDS, FrameScene
from photograd.frame.tone_mapping import tone_map
from photograd.raster import Visibility
from photograd.types import Array


def frame_graph(scene: FrameScene, options: FrameOptions) -> PassGraph:
    """The passes that make a picture of a scene.

    Args:
        scene: that is drawn; its numbers may change between runs, its lights stay where they are.
        options: which passes, and how.

    Returns:
        A graph with the input "camera" and the buffers above.

    Raises:
        RangeError: what an option's settings refuse.
    """
    passes = _Passes(scene, options)
    return PassGraph(
        [
            Pass("samples", passes.samples, ("camera",), ("samples",)),
            Pass("surfaces", passes.surfaces, ("samples",), ("visibility", "gbuffer")),
            Pass("shadows", passes.shadows, (), ("shadows",)),
            Pass("occlusion", passes.occlusion, ("gbuffer",), ("occlusion",)),
            Pass("direct", passes.direct, ("gbuffer", "shadows"), ("direct",)),
            Pass(
                "sky light", passes.sky_light, ("gbuffer", "shadows", "occlusion"), ("sky_light",)
            ),
            Pass("background", passes.background, ("samples",), ("background",)),
            Pass(
                "opaque",
                passes.opaque,
                ("gbuffer", "direct", "sky_light", "background"),
                ("opaque",),
            ),
            Pass(
                "layers",
                passes.layers,
                ("samples", "visibility", "opaque", "shadows"),
                ("layered",),
            ),
            Pass("focus", passes.focus, ("samples", "visibility", "layered"), ("focused",)),
            Pass("resolve", passes.resolve, ("focused",), ("radiance",)),
            Pass("bloom", passes.bloom, ("radiance",), ("bloom",)),
            Pass("lens", passes.lens, ("camera", "bloom"), ("lens",)),
            Pass("tone map", passes.tone_map, ("lens",), ("toned",)),
            Pass("fxaa", passes.fxaa, ("toned",), ("display",)),
        ],
        ["camera"],
    )


class _Passes:
    def __init__(self, scene: FrameScene, options: FrameOptions) -> None:
        self.scene = scene
        self.options = options
        self.lights = delta_lights(scene)
        if options.surface_points:
            self.lights += surface_lights(scene, options.surface_points)
        self.sky = sky_lights(scene, options.sky_directions) if options.sky_directions else []

    def samples(self, camera: Camera) -> Camera:
        """The camera with several pixels in the place of one."""
        n = self.options.supersampling
        return replace(
            camera,
            width=n * camera.width,
            height=n * camera.height,
            fx=n * camera.fx,
            fy=n * camera.fy,
            cx=n * camera.cx,
            cy=n * camera.cy,
        )

    def focus(self, samples: Camera, visibility: Visibility, layered: Array) -> Array:
        count, lens = self.options.depth_of_field, self.scene.scene.lens
        if not count or not lens.radius:
            return layered
        return depth_of_field(layered, visibility.depth, samples, lens, samples=count)

    def resolve(self, focused: Array) -> Array:
        """The mean of the samples of each pixel."""
        n = self.options.supersampling
        height, width, _ = focused.shape
        boxes = focused.reshape(height // n, n, width // n, n, 3)
        mean: Array = boxes.mean(axis=(1, 3), dtype=focused.dtype)
        return mean

    def surfaces(self, camera: Camera) -> tuple[Visibility, GBuffer]:
        return draw_surfaces(self.scene, camera, "opaque", "mask")

    def shadows(self) -> Shadows:
        with_maps = list(self.lights)
        if self.options.sky_visibility == "shadow_maps":
            with_maps += self.sky
        return draw_shadow_maps(self.scene, with_maps, self.options.shadows)

    def occlusion(self, surfaces: GBuffer) -> Array:
        """(H, W) from 0 to 1."""
        if self.options.sky_visibility != "occlusion" or not self.sky:
            return np.ones(surfaces.material.shape, self.scene.dtype)
        found = ssao(
            surfaces.depth.astype(self.scene.dtype),
            surfaces.shading,
            surfaces.camera,
            self.options.occlusion,
            samples=self.options.occlusion_samples,
        )
        return np.clip(found, 0.0, 1.0)

    def direct(self, surfaces: GBuffer, shadows: Shadows) -> Array:
        if self.options.shading == "forward":
            settings = self.options.shadows
            return light_forward(self.scene, surfaces.camera, self.lights, shadows, settings)[0]
        return light_surfaces(self.scene, surfaces, self.lights, shadows, self.options.shadows)

    def sky_light(self, surfaces: GBuffer, shadows: Shadows, occlusion: Array) -> Array:
        return light_surfaces(
            self.scene, surfaces, self.sky, shadows, self.options.shadows, occlusion
        )

    def background(self, camera: Camera) -> Array:
        return background(self.scene.scene, camera).astype(self.scene.dtype)

    def opaque(self, surfaces: GBuffer, direct: Array, sky_light: Array, behind: Array) -> Array:
        lit = surfaces.emission + direct + sky_light
        out: Array = np.where(surfaces.covered[..., None], lit, behind)
        return out

    def layers(
        self, camera: Camera, visibility: Visibility, opaque: Array, shadows: Shadows
    ) -> Array:
        """Depth peeling [Everitt2001]: what covers in part, the nearest layer first."""
        blended = self.scene.kind == KINDS.index("blended")
        color, clear = np.zeros_like(opaque), np.ones((*opaque.shape[:2], 1), opaque.dtype)
        behind: Array = np.full(clear.shape[:2], -np.inf)
        for _ in range(self.options.layers if blended.any() else 0):
            layer = self.scene.draw(camera, "blended", behind=behind)
            hidden = ~(layer.depth < visibility.depth)
            layer.face[hidden] = -1
            layer.depth[hidden] = np.inf
            if not layer.covered.any():
                break
            surfaces = fill_gbuffer(self.scene, camera, layer)
            occlusion = self.occlusion(surfaces)
            lit = surfaces.emission + self.direct(surfaces, shadows)
            lit = lit + self.sky_light(surfaces, shadows, occlusion)
            part = clear * surfaces.alpha[..., None]
            color, clear = color + part * lit, clear - part
            behind = np.where(layer.covered, layer.depth, np.inf)
        layered: Array = color + clear * opaque
        return layered

    def bloom(self, radiance: Array) -> Array:
        weights = np.array(self.options.bloom_weights, radiance.dtype)
        return bloom(radiance, weights, self.options.bloom_threshold) if len(weights) else radiance

    def lens(self, camera: Camera, radiance: Array) -> Array:
        if self.options.aberration:
            radiance = chromatic_aberration(radiance, self.options.aberration)
        if self.options.vignette:
            radiance = vignette(radiance, camera, self.options.vignette)
        return radiance

    def tone_map(self, radiance: Array) -> Array:
        return show(radiance, self.options)

    def fxaa(self, toned: Array) -> Array:
        if not self.options.fxaa:
            return toned
        encoded = srgb_encode(np.clip(toned, 0.0, 1.0)).astype(toned.dtype)
        return srgb_decode(fxaa(encoded)).astype(toned.dtype)


def show(radiance: Array, options: FrameOptions) -> Array:
    """What a display shows of radiance (H, W, 3), linear: exposed and tone mapped.

    Args:
        radiance: of at least 0.
        options: of which exposure and tone curve count.
    """
    if options.tone_curve is not None:
        return tone_map(radiance, options.tone_curve, exposure=options.exposure)
    exposed: Array = radiance * np.exp2(np.array(options.exposure, radiance.dtype))
    return exposed
