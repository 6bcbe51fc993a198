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
    gathered        light that surfaces reflect of the frame, and of the sky behind it
    background      radiance behind everything
    opaque          all of these
    layered         with surfaces before it that cover in part
    fogged          seen through fog
    focused         blurred by the depth of field
    radiance        of the pixels
    bloom, lens     with bloom; with the lens's aberration and vignette
    toned, display  tone mapped; with edges blended
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property

import numpy as np
from photograd_course.color import srgb_decode, srgb_encode

from photograd.capture.camera import Camera
from photograd.frame.antialiasing import fxaa
from photograd.frame.bloom import bloom
from photograd.frame.depth_of_field import depth_of_field
from photograd.frame.disks import Disks, scene_disks
from photograd.frame.fog import add_fog
from photograd.frame.gathering import gather, nearest_shadow, sky_share
from photograd.frame.gbuffer import GBuffer, draw_surfaces, fill_gbuffer
from photograd.frame.graph import Pass, PassGraph
from photograd.frame.horizon import horizon_occlusion
from photograd.frame.lens_effects import chromatic_aberration, vignette
from photograd.frame.light_views import background, delta_lights, sky_lights, surface_lights
from photograd.frame.lighting import Shadows, draw_shadow_maps, light_forward, light_surfaces
from photograd.frame.occlusion import ssao
from photograd.frame.options import FrameOptions
from photograd.frame.scene import KINDS, FrameScene
from photograd.frame.screen_rays import follow_screen_rays
from photograd.frame.tone_mapping import tone_map
from photograd.frame.transparency import Layer, blend_nearest_first, blend_weighted
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
            Pass(
                "gather",
                passes.gather,
                ("gbuffer", "direct", "sky_light", "shadows"),
                ("gathered",),
            ),
            Pass("background", passes.background, ("samples",), ("background",)),
            Pass(
                "opaque",
                passes.opaque,
                ("gbuffer", "direct", "sky_light", "gathered", "background"),
                ("opaque",),
            ),
            Pass(
                "layers",
                passes.layers,
                ("samples", "visibility", "opaque", "shadows"),
                ("layered",),
            ),
            Pass("fog", passes.fog, ("samples", "visibility", "layered"), ("fogged",)),
            Pass("focus", passes.focus, ("samples", "visibility", "fogged"), ("focused",)),
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

    def fog(self, samples: Camera, visibility: Visibility, layered: Array) -> Array:
        if not self.options.fog:
            return layered
        color = np.array(self.options.fog_color)
        return add_fog(layered, visibility.depth, samples, self.options.fog, color)

    def focus(self, samples: Camera, visibility: Visibility, fogged: Array) -> Array:
        count, lens = self.options.depth_of_field, self.scene.scene.lens
        if not count or not lens.radius:
            return fogged
        return depth_of_field(fogged, visibility.depth, samples, lens, samples=count)

    def resolve(self, focused: Array) -> Array:
        """The mean of the samples of each pixel."""
        n = self.options.supersampling
        height, width = focused.shape[:2]
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
        technique = self.options.sky_visibility if self.sky else "none"
        depth = surfaces.depth.astype(self.scene.dtype)
        if technique == "occlusion":
            found = ssao(
                depth,
                surfaces.shading,
                surfaces.camera,
                self.options.occlusion,
                samples=self.options.occlusion_samples,
            )
            return np.clip(found, 0.0, 1.0)
        if technique == "horizon":
            horizon = self.options.horizon
            return horizon_occlusion(depth, surfaces.shading, surfaces.camera, horizon)
        if technique == "disks":
            points, normals = surfaces.position.reshape(-1, 3), surfaces.shading.reshape(-1, 3)
            return self.disks.occlusion(points, normals).reshape(depth.shape)
        return np.ones_like(depth)

    @cached_property
    def disks(self) -> Disks:
        """Of the scene, found when they are first needed."""
        return scene_disks(self.scene, edge=self.options.disk_edge)

    def direct(self, surfaces: GBuffer, shadows: Shadows) -> Array:
        if self.options.shading == "forward":
            settings = self.options.shadows
            return light_forward(self.scene, surfaces.camera, self.lights, shadows, settings)[0]
        return light_surfaces(self.scene, surfaces, self.lights, shadows, self.options.shadows)

    def sky_light(self, surfaces: GBuffer, shadows: Shadows, occlusion: Array) -> Array:
        """Where the reflectance is sampled as well, both samples share the light."""
        return self._sky_light(surfaces, shadows, occlusion, self.options.gather_samples)

    def _sky_light(
        self, surfaces: GBuffer, shadows: Shadows, occlusion: Array, count: int
    ) -> Array:
        settings = self.options.shadows
        directional = self.options.sky_visibility == "directional"
        if not count and not directional:
            return light_surfaces(self.scene, surfaces, self.sky, shadows, settings, occlusion)
        out = np.zeros_like(surfaces.position)
        for light in self.sky:
            visible = occlusion
            if count:
                visible = visible * sky_share(self.scene, surfaces, light, count)
            if directional:
                hit = self._follow(surfaces, np.asarray(light.light.direction))
                visible = visible * (hit < 0)
            out += light_surfaces(self.scene, surfaces, [light], shadows, settings, visible)
        return out

    def _follow(self, surfaces: GBuffer, wi: Array) -> Array:
        depth = surfaces.depth.astype(self.scene.dtype)
        rays = self.options.screen_rays
        return follow_screen_rays(depth, surfaces.shading, surfaces.camera, wi, rays)

    def gather(self, surfaces: GBuffer, direct: Array, sky_light: Array, shadows: Shadows) -> Array:
        if not self.options.gather_samples:
            return np.zeros_like(direct)
        with_maps = self.options.sky_visibility == "shadow_maps"

        def visible(wi: Array) -> Array:
            return nearest_shadow(surfaces, wi, self.sky, shadows, self.options.shadows)

        return gather(
            self.scene,
            surfaces,
            direct + sky_light,
            self.options.screen_rays,
            samples=self.options.gather_samples,
            sky_directions=self.options.sky_directions,
            sky_visibility=visible if with_maps and self.sky else None,
        )

    def background(self, camera: Camera) -> Array:
        return background(self.scene.scene, camera).astype(self.scene.dtype)

    def opaque(
        self, surfaces: GBuffer, direct: Array, sky_light: Array, gathered: Array, behind: Array
    ) -> Array:
        lit = surfaces.emission + direct + sky_light + gathered
        out: Array = np.where(surfaces.covered[..., None], lit, behind)
        return out

    def layers(
        self, camera: Camera, visibility: Visibility, opaque: Array, shadows: Shadows
    ) -> Array:
        """Surfaces that cover in part, before the opaque ones."""
        blended = np.unique(self.scene.shape[self.scene.kind == KINDS.index("blended")])

        def layers(shape: int | None = None) -> Iterator[Layer]:
            return self._peel(camera, visibility, shadows, shape)

        if not len(blended):
            return opaque
        if self.options.transparency == "peeled":
            return blend_nearest_first(layers(), opaque)
        if self.options.transparency == "weighted":
            every = (layer for shape in blended for layer in layers(int(shape)))
            return blend_weighted(every, opaque, self.scene.radius)
        centers = np.stack([self.scene.center_of(int(shape)) for shape in blended])
        distance = ((centers - camera.position) ** 2).sum(axis=1)
        for shape in blended[np.argsort(-distance, kind="stable")]:
            opaque = blend_nearest_first(layers(int(shape)), opaque)
        return opaque

    def _peel(
        self, camera: Camera, visibility: Visibility, shadows: Shadows, shape: int | None
    ) -> Iterator[Layer]:
        """Layers before the opaque surfaces, of one shape or all, the nearest first."""
        behind: Array = np.full((camera.height, camera.width), -np.inf)
        for _ in range(self.options.layers):
            layer = self.scene.draw(camera, "blended", behind=behind, shape=shape)
            hidden = ~(layer.depth < visibility.depth)
            layer.face[hidden] = -1
            layer.depth[hidden] = np.inf
            if not layer.covered.any():
                return
            surfaces = fill_gbuffer(self.scene, camera, layer)
            settings = self.options.shadows
            lit = light_surfaces(self.scene, surfaces, self.lights, shadows, settings)
            lit = surfaces.emission + lit
            lit = lit + self._sky_light(surfaces, shadows, self.occlusion(surfaces), 0)
            yield Layer(layer.depth, lit, surfaces.alpha)
            behind = np.where(layer.covered, layer.depth, np.inf)

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
