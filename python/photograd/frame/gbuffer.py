"""The G-buffer: what the surface in each pixel is, kept to be lit by later passes [Saito1990].

It is filled from a visibility buffer [Burns2013] by the path tracer's own lookups: normals, normal
maps, textures between the levels of their mip maps, and the parameters of reflectance models are
those that a path would meet at the centers of the pixels.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.frame.meshlets import Culling
from photograd.frame.scene import KINDS, FrameScene
from photograd.raster import Visibility
from photograd.types import Array


@typed_call
@dataclass(frozen=True, eq=False)
class GBuffer:
    """Surfaces of the pixels of a camera.

    Attributes:
        camera: that sees them.
        depth: (H, W) float64 along the camera's axis, meters; infinite where nothing is visible.
        material: (H, W) int32, the number of the material, -1 where nothing is visible.
        position: (H, W, 3) in the world, meters. All further ones are 0 where nothing is visible.
        normal: (H, W, 3) unit, of the face, towards the viewer unless light may pass.
        shading: (H, W, 3) unit, interpolated and bent by normal maps, on the same side.
        tangent: (H, W, 3) unit, along growing u where the material has a direction; else 0.
        emission: (H, W, 3) radiance of the surface itself.
        alpha: (H, W) the part of what is behind that it covers; 0 or 1 of masks.
        rows: (H, W, P) parameters of the reflectance model, textures included; P is 0 in a scene
            without textures, where `material` says them all.
    """

    camera: Camera
    depth: Array
    material: Array
    position: Array
    normal: Array
    shading: Array
    tangent: Array
    emission: Array
    alpha: Array
    rows: Array

    @property
    def covered(self) -> Array:
        """(H, W) bool, whether a surface is visible."""
        return self.material >= 0

    def core_arguments(self, scene: FrameScene) -> dict[str, Any]:
        """What the core's functions of lit surfaces take, by name.

        Args:
            scene: of the surfaces.
        """
        arguments = scene.tracer.core_arguments(self.camera)
        del arguments["camera"]
        eye = tuple(self.camera.position.tolist())
        return {**arguments, "eye": eye, "gbuffer": self.flat()}

    def flat(self) -> dict[str, Array]:
        """The arrays that the core reads, (H W, ...) each, without copies."""
        count = self.material.size
        return {
            name: getattr(self, name).reshape((count, *getattr(self, name).shape[2:]))
            for name in _NAMES
        }


_NAMES = (*("material", "position", "normal", "shading", "tangent"), *("emission", "alpha", "rows"))


@typed_call
def fill_gbuffer(scene: FrameScene, camera: Camera, visibility: Visibility) -> GBuffer:
    """Look up the surfaces that a visibility buffer shows.

    Args:
        scene: that was drawn.
        camera: by which.
        visibility: of `FrameScene.draw`.

    Raises:
        ShapeError: a visibility buffer of another size.
        Error: what the core refuses.
    """
    call = Arguments("fill_gbuffer")
    size = (camera.height, camera.width)
    face = call.array("visibility.face", visibility.face, size, dtype=np.int32)
    dtype = scene.dtype
    textured = any(material.textures for material in scene.scene.materials.values())
    width = _widest(scene) if textured else 0
    out = GBuffer(
        camera,
        visibility.depth,
        material=np.empty(size, np.int32),
        position=np.empty((*size, 3), dtype),
        normal=np.empty((*size, 3), dtype),
        shading=np.empty((*size, 3), dtype),
        tangent=np.empty((*size, 3), dtype),
        emission=np.empty((*size, 3), dtype),
        alpha=np.empty(size, dtype),
        rows=np.empty((*size, width), dtype),
    )
    arguments = scene.tracer.core_arguments(camera)
    call.run(
        _core.fill_gbuffer,
        **arguments,
        face=face.reshape(-1),
        shape=scene.shape,
        primitive=scene.primitive,
        gbuffer=out.flat(),
    )
    return out


MASK_LAYERS = 16
"""Masks behind one another that a pixel is looked through."""


@typed_call
def draw_surfaces(
    scene: FrameScene,
    camera: Camera,
    *kinds: str,
    behind: Array | None = None,
    shape: int | None = None,
    culling: Culling = "none",
) -> tuple[Visibility, GBuffer]:
    """What each pixel sees first, masks only where they cover, and its surface.

    Where a mask covers nothing, the layer behind it is drawn.

    Args:
        scene: that is drawn.
        camera: of the picture.
        kinds: of faces, of `photograd.frame.scene.KINDS`.
        behind: (H, W) depths; only what lies further away is drawn. None draws all.
        shape: of the core, which alone is drawn; None draws all.
        culling: of clusters of triangles.
    """
    visibility = scene.draw(camera, *kinds, behind=behind, shape=shape, culling=culling)
    surfaces = fill_gbuffer(scene, camera, visibility)
    is_mask = scene.kind == KINDS.index("mask")
    for _ in range(MASK_LAYERS if is_mask.any() else 0):
        holes = surfaces.covered & is_mask[visibility.face] & (surfaces.alpha < 0.5)
        if not holes.any():
            break
        nearer = np.where(holes, visibility.depth, np.inf)
        below = scene.draw(camera, *kinds, behind=nearer, shape=shape, culling=culling)
        for name in ("face", "barycentrics", "depth"):
            getattr(visibility, name)[holes] = getattr(below, name)[holes]
        surfaces = fill_gbuffer(scene, camera, visibility)
    return visibility, surfaces


@typed_call
def reflect(
    scene: FrameScene, surfaces: GBuffer, wi: Array, irradiance: Array, onto: Array
) -> None:
    """Add what the surfaces send to the viewer of light from one direction each, in place.

    Args:
        scene: of the surfaces.
        surfaces: of a G-buffer.
        wi: (H, W, 3) unit vectors towards the light, in the world.
        irradiance: (H, W, 3) of a surface that faces the light, W/m^2, shadows included.
        onto: (H, W, 3) radiance, of the scene's dtype; f cos irradiance is added.

    Raises:
        DtypeError, ShapeError: arrays of other types or sizes.
    """
    call = Arguments("reflect", scene.dtype)
    size = (surfaces.camera.height, surfaces.camera.width, 3)
    wi = call.array("wi", wi, size)
    irradiance = call.array("irradiance", irradiance, size)
    call.run(
        _core.light_gbuffer,
        **surfaces.core_arguments(scene),
        wi=wi.reshape(-1, 3),
        irradiance=irradiance.reshape(-1, 3),
        out=onto.reshape(-1, 3),
    )


@typed_call
def reflect_parallel(
    scene: FrameScene, surfaces: GBuffer, wi: Array, irradiance: Array, visible: Array, onto: Array
) -> None:
    """Add what the surfaces send to the viewer of parallel light, in place.

    Args:
        scene: of the surfaces.
        surfaces: of a G-buffer.
        wi: (D, 3) unit vectors towards the lights, in the world.
        irradiance: (D, 3) of a surface that faces each, W/m^2.
        visible: (H, W) the part of all of them that arrives.
        onto: (H, W, 3) radiance, of the scene's dtype; visible times the sum is added.

    Raises:
        DtypeError, ShapeError: arrays of other types or sizes.
    """
    call = Arguments("reflect_parallel", scene.dtype)
    size = (surfaces.camera.height, surfaces.camera.width)
    call.run(
        _core.light_gbuffer_parallel,
        **surfaces.core_arguments(scene),
        wi=call.array("wi", wi, ("D", 3)),
        irradiance=call.array("irradiance", irradiance, ("D", 3)),
        visible=call.array("visible", visible, size).reshape(-1),
        out=onto.reshape(-1, 3),
    )


def _widest(scene: FrameScene) -> int:
    """Numbers of the longest row of parameters."""
    materials = scene.scene.materials.values()
    return max(sum(p.size for p in material.parameters) for material in materials)
