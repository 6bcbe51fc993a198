"""A scene as a rasterizer draws it: triangles in the world, and what the path tracer knows of each.

Meshes are drawn as they are, spheres as triangles inside of them; what a pixel sees is then looked
up by the path tracer, so that normals, textures and materials of both are the same.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._checks import require_instance
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.errors import SceneError, message
from photograd.frame.meshlets import Culling, Meshlets, meshlets
from photograd.geometry.icosphere import icosphere
from photograd.raster import RasterOptions, Visibility, project, rasterize
from photograd.transport.material import Material
from photograd.transport.media_list import transmits
from photograd.transport.motion import refuse_motion
from photograd.transport.scene import Scene
from photograd.transport.shapes import MeshShape, SdfShape, Shape, SphereShape
from photograd.transport.tracer import PathTracer
from photograd.types import Array, FloatArray

KINDS = ("opaque", "mask", "blended", "glass")


@typed_call
class FrameScene:
    """A scene ready to be rasterized.

    Attributes:
        scene: what it was made of.
        tracer: of the scene; evaluates textures, normal maps and reflectance.
        vertices: (V, 3) float64, in the world, meters.
        faces: (F, 3) uint32.
        shape, primitive: (F,) int32, which shape of the core a face belongs to, and its number
            there.
        kind: (F,) uint8 of `KINDS`: faces that cover what is behind them whole, those that do so
            where a mask says, those that cover a part, and glass.
        center: (3,), of the box around all vertices.
        radius: meters, of the sphere around that box.
    """

    def __init__(
        self, scene: Scene, *, dtype: npt.DTypeLike = np.float32, sphere_divisions: int = 32
    ) -> None:
        """Lay out the triangles.

        Args:
            scene: as for `PathTracer`.
            dtype: in which surfaces are evaluated, float32 or float64.
            sphere_divisions: n of the 20 n^2 triangles of a sphere.

        Raises:
            DtypeError: no `Scene`, or another dtype.
            RangeError: sphere_divisions out of range.
            SceneError: a signed distance function, a shape that moves, or media.
        """
        require_instance("FrameScene", "scene", scene, Scene)
        refuse_motion("FrameScene", scene.shapes)
        _refuse_media(scene)
        self.scene = scene
        self.tracer = PathTracer(scene, dtype=dtype, allow_incomplete=True)
        ball = icosphere(
            Arguments("FrameScene").integer("sphere_divisions", sphere_divisions, low=1, high=200)
        )
        vertices, faces, shapes, primitives, kinds = [], [], [], [], []
        shape_count = first = spheres = 0
        for shape in self.tracer.core_shapes:
            for points, corners in _parts(shape, ball.vertices, ball.faces):
                vertices.append(points)
                faces.append(corners + np.uint32(first))
                first += len(points)
                is_sphere = isinstance(shape, SphereShape)
                shapes.append(np.full(len(corners), shape_count))
                primitives.append(np.full(len(corners), spheres) if is_sphere else _count(corners))
                kinds.append(np.full(len(corners), KINDS.index(_kind(scene, shape)), np.uint8))
                spheres += is_sphere
                shape_count += 1
        self.vertices: FloatArray = np.concatenate(vertices)
        self.faces: Array = np.concatenate(faces).astype(np.uint32)
        self.shape: Array = np.concatenate(shapes).astype(np.int32)
        self.primitive: Array = np.concatenate(primitives).astype(np.int32)
        self.kind: Array = np.concatenate(kinds)
        low, high = self.vertices.min(axis=0), self.vertices.max(axis=0)
        self.center: FloatArray = 0.5 * (low + high)
        self.radius = float(0.5 * np.linalg.norm(high - low))

    @property
    def dtype(self) -> Any:
        """In which surfaces are evaluated."""
        return self.tracer.dtype

    @property
    def near(self) -> float:
        """Meters: nothing nearer to a camera or a light is drawn."""
        return 1e-4 * self.radius

    def center_of(self, shape: int) -> FloatArray:
        """(3,), of the box around a shape of the core, meters.

        Args:
            shape: its number.
        """
        points = self.vertices[self.faces[self.shape == shape].reshape(-1)]
        return 0.5 * np.asarray(points.min(axis=0) + points.max(axis=0))

    @cached_property
    def meshlets(self) -> Meshlets:
        """Clusters of the faces, found when they are first needed."""
        return meshlets(self.vertices, self.faces, self.shape)

    def draw(
        self,
        camera: Camera,
        *kinds: str,
        behind: Array | None = None,
        shape: int | None = None,
        culling: Culling = "none",
    ) -> Visibility:
        """The visibility buffer of a camera; numbers of faces are those of `faces`.

        Args:
            camera: of the picture.
            kinds: of the faces that are drawn; masks are drawn whole.
            behind: (H, W) depths; only what lies further away is drawn. None draws all.
            shape: of the core, which alone is drawn; None draws all.
            culling: of clusters of triangles.
        """
        face_mask = self._face_mask(kinds, camera, culling)
        if shape is not None:
            face_mask &= self.shape == shape
        return rasterize(
            project(self.vertices, camera),
            self.faces,
            (camera.height, camera.width),
            RasterOptions(near=self.near),
            behind=behind,
            face_mask=face_mask,
        )

    def draw_depth(self, camera: Camera, depth: FloatArray, *kinds: str) -> None:
        """Write the depths (H, W) of `draw` alone, in less time.

        Args:
            camera: of the picture.
            depth: (H, W) float64, all of it is written.
            kinds: of the faces that are drawn; masks are drawn whole.
        """
        call = Arguments("FrameScene.draw_depth")
        size = (camera.height, camera.width)
        depth = call.array("depth", depth, size, dtype=np.float64, finite=False)
        face_mask = self._face_mask(kinds, camera, "frustum")
        call.run(
            _core.rasterize_depth,
            project(self.vertices, camera),
            self.faces,
            self.near,
            np.inf,
            depth,
            face_mask,
        )

    def _face_mask(self, kinds: tuple[str, ...], camera: Camera, culling: Culling) -> Array:
        """(F,) bool: faces of these kinds that are not culled."""
        is_drawn = np.zeros(len(KINDS), np.bool_)
        is_drawn[[KINDS.index(kind) for kind in kinds]] = True
        face_mask = is_drawn[self.kind]
        if culling != "none":
            visible = self.meshlets.visible(camera, self.near, culling)
            if not visible.all():
                face_mask &= visible[self.meshlets.number]
        return np.asarray(face_mask)


def _refuse_media(scene: Scene) -> None:
    for shape in scene.shapes:
        if isinstance(shape, SdfShape):
            expected = "meshes and spheres"
            got = f"'{shape.name}', a signed distance function"
            raise SceneError(message("FrameScene", "scene.shapes", expected, got))
    if scene.media or scene.world is not None:
        expected, remedy = "a scene without media", "path trace it, or leave out its media"
        raise SceneError(message("FrameScene", "scene.media", expected, "some", remedy))


def _parts(shape: Shape, ball: FloatArray, ball_faces: Array) -> list[tuple[FloatArray, Array]]:
    """Vertices in the world and faces, of each instance."""
    if isinstance(shape, SphereShape):
        return [(ball * shape.radius + np.asarray(shape.center, np.float64), ball_faces)]
    assert isinstance(shape, MeshShape)
    points = shape.vertices.astype(np.float64)
    if not shape.instances:
        return [(points, shape.faces)]
    return [
        (_moved(points, np.asarray(instance, np.float64)), shape.faces)
        for instance in shape.instances
    ]


def _moved(points: FloatArray, matrix: FloatArray) -> FloatArray:
    """Axis by axis: the same bits on every processor."""
    rows = [(points * matrix[k, :3]).sum(axis=1) + matrix[k, 3] for k in range(3)]
    return np.stack(rows, axis=1)


def _count(corners: Array) -> Array:
    return np.arange(len(corners))


def _kind(scene: Scene, shape: Shape) -> str:
    material = scene.materials.get(shape.material)
    if material is None:
        return "opaque"  # a light with a surface
    if transmits(material.model) and not _lets_nothing_through(material):
        return "glass"
    if not material.has_opacity:
        return "opaque"
    return "blended" if material.alpha_cutoff is None else "mask"


def _lets_nothing_through(material: Material) -> bool:
    """Whether a material of layers has none that transmits."""
    part = material.values.get("transmission")
    return part is not None and part == 0 and "transmission" not in material.textures
