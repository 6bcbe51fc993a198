"""Coarser meshes where a camera cannot tell: levels of detail for a whole scene [Clark1976]."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.errors import RangeError
from photograd.geometry.detail import LevelsOfDetail
from photograd.geometry.mesh import Mesh
from photograd.geometry.normals import vertex_normals
from photograd.transport.scene import Scene
from photograd.transport.shapes import MeshShape, Shape

LEVELS = 6
"""Coarser meshes of a shape; the cells of each are twice as large as those before."""
FINEST = 256
"""Cells of the finest of them along the longest side of a shape."""
LEAST = 256
"""Triangles below which a mesh stays as it is."""


@typed_call
class SceneDetail:
    """The meshes of a scene in several levels of detail.

    Shapes with texture coordinates or instances, and small ones, have one level: what is clustered
    loses its coordinates. Normals of vertices are found anew.
    """

    def __init__(self, scene: Scene) -> None:
        """Cluster the meshes.

        Args:
            scene: of the meshes.
        """
        self.scene = scene
        self.levels: dict[str, LevelsOfDetail] = {}
        for shape in scene.shapes:
            if _has_levels(shape):
                assert isinstance(shape, MeshShape)
                self.levels[shape.name] = _levels(shape)

    def at(self, camera: Camera, pixels: float) -> Scene:
        """The scene with the coarsest meshes that show all within `pixels` of where it belongs.

        Args:
            camera: that looks at it.
            pixels: of the picture.

        Raises:
            RangeError: pixels that are not positive.
        """
        pixels = Arguments("SceneDetail.at").number("pixels", pixels, above=0.0)
        return replace(
            self.scene, shapes=tuple(self._shape(s, camera, pixels) for s in self.scene.shapes)
        )

    def _shape(self, shape: Shape, camera: Camera, pixels: float) -> Shape:
        levels = self.levels.get(shape.name)
        if levels is None:
            return shape
        assert isinstance(shape, MeshShape)
        number = levels.choose(camera, pixels)
        if number == 0:
            return shape
        mesh = levels.levels[number].mesh
        points = mesh.vertices.astype(np.float64)
        smooth = None if shape.normals is None else vertex_normals(points, mesh.faces)
        return replace(shape, vertices=mesh.vertices, faces=mesh.faces, normals=smooth)


def _has_levels(shape: Shape) -> bool:
    if not isinstance(shape, MeshShape) or shape.instances or shape.uv is not None:
        return False
    if shape.interior is not None:
        return False  # what is clustered need not be closed
    return len(shape.faces) >= LEAST and not shape.emission.any()


def _levels(shape: MeshShape) -> LevelsOfDetail:
    """As many levels as leave a triangle."""
    size = np.ptp(shape.vertices.astype(np.float64), axis=0).max()
    cells = [float(size) / FINEST * 2.0**k for k in range(LEVELS)]
    mesh = Mesh(shape.vertices, shape.faces)
    for count in range(LEVELS, 0, -1):
        try:
            return LevelsOfDetail(mesh, cells[:count])
        except RangeError:
            continue
    return LevelsOfDetail(mesh, [])
