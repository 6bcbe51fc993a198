"""Light gathered from directions that the reflectance of each surface chooses.

A ray through the frame's depths (`follow_screen_rays`) either meets a surface that the frame shows,
whose light it brings (screen-space irradiance and reflections in one), or it brings the sky. The
frame does not say how thick surfaces are; where shadow maps tell which part of the sky arrives,
they decide, and the frame is asked for the light of the rest alone.

Directions from which the sky is sampled as well are weighted with both densities by the balance
heuristic [Veach1995].
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.frame.gbuffer import GBuffer
from photograd.frame.light_views import GOLDEN_SECTION, SkyDirection, infinite_lights, sky_count
from photograd.frame.scene import FrameScene
from photograd.frame.screen_rays import ScreenRaySettings, follow_screen_rays
from photograd.frame.shadows import ShadowMap, ShadowSettings, look_up_shadow
from photograd.types import Array


@dataclass(frozen=True, eq=False)
class ReflectanceSamples:
    """One direction for each pixel.

    Attributes:
        wi: (H, W, 3) unit, in the world; 0 where there is none.
        weight: (H, W, 3) f cos / pdf.
        pdf: (H, W) per steradian; 0 of specular surfaces and where there is no direction.
    """

    wi: Array
    weight: Array
    pdf: Array


@typed_call
def sample_reflectance(scene: FrameScene, surfaces: GBuffer, u: Array) -> ReflectanceSamples:
    """Directions as a path would continue in them.

    Args:
        scene: of the surfaces.
        surfaces: of a G-buffer.
        u: (H, W, 3) uniform numbers, of at least 0 and below 1.

    Raises:
        DtypeError, ShapeError, RangeError: other numbers.
    """
    call = Arguments("sample_reflectance", scene.dtype)
    size = surfaces.material.shape
    u = call.array("u", u, (*size, 3), low=0.0, below=1.0)
    wi, weight = np.empty_like(u), np.empty_like(u)
    pdf = np.empty(size, scene.dtype)
    call.run(
        _core.sample_gbuffer,
        **surfaces.core_arguments(scene),
        u=u.reshape(-1, 3),
        wi=wi.reshape(-1, 3),
        weight=weight.reshape(-1, 3),
        pdf=pdf.reshape(-1),
    )
    return ReflectanceSamples(wi, weight, pdf)


@typed_call
def reflectance_pdf(scene: FrameScene, surfaces: GBuffer, wi: Array) -> Array:
    """The density (H, W) per steradian with which `sample_reflectance` chooses directions.

    Args:
        scene: of the surfaces.
        surfaces: of a G-buffer.
        wi: (3,) or (H, W, 3) unit vectors in the world.

    Raises:
        DtypeError, ShapeError: other arrays.
    """
    call = Arguments("reflectance_pdf", scene.dtype)
    size = surfaces.material.shape
    wi = call.array("wi", wi, (3,), (*size, 3))
    wi = np.ascontiguousarray(np.broadcast_to(wi, (*size, 3)))
    pdf = np.empty(size, scene.dtype)
    arguments = surfaces.core_arguments(scene)
    call.run(_core.gbuffer_pdf, **arguments, wi=wi.reshape(-1, 3), pdf=pdf.reshape(-1))
    return pdf


@typed_call
def gather(
    scene: FrameScene,
    surfaces: GBuffer,
    light: Array | None,
    rays: ScreenRaySettings,
    *,
    samples: int,
    sky_directions: int = 0,
    sky_visibility: Callable[[Array], Array] | None = None,
    emitted: Callable[[ReflectanceSamples], Array] | None = None,
) -> Array:
    """Light (H, W, 3) that surfaces send to the viewer, of what they reflect of the frame and sky.

    Args:
        scene: of the surfaces.
        surfaces: of a G-buffer.
        light: (H, W, 3) that the frame's surfaces send on, to be gathered; without their own
            emission where points stand for that. None for none.
        rays: how far and how finely the frame is looked through.
        samples: directions a pixel.
        sky_directions: of `sky_lights`, whose samples these are weighted against; 0 leaves the sky
            out.
        sky_visibility: tells for wi (H, W, 3) which part (H, W) of the sky arrives from there;
            None for all of it where the frame is not in the way.
        emitted: radiance (H, W, 3) of surfaces that emit along samples, weighted against the points
            that stand for them; None for none.

    Raises:
        DtypeError, ShapeError, RangeError: other arrays, or samples below 1.
    """
    call = Arguments("gather", scene.dtype)
    samples = call.integer("samples", samples, low=1, high=4096)
    if light is not None:
        light = call.array("light", light, surfaces.position.shape)
    out = np.zeros_like(surfaces.position)
    for k in range(samples):
        found = sample_reflectance(scene, surfaces, _uniform(surfaces, k, samples))
        arriving = np.zeros_like(out)
        if light is not None or (sky_directions and sky_visibility is None):
            hit = _meet(scene, surfaces, found.wi, rays)
            if light is not None:
                arriving = np.where(hit[..., None] >= 0, light.reshape(-1, 3)[hit], 0)
        if sky_directions:
            part = (hit < 0) if sky_visibility is None else sky_visibility(found.wi)
            part = part[..., None].astype(out.dtype)
            arriving = (1 - part) * arriving + part * _sky(scene, found, samples, sky_directions)
        if emitted is not None:
            arriving = arriving + emitted(found)
        out += found.weight * arriving / scene.dtype.type(samples)
    return out


def _meet(scene: FrameScene, surfaces: GBuffer, wi: Array, rays: ScreenRaySettings) -> Array:
    """(H, W) pixels whose surfaces are met, negative for none."""
    depth = surfaces.depth.astype(scene.dtype)
    return follow_screen_rays(depth, surfaces.shading, surfaces.camera, wi, rays)


def sky_share(scene: FrameScene, surfaces: GBuffer, direction: SkyDirection, samples: int) -> Array:
    """The weight (H, W) of a direction of the sky beside those that the reflectance chooses.

    Args:
        scene: of the surfaces.
        surfaces: of a G-buffer.
        direction: of `sky_lights`.
        samples: directions a pixel of `gather`.
    """
    pdf = reflectance_pdf(scene, surfaces, np.asarray(direction.light.direction))
    share: Array = direction.density / (direction.density + samples * pdf)
    return share.astype(scene.dtype)


def nearest_shadow(
    surfaces: GBuffer,
    wi: Array,
    sky: Sequence[SkyDirection],
    shadows: Mapping[str, ShadowMap],
    settings: ShadowSettings,
) -> Array:
    """The part (H, W) of the sky that arrives from wi, by the shadow map nearest to it.

    Args:
        surfaces: of a G-buffer.
        wi: (H, W, 3) unit vectors in the world.
        sky: directions of the sky.
        shadows: of them, by name.
        settings: of the shadow maps.
    """
    towards = np.stack([np.asarray(light.light.direction, wi.dtype) for light in sky])
    flat, cosines = wi.reshape(-1, 3), np.empty((len(sky), wi.size // 3), wi.dtype)
    for k, direction in enumerate(towards):
        cosines[k] = (flat * direction).sum(axis=1)
    nearest = cosines.argmax(axis=0)
    points, normals = surfaces.position.reshape(-1, 3), surfaces.normal.reshape(-1, 3)
    out = np.ones(len(flat), wi.dtype)
    for k in np.unique(nearest):
        own = nearest == k
        shadow = shadows[sky[k].name]
        out[own] = look_up_shadow(shadow, points[own], normals[own], settings)
    visible: Array = out.reshape(wi.shape[:2])
    return visible


def _sky(scene: FrameScene, found: ReflectanceSamples, samples: int, directions: int) -> Array:
    """Radiance of the sky (H, W, 3) along the samples, weighted against its own."""
    chosen = found.wi.any(axis=-1, keepdims=True)
    wi = np.where(chosen, found.wi, np.eye(3, dtype=found.wi.dtype)[0]).reshape(-1, 3)
    origin, out = np.zeros_like(wi), np.zeros_like(wi)
    ours = samples * found.pdf.reshape(-1)
    specular = ours == 0
    for light in infinite_lights(scene.scene).values():
        theirs = sky_count(light, directions) * light.pdf(origin, wi)
        weight = np.where(specular, 1, ours / np.where(specular, 1, ours + theirs))
        out += weight[:, None] * light.L(origin, wi)
    sky: Array = out.reshape(found.wi.shape)
    return sky


def _uniform(surfaces: GBuffer, k: int, samples: int) -> Array:
    """Numbers (H, W, 3) of the k-th sample: a lattice, shifted by another one over the pixels."""
    height, width = surfaces.material.shape
    y, x = np.mgrid[:height, :width]
    # Generators of the second and third order of the golden section [Roberts2018].
    shift = (0.7548776662466927 * x + 0.5698402909980532 * y) % 1.0
    first = (k + shift) / samples
    second = (GOLDEN_SECTION * k + 0.8191725134 * x + 0.6710436067 * y) % 1.0
    third = (0.5497004779 * k + 0.3819660113 * x + 0.2360679775 * y) % 1.0
    u = np.stack([first % 1.0, second, third], axis=-1).astype(surfaces.position.dtype)
    below_one: Array = np.minimum(u, np.nextafter(u.dtype.type(1), u.dtype.type(0)))
    return below_one
