"""A mesh with colors at its vertices as a picture, and the adjoint through both.

The derivative with respect to the vertices has two parts: inside of faces the barycentrics move,
and at silhouettes the weights of the antialiasing do [Laine2020]. Which face a pixel sees is held.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from photograd_course.portable_math import matmul

from photograd.capture.camera import Camera
from photograd.capture.frames import invert_rigid
from photograd.raster import (
    Crossings,
    MeshEdges,
    Visibility,
    antialias,
    antialias_backward,
    find_crossings,
    interpolate,
    interpolate_backward,
    project,
    project_backward,
    rasterize,
    rasterize_backward,
)
from photograd.representation import ImageBatch, Outputs
from photograd.types import Array, FloatArray


@dataclass(frozen=True, eq=False)
class SurfaceGradients:
    """dL/d of what a picture was made from, float64."""

    vertices: FloatArray  # (V, 3)
    colors: FloatArray  # (V, 3)
    camera_from_world: FloatArray  # (3, 4)


@dataclass(frozen=True, eq=False)
class PositionGradients:
    """dL/d of positions in homogeneous pixels by their two parts, and of the colors; float64."""

    silhouettes: FloatArray  # (V, 3)
    interior: FloatArray  # (V, 3)
    colors: FloatArray  # (V, 3)


@dataclass(frozen=True, eq=False)
class SurfacePicture:
    """A picture, and what its backward pass needs.

    Attributes:
        image: (H, W, 5) color, opacity and depth in meters, the first and the last premultiplied.
        vertices: (V, 3) in the world, meters.
        colors: (V, 3).
        faces: (F, 3).
        edges: of the faces.
        camera: at the origin; `local` are the vertices in its frame.
        pose: (3, 4) camera_from_world.
        local: (V, 3) meters.
        positions: (V, 3) homogeneous pixels.
        visibility: which face each pixel sees.
        crossings: where silhouettes are blended.
        shaded: (H, W, 5) `image` before antialiasing.
    """

    image: FloatArray
    vertices: FloatArray
    colors: FloatArray
    faces: Array
    edges: MeshEdges
    camera: Camera
    pose: FloatArray
    local: FloatArray
    positions: FloatArray
    visibility: Visibility
    crossings: Crossings
    shaded: FloatArray

    @classmethod
    def of(
        cls,
        vertices: FloatArray,
        colors: FloatArray,
        faces: Array,
        edges: MeshEdges,
        batch: ImageBatch,
    ) -> Self:
        """Draw a mesh.

        Args:
            vertices: (V, 3) in the world, meters.
            colors: (V, 3).
            faces: (F, 3) vertex numbers.
            edges: of the faces.
            batch: the camera.
        """
        pose = batch.camera_from_world
        if pose is None:
            pose = invert_rigid(batch.camera.world_from_camera)[:3]
        pose = np.asarray(pose, np.float64)
        camera = replace(batch.camera, world_from_camera=np.eye(4))
        local = matmul(vertices, pose[:, :3].T) + pose[:, 3]
        positions = project(local, camera)
        visibility = rasterize(positions, faces, (camera.height, camera.width))
        crossings = find_crossings(positions, faces, visibility, edges)
        covered = visibility.covered[..., None]
        depth = np.where(covered, visibility.depth[..., None], 0.0)
        color = interpolate(colors, faces, visibility)
        shaded = np.concatenate([color, covered, depth], axis=-1)
        image = antialias(shaded, crossings)
        drawn = camera, pose, local, positions, visibility, crossings, shaded
        return cls(image, vertices, colors, faces, edges, *drawn)

    def cotangent(self, d_outputs: Outputs) -> FloatArray:
        """dL/d `image`, as `picture_cotangent` has it.

        Args:
            d_outputs: dL/d outputs of the pixels.
        """
        height, width = self.image.shape[:2]
        return picture_cotangent(d_outputs, height, width)

    @property
    def shown(self) -> Array:
        """Numbers of the faces that pixels show."""
        return np.unique(self.visibility.face[self.visibility.covered])

    def position_gradients(self, d_image: FloatArray) -> PositionGradients:
        """The parts of the adjoint.

        Args:
            d_image: (H, W, 5) dL/d of `image`.
        """
        positions, visibility = self.positions, self.visibility
        d_shaded, silhouettes = antialias_backward(
            self.shaded, self.crossings, d_image, positions, self.edges
        )
        d_color = np.ascontiguousarray(d_shaded[..., :3])
        d_colors, d_barycentrics = interpolate_backward(
            self.colors, self.faces, visibility, d_color
        )
        d_depth = np.where(visibility.covered, d_shaded[..., 4], 0.0)
        interior = rasterize_backward(positions, self.faces, visibility, d_barycentrics, d_depth)
        return PositionGradients(silhouettes, interior, d_colors)

    def backward(self, d_image: FloatArray) -> SurfaceGradients:
        """The adjoint.

        Args:
            d_image: (H, W, 5) dL/d of `image`.
        """
        parts = self.position_gradients(d_image)
        d_positions = parts.silhouettes + parts.interior
        d_local = project_backward(self.local, self.camera, d_positions).vertices
        d_turn = np.einsum("vi,vj->ij", d_local, self.vertices)
        d_pose = np.concatenate([d_turn, d_local.sum(axis=0)[:, None]], axis=1)
        return SurfaceGradients(matmul(d_local, self.pose[:, :3]), parts.colors, d_pose)


def picture_cotangent(d_outputs: Outputs, height: int, width: int) -> FloatArray:
    """(H, W, 5) dL/d color, opacity and depth.

    Args:
        d_outputs: dL/d color (P, 3), opacity (P,) and depth (P,) of the pixels; None for zero.
        height, width: of the picture, in pixels.
    """
    given = ((d_outputs.color, 3), (d_outputs.opacity, 1), (d_outputs.depth, 1))
    parts = [
        np.zeros((height, width, channels))
        if d is None
        else np.asarray(d, np.float64).reshape(height, width, channels)
        for d, channels in given
    ]
    return np.concatenate(parts, axis=-1)
