"""Surfaces that emit, met by directions that the reflectance of each surface chooses.

Points on an emitter are enough for rough surfaces. A smooth one shows the emitter's image, and
between the images of the points nothing. So both are sampled, and weighted with both densities by
the balance heuristic [Veach1995]: a point at distance r that is seen at the cosine c stands for
n / A points per area, n r^2 / (A c) per steradian.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from photograd.frame.gathering import ReflectanceSamples, reflectance_pdf
from photograd.frame.gbuffer import GBuffer
from photograd.frame.light_views import PatchLight
from photograd.frame.lighting import Shadows
from photograd.frame.scene import FrameScene
from photograd.frame.shadows import ShadowSettings, look_up_shadow
from photograd.geometry.mesh import Bvh, Mesh
from photograd.types import Array


class Emitters:
    """The triangles of a scene that emit; textures count by their mean, as for the points."""

    def __init__(self, scene: FrameScene, patches: Sequence[PatchLight]) -> None:
        """Find them.

        Args:
            scene: whose surfaces are looked at.
            patches: the points that stand for them, at least one for each surface.
        """
        self.scene, self.patches = scene, tuple(patches)
        numbers = scene.tracer.core_arguments(scene.scene.camera)["emission"].astype(np.float64)
        own = np.flatnonzero(numbers[scene.shape].any(axis=1))
        corners = scene.vertices[scene.faces[own]]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        length = np.sqrt((normal * normal).sum(axis=1))
        has_area = length > 0
        corners, own = corners[has_area], own[has_area]
        self.normal = (normal[has_area] / length[has_area, None]).astype(scene.dtype)
        self.radiance = numbers[scene.shape[own]].astype(scene.dtype)
        density = np.zeros(len(numbers), scene.dtype)
        for patch in self.patches:
            density[patch.shape] = patch.density
        self.density = density[scene.shape[own]]
        faces = np.arange(3 * len(corners), dtype=np.uint32).reshape(-1, 3)
        self.bvh = Bvh(Mesh(corners.reshape(-1, 3), faces))

    def arriving(
        self,
        surfaces: GBuffer,
        found: ReflectanceSamples,
        samples: int,
        shadows: Shadows,
        settings: ShadowSettings,
    ) -> Array:
        """Radiance (H, W, 3) of the emitters along samples, weighted against the points.

        What is in the way, the shadow map of the nearest point tells.

        Args:
            surfaces: of a G-buffer.
            found: their samples.
            samples: directions a pixel.
            shadows: of the points, by name.
            settings: of the shadow maps.
        """
        out = np.zeros((found.pdf.size, 3), self.scene.dtype)
        wi = found.wi.reshape(-1, 3)
        rows = np.flatnonzero(wi.any(axis=1))
        origins = surfaces.position.reshape(-1, 3)[rows]
        hits = self.bvh.trace(origins, wi[rows], 2.0 * self.scene.near)
        face = np.maximum(hits.primitive, 0)
        cosine = -(self.normal[face] * wi[rows]).sum(axis=1)
        met = (hits.primitive >= 0) & (cosine > 0)
        rows, face, cosine, t = rows[met], face[met], cosine[met], hits.t[met]
        theirs = self.density[face] * t * t / cosine
        ours = samples * found.pdf.reshape(-1)[rows]
        specular = ours == 0
        weight = np.where(specular, 1, ours / np.where(specular, 1, ours + theirs))
        weight = weight * self._visible(
            surfaces, rows, origins[met] + t[:, None] * wi[rows], shadows, settings
        )
        out[rows] = weight[:, None] * self.radiance[face]
        return out.reshape(found.wi.shape)

    def _visible(
        self,
        surfaces: GBuffer,
        rows: Array,
        targets: Array,
        shadows: Shadows,
        settings: ShadowSettings,
    ) -> Array:
        """(N,) from 0 to 1, how far pixels `rows` see their targets (N, 3)."""
        away = [
            ((targets - patch.position.astype(targets.dtype)) ** 2).sum(axis=1)
            for patch in self.patches
        ]
        nearest = np.argmin(away, axis=0)
        points = surfaces.position.reshape(-1, 3)[rows]
        normals = surfaces.normal.reshape(-1, 3)[rows]
        visible = np.ones(len(rows), targets.dtype)
        for k in np.unique(nearest):
            own = nearest == k
            shadow = shadows[self.patches[k].name]
            visible[own] = look_up_shadow(shadow, points[own], normals[own], settings)
        return visible


def patch_share(scene: FrameScene, surfaces: GBuffer, patch: PatchLight, samples: int) -> Array:
    """The weight (H, W) of a point on an emitter beside what the reflectance chooses.

    Args:
        scene: of the surfaces.
        surfaces: of a G-buffer.
        patch: the point.
        samples: directions a pixel of `gather`.
    """
    points = surfaces.position.reshape(-1, 3)
    wi, _ = patch.arriving(points)
    away = patch.position.astype(points.dtype) - points
    squared = (away * away).sum(axis=1)
    cosine = -(wi * patch.normal.astype(points.dtype)).sum(axis=1)
    lit = cosine > 0
    density = scene.dtype.type(patch.density) * squared / np.where(lit, cosine, 1)
    pdf = reflectance_pdf(scene, surfaces, wi.reshape(surfaces.position.shape)).reshape(-1)
    share = np.where(lit, density / np.where(lit, density + samples * pdf, 1), 1)
    return share.astype(scene.dtype).reshape(surfaces.material.shape)
