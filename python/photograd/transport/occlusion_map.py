"""Ambient occlusion baked into a texture: asked once of each texel, not once a view.

The mathematics is in cpp/photograd/render/ambient_occlusion.h, which texel shows what in
cpp/photograd/geometry/texel_cover.h. Such a map stands for the shadows of an even sky in renderers
that cast none: under `ConstantLight`, direct light alone, a Lambertian surface sends albedo times
map times radiance. As an `OcclusionMap` of a material it goes into glTF files and to
`photograd.lights.prefilter.shade`, which knows of no other shadows. A path tracer finds those
shadows itself; to multiply its light by a map would count them twice, and dims what no sky has
sent.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from photograd_course.suggest import choose_from

from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.errors import RangeError, SceneError, message
from photograd.transport.motion import refuse_motion
from photograd.transport.scene import Scene
from photograd.transport.shapes import MeshShape
from photograd.transport.texture import Texture
from photograd.transport.tracer import PathTracer
from photograd.types import Array

MARGIN = 8
"""Texels around what is covered that go on as it does at its edge, so that lookups between texels,
and the first coarser levels, see nothing else."""
_OUTSIDE = 1e-4


@dataclass(frozen=True, eq=False)
class TexelPoints:
    """What the texels of a mesh show.

    Attributes:
        covered: (H, W) bool: whether any triangle covers the texel's center.
        points, normals: (N, 3) of the covered texels, row by row, in the world; meters, and unit
            normals of the triangles' fronts.
        contested: texels inside of more than one triangle, of which the first one counts.
    """

    covered: Array
    points: Array
    normals: Array
    contested: int


class OcclusionBake:
    """The occlusion of one mesh, sample by sample.

    Attributes:
        points: what is asked.
        count: samples a texel so far.
    """

    def __init__(
        self,
        scene: Scene,
        shape: str,
        resolution: int | tuple[int, int],
        *,
        radius: float = np.inf,
        seed: int,
    ) -> None:
        """Find the texels; arguments and errors as `bake_ambient_occlusion`.

        Args:
            scene: that occludes.
            shape: name of the mesh.
            resolution: texels along both edges, or (height, width).
            radius: meters beyond which nothing occludes.
            seed: of all random numbers.
        """
        height, width = (resolution, resolution) if isinstance(resolution, int) else resolution
        if min(height, width) < 1:
            raise _wrong("resolution", "at least 1 texel along each axis", resolution)
        if not radius > 0:
            raise _wrong("radius", "above 0 m", radius)
        self.points = texel_points(_mesh_named(scene, shape), height, width)
        refuse_motion(_NAME, scene.shapes)
        self._geometry = PathTracer(scene)._geometry  # media dim no sight of the sky
        self._radius, self._seed = radius, seed
        self._free = np.zeros(len(self.points.points))
        self.count = 0

    def add_samples(self, spp: int) -> None:
        """Add the next `spp` rays of each texel.

        Raises:
            RangeError: spp below 1.
        """
        if spp < 1:
            raise _wrong("spp", "at least 1", spp)
        at = self.points
        _core.point_occlusion(
            self._geometry,
            at.points,
            at.normals,
            self._radius,
            self._seed,
            self.count,
            spp,
            self._free,
        )
        self.count += spp

    def texture(self) -> Texture:
        """The map so far, (H, W, 1)."""
        if self.count < 1:
            raise _wrong("spp", "at least 1", self.count)
        values = np.zeros(self.points.covered.shape)
        values[self.points.covered] = self._free / self.count
        return Texture(continued(values, self.points.covered)[..., None], ("clamp", "clamp"))


@typed_call
def bake_ambient_occlusion(
    scene: Scene,
    shape: str,
    resolution: int | tuple[int, int],
    *,
    radius: float = np.inf,
    spp: int = 256,
    seed: int,
) -> Texture:
    """The free part of the sky over each texel of a mesh, weighted with the cosine.

    1 where nothing lies within `radius` of the texel's center, seen from the front of its triangle;
    0 where all directions are blocked. Texels that no triangle covers with its center continue
    those nearby. Charts that lie closer than two texels bleed into each other.

    Args:
        scene: all that occludes, the mesh itself included; lights with a surface do, too.
        shape: name of a mesh whose texture coordinates lie in 0..1 and unfold it without overlap.
        resolution: texels along both axes, or (H, W).
        radius: meters within which a surface occludes.
        spp: rays a texel; powers of two are spread most evenly.
        seed: of all random numbers; the same one gives the same bits on any threads.

    Returns:
        A linear texture (H, W, 1).

    Raises:
        SceneError: no such mesh, or one of several instances, without coordinates, with coordinates
            beyond 0..1, or too small in its texture for any texel; or shapes that move.
        RangeError: no texels or samples, or a radius that is not above 0.
    """
    bake = OcclusionBake(scene, shape, resolution, radius=radius, seed=seed)
    bake.add_samples(spp)
    return bake.texture()


def texel_points(mesh: MeshShape, height: int, width: int) -> TexelPoints:
    """The points of a mesh that the centers of (height, width) texels show.

    Warns where the mesh lies on itself in its texture.
    """
    assert mesh.uv is not None
    face, weights, contested = _core.cover_texels(mesh.uv, mesh.faces, height, width)
    covered = face >= 0
    if not covered.any():
        got = f"none of {height} x {width}"
        raise SceneError(message(_NAME, f"{mesh.name}.uv", "to cover a texel's center", got))
    if contested:
        warnings.warn(
            f"{mesh.name}: {contested} texels show more than one place; the first is baked",
            stacklevel=3,
        )
    instance = mesh.instances[0] if mesh.instances else np.eye(4)
    vertices = mesh.vertices.astype(np.float64) @ instance[:3, :3].T + instance[:3, 3]
    corners = vertices[mesh.faces[face[covered]]]
    along, across = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    s, t = weights[covered].T[..., None]
    normals = np.cross(along, across)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    points = corners[:, 0] + s * along + t * across
    return TexelPoints(covered, np.ascontiguousarray(points), normals, contested)


def continued(values: Array, known: Array) -> Array:
    """Values (H, W) where `known`; elsewhere, ring by ring, the mean of neighbors that are.

    Beyond `MARGIN` rings it is the mean of all.

    Args:
        values: (H, W).
        known: (H, W).
    """
    found, done = np.where(known, values, 0.0), known.copy()
    for _ in range(MARGIN):
        if done.all():
            return found
        sums, counts = _neighbor_sums(found), _neighbor_sums(done.astype(np.float64))
        new = ~done & (counts > 0)
        found[new] = sums[new] / counts[new]
        done |= new
    return np.where(done, found, values[known].mean())


def _neighbor_sums(values: Array) -> Array:
    """Sums over the eight texels around each, nothing beyond the border."""
    height, width = values.shape
    wide = np.pad(values, 1)
    block = sum(wide[i : i + height, j : j + width] for i, j in np.ndindex(3, 3))
    return np.asarray(block - values)


_NAME = "bake_ambient_occlusion"


def _mesh_named(scene: Scene, shape: str) -> MeshShape:
    meshes = {s.name: s for s in scene.shapes if isinstance(s, MeshShape)}
    if shape not in meshes:
        known = choose_from(shape, meshes)
        raise SceneError(message(_NAME, "shape", "a mesh of the scene", shape, known))
    mesh = meshes[shape]
    if mesh.uv is None:
        raise SceneError(message(_NAME, f"{shape}.uv", "texture coordinates", "none"))
    low, high = float(mesh.uv.min()), float(mesh.uv.max())
    if low < -_OUTSIDE or high > 1 + _OUTSIDE:
        expected, remedy = "coordinates in 0..1", "a texture that repeats cannot hold shadows"
        raise SceneError(message(_NAME, f"{shape}.uv", expected, f"{low:g} to {high:g}", remedy))
    if len(mesh.instances) > 1:
        expected = "a mesh with at most one instance"
        got = f"{len(mesh.instances)} instances, each in shadows of its own"
        raise SceneError(message(_NAME, f"{shape}.instances", expected, got))
    return mesh


def _wrong(argument: str, expected: str, got: object) -> RangeError:
    return RangeError(message(_NAME, argument, expected, got))
