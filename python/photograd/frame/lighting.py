"""Lighting of surfaces: by lights with shadow maps, and by the sky with ambient occlusion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.frame.gbuffer import GBuffer, draw_surfaces, reflect, reflect_parallel
from photograd.frame.light_views import FrameLight
from photograd.frame.scene import FrameScene
from photograd.frame.shadows import ShadowMap, ShadowSettings, draw_shadow_map, look_up_shadow
from photograd.types import Array

Shadows = Mapping[str, ShadowMap]


@typed_call
def draw_shadow_maps(
    scene: FrameScene, lights: Sequence[FrameLight], settings: ShadowSettings
) -> dict[str, ShadowMap]:
    """A shadow map for each light, by its name.

    Args:
        scene: whose shadows these are.
        lights: whose.
        settings: of which the size counts.
    """
    return {
        light.name: draw_shadow_map(scene, light.views(scene, settings.size)) for light in lights
    }


@typed_call
def light_surfaces(
    scene: FrameScene,
    surfaces: GBuffer,
    lights: Sequence[FrameLight],
    shadows: Shadows,
    settings: ShadowSettings,
    visibility: Array | None = None,
) -> Array:
    """Radiance (H, W, 3) that the surfaces send to the viewer, without their own emission.

    Args:
        scene: of the surfaces.
        surfaces: of a G-buffer.
        lights: that shine on them.
        shadows: of the lights that have some.
        settings: of the shadow maps.
        visibility: (H, W), a factor of all light; None for 1.
    """
    size = surfaces.position.shape
    out = np.zeros(size, scene.dtype)
    visible = surfaces.covered.reshape(-1)
    points = surfaces.position.reshape(-1, 3)
    normals = surfaces.normal.reshape(-1, 3)
    part = visible.astype(scene.dtype)
    if visibility is not None:
        part *= visibility.reshape(-1)
    alike = [light for light in lights if light.is_parallel and light.name not in shadows]
    if alike:
        reflect_parallel(scene, surfaces, *_parallel(alike, scene), part.reshape(size[:2]), out)
    for light in lights:
        if light in alike:
            continue
        lit = part
        if light.name in shadows:
            lit = lit * look_up_shadow(shadows[light.name], points, normals, settings)
        if light.is_parallel:
            by = _parallel([light], scene)
            reflect_parallel(scene, surfaces, *by, lit.reshape(size[:2]), out)
            continue
        wi, irradiance = light.arriving(points)
        irradiance = irradiance * lit[:, None]
        reflect(scene, surfaces, wi.reshape(size), irradiance.reshape(size), out)
    return out


def _parallel(lights: Sequence[FrameLight], scene: FrameScene) -> tuple[Array, Array]:
    """Directions (D, 3), and irradiance of what faces them (D, 3)."""
    anywhere = np.zeros((1, 3), scene.dtype)
    found = [light.arriving(anywhere) for light in lights]
    return np.concatenate([f[0] for f in found]), np.concatenate([f[1] for f in found])


def light_forward(
    scene: FrameScene,
    camera: Camera,
    lights: Sequence[FrameLight],
    shadows: Shadows,
    settings: ShadowSettings,
    nearest: Array | None = None,
) -> tuple[Array, int]:
    """Forward shading: each shape is lit as it is drawn, hidden later or not.

    Args:
        scene: that is drawn, what covers whole; masks are drawn as they are, too.
        camera: of the picture.
        lights: that shine.
        shadows: of the lights that have some.
        settings: of the shadow maps.
        nearest: (H, W) depths of what is visible, drawn before, so that nothing hidden is lit. None
            lights what is nearest up to then.

    Returns:
        Radiance (H, W, 3), as `light_surfaces` finds it from the G-buffer, and how many fragments
        were lit for it.
    """
    size = (camera.height, camera.width)
    out, lit = np.zeros((*size, 3), scene.dtype), 0
    depth, done = np.full(size, np.inf), np.zeros(size, np.bool_)
    for shape in np.unique(scene.shape):
        visibility, surfaces = draw_surfaces(scene, camera, "opaque", "mask", shape=int(shape))
        visible = surfaces.covered & (visibility.depth < depth)
        if nearest is not None:
            visible = surfaces.covered & (visibility.depth == nearest) & ~done
        surfaces.material[~visible] = -1
        found = light_surfaces(scene, surfaces, lights, shadows, settings)
        out[visible], depth[visible] = found[visible], visibility.depth[visible]
        done |= visible
        lit += int(visible.sum())
    return out, lit
