"""Passes that find the light of a frame: what hides it, what arrives, and what is before it."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property

import numpy as np

from photograd.capture.camera import Camera
from photograd.frame.disks import Disks, scene_disks
from photograd.frame.emitters import Emitters, patch_share
from photograd.frame.gathering import ReflectanceSamples, gather, nearest_shadow, sky_share
from photograd.frame.gbuffer import GBuffer, draw_surfaces, fill_gbuffer
from photograd.frame.horizon import horizon_occlusion
from photograd.frame.light_views import background, delta_lights, sky_lights, surface_lights
from photograd.frame.lighting import Shadows, draw_shadow_maps, light_forward, light_surfaces
from photograd.frame.occlusion import ssao
from photograd.frame.options import FrameOptions
from photograd.frame.scene import KINDS, FrameScene
from photograd.frame.screen_rays import follow_screen_rays
from photograd.frame.transparency import Layer, blend_nearest_first, blend_weighted
from photograd.raster import Visibility
from photograd.types import Array


class LightPasses:
    """What `frame_graph` runs up to the light that reaches the camera; a method is a pass."""

    def __init__(self, scene: FrameScene, options: FrameOptions) -> None:
        self.scene = scene
        self.options = options
        self.patches = (
            surface_lights(scene, options.surface_points) if options.surface_points else []
        )
        self.lights = [*delta_lights(scene), *self.patches]
        self.sky = sky_lights(scene, options.sky_directions) if options.sky_directions else []

    def surfaces(self, camera: Camera) -> tuple[Visibility, GBuffer]:
        """What each pixel sees first, and its surface."""
        return draw_surfaces(self.scene, camera, "opaque", "mask", culling=self.options.culling)

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

    def shadows(self) -> Shadows:
        """Shadow maps of the lights, and of the sky where they hide it."""
        with_maps = list(self.lights)
        if self.options.sky_visibility == "shadow_maps":
            with_maps += self.sky
        return draw_shadow_maps(self.scene, with_maps, self.options.shadows)

    def direct(self, surfaces: GBuffer, visibility: Visibility, shadows: Shadows) -> Array:
        """Light of points, spots, directions and surfaces that emit."""
        settings = self.options.shadows
        if self.options.shading == "deferred":
            return self._direct(surfaces, shadows)
        nearest = visibility.depth if self.options.depth_prepass else None
        camera = surfaces.camera
        return light_forward(self.scene, camera, self.lights, shadows, settings, nearest)[0]

    def _direct(self, surfaces: GBuffer, shadows: Shadows) -> Array:
        """Where emitters are gathered as well, points on them and samples share the light."""
        settings = self.options.shadows
        if not self._gathers_emitters:
            return light_surfaces(self.scene, surfaces, self.lights, shadows, settings)
        deltas = self.lights[: len(self.lights) - len(self.patches)]
        out = light_surfaces(self.scene, surfaces, deltas, shadows, settings)
        for patch in self.patches:
            share = patch_share(self.scene, surfaces, patch, self.options.gather_samples)
            out += light_surfaces(self.scene, surfaces, [patch], shadows, settings, share)
        return out

    @property
    def _gathers_emitters(self) -> bool:
        deferred = self.options.shading == "deferred"
        return bool(self.options.gather_samples and self.patches and deferred)

    @cached_property
    def emitters(self) -> Emitters:
        """Of the scene, found when they are first needed."""
        return Emitters(self.scene, self.patches)

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
        """Light of other pixels, of the sky behind them, and of surfaces that emit."""
        samples = self.options.gather_samples
        if not samples:
            return np.zeros_like(direct)
        with_maps = self.options.sky_visibility == "shadow_maps"

        def visible(wi: Array) -> Array:
            return nearest_shadow(surfaces, wi, self.sky, shadows, self.options.shadows)

        def emitted(found: ReflectanceSamples) -> Array:
            return self.emitters.arriving(surfaces, found, samples, shadows, self.options.shadows)

        light = direct + sky_light if self.options.gather_frame else None
        return gather(
            self.scene,
            surfaces,
            light,
            self.options.screen_rays,
            samples=samples,
            sky_directions=self.options.sky_directions if self.sky else 0,
            sky_visibility=visible if with_maps and self.sky else None,
            emitted=emitted if self._gathers_emitters else None,
        )

    def background(self, camera: Camera, surfaces: GBuffer) -> Array:
        """Radiance behind everything, where no surface is."""
        return background(self.scene.scene, camera, surfaces.covered, dtype=self.scene.dtype)

    def opaque(
        self, surfaces: GBuffer, direct: Array, sky_light: Array, gathered: Array, behind: Array
    ) -> Array:
        """The sum of all light, before the background: no pixel has both."""
        lit: Array = surfaces.emission + direct
        for light in (sky_light, gathered, behind):
            lit += light
        return lit

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
