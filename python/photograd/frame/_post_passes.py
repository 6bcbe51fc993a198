"""Passes that make a picture of the light of a frame: motion, lens, display."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from photograd_course.color import srgb_decode, srgb_encode

from photograd.capture.camera import Camera
from photograd.frame.antialiasing import TemporalAntialiasing, fxaa
from photograd.frame.bloom import bloom
from photograd.frame.depth_of_field import depth_of_field
from photograd.frame.dithering import dither
from photograd.frame.fog import add_fog
from photograd.frame.gbuffer import GBuffer
from photograd.frame.lens_effects import chromatic_aberration, vignette
from photograd.frame.motion import LastFrame, motion_blur, velocity
from photograd.frame.options import FrameOptions
from photograd.frame.scene import FrameScene
from photograd.frame.tone_mapping import tone_map
from photograd.raster import Visibility
from photograd.types import Array


class PostPasses:
    """What `frame_graph` runs on the light that reaches the camera; a method is a pass."""

    def __init__(self, scene: FrameScene, options: FrameOptions) -> None:
        self.scene = scene
        self.options = options

    def samples(self, camera: Camera, last: LastFrame | None = None) -> Camera:
        """The camera with several pixels in the place of one, moved by part of a pixel."""
        if last is not None and self.options.temporal:
            camera = self._antialiasing(last).camera(camera)
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

    def _antialiasing(self, last: LastFrame) -> TemporalAntialiasing:
        if last.history is None:
            return TemporalAntialiasing(weight=self.options.temporal)
        return replace(last.history)

    def fog(self, samples: Camera, visibility: Visibility, layered: Array) -> Array:
        """The picture, seen through fog."""
        if not self.options.fog:
            return layered
        color = np.array(self.options.fog_color)
        return add_fog(layered, visibility.depth, samples, self.options.fog, color)

    def focus(self, samples: Camera, visibility: Visibility, fogged: Array) -> Array:
        """The picture, blurred by the scene's lens."""
        count, lens = self.options.depth_of_field, self.scene.scene.lens
        if not count or not lens.radius:
            return fogged
        return depth_of_field(fogged, visibility.depth, samples, lens, samples=count)

    def velocity(self, surfaces: GBuffer, visibility: Visibility, last: LastFrame) -> Array:
        """Both cameras are moved by the same part of a pixel: what stands still has none."""
        face = visibility.face
        shape = np.where(face >= 0, self.scene.shape[face], -1).astype(np.int64)
        return velocity(surfaces, self.samples(last.camera, last), shape, last.moved)

    def motion_blur(self, focused: Array, moved: Array) -> Array:
        """The picture, blurred while the shutter is open."""
        count = self.options.shutter_samples
        by = np.asarray(moved, focused.dtype)
        return motion_blur(focused, by, self.options.shutter, samples=count)

    def resolve(self, focused: Array) -> Array:
        """The mean of the samples of each pixel."""
        n = self.options.supersampling
        height, width = focused.shape[:2]
        boxes = focused.reshape(height // n, n, width // n, n, 3)
        mean: Array = boxes.mean(axis=(1, 3), dtype=focused.dtype)
        return mean

    def accumulate(
        self, radiance: Array, moved: Array, last: LastFrame
    ) -> tuple[Array, TemporalAntialiasing | None]:
        """The mean over frames, and what the next one goes on with."""
        if not self.options.temporal:
            return radiance, None
        history = self._antialiasing(last)
        n = self.options.supersampling
        middle = np.ascontiguousarray(moved[n // 2 :: n, n // 2 :: n]) / n
        return history.add(radiance, middle), history

    def bloom(self, radiance: Array) -> Array:
        """The picture with bloom."""
        weights = np.array(self.options.bloom_weights, radiance.dtype)
        return bloom(radiance, weights, self.options.bloom_threshold) if len(weights) else radiance

    def lens(self, camera: Camera, radiance: Array) -> Array:
        """The picture with the lens's aberration and vignette."""
        if self.options.aberration:
            radiance = chromatic_aberration(radiance, self.options.aberration)
        if self.options.vignette:
            radiance = vignette(radiance, camera, self.options.vignette)
        return radiance

    def tone_map(self, radiance: Array) -> Array:
        """What a display shows."""
        return show(radiance, self.options)

    def fxaa(self, toned: Array) -> Array:
        """The same with edges blended."""
        if not self.options.fxaa:
            return toned
        encoded = srgb_encode(np.clip(toned, 0.0, 1.0)).astype(toned.dtype)
        return srgb_decode(fxaa(encoded)).astype(toned.dtype)

    def dither(self, smoothed: Array) -> Array:
        """The same, linear still, of the levels that a display has."""
        levels = self.options.dither_levels
        if not levels:
            return smoothed
        encoded = srgb_encode(np.clip(smoothed, 0.0, 1.0)).astype(smoothed.dtype)
        rounded = dither(encoded, levels=levels, seed=self.options.dither_seed)
        return srgb_decode(rounded).astype(smoothed.dtype)


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
