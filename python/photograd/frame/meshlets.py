"""Small clusters of neighboring triangles, left out together where none of them can be seen.

A cluster is outside of the view if its box lies beyond a plane of the frustum. It faces away if all
of its triangles do: with the sphere of center c and radius r around it, the direction d from the
eye to c, and normals within the angle a of their mean axis m,

    |d| cos(angle(d, m) + a) >= r

says so for each of its points. Leaving out what faces away changes what open surfaces show: their
backs are seen by paths.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.geometry.culling import Frustum
from photograd.types import Array, FloatArray

Culling = Literal["none", "frustum", "facing"]
TRIANGLES = 64
"""Of a cluster, at most."""


@typed_call
@dataclass(frozen=True, eq=False)
class Meshlets:
    """Clusters of the faces of a scene.

    Attributes:
        number: (F,) of the cluster of each face.
        boxes: (M, 2, 3) around each, meters.
        center: (M, 3), and
        radius: (M,) of the sphere around each box, meters.
        axis: (M, 3) unit, the mean of the normals.
        spread: (M,) cosine of the largest angle between a normal and the axis.
    """

    number: Array
    boxes: FloatArray
    center: FloatArray
    radius: FloatArray
    axis: FloatArray
    spread: FloatArray

    def visible(self, camera: Camera, near: float, culling: Culling) -> Array:
        """(M,) bool: which clusters a camera may see; never too few.

        Args:
            camera: that looks at them.
            near: meters; nothing nearer is seen.
            culling: what is tested: "facing" tests the frustum as well.
        """
        if culling == "none":
            return np.ones(len(self.boxes), np.bool_)
        far = 2.0 * float(self._reach(camera.position).max()) + 2.0 * near
        kept = ~Frustum.of_camera(camera, near, far).misses(self.boxes)
        if culling == "facing":
            kept &= ~self.faces_away(camera.position)
        return np.asarray(kept)

    def faces_away(self, eye: FloatArray) -> Array:
        """(M,) bool: clusters of which a point sees the backs alone.

        Args:
            eye: (3,), meters.
        """
        d = self.center - eye
        distance = np.sqrt((d * d).sum(axis=1))
        along = (d * self.axis).sum(axis=1)
        across = np.sqrt(np.maximum(distance * distance - along * along, 0.0))
        sine = np.sqrt(np.maximum(1.0 - self.spread * self.spread, 0.0))
        # Normals that spread over more than a right angle face to all sides.
        faces = (self.spread > 0) & (along * self.spread - across * sine >= self.radius)
        return np.asarray(faces)

    def _reach(self, eye: FloatArray) -> FloatArray:
        d = self.center - eye
        return np.asarray(np.sqrt((d * d).sum(axis=1)) + self.radius)


@typed_call
def meshlets(vertices: FloatArray, faces: Array, shape: Array) -> Meshlets:
    """Cut a scene into clusters, each of one shape, along a curve that visits neighbors in turn.

    Args:
        vertices: (V, 3), meters.
        faces: (F, 3) vertex numbers.
        shape: (F,) numbers; no cluster has faces of two.
    """
    call = Arguments("meshlets")
    vertices = call.array("vertices", vertices, ("V", 3))
    last = len(vertices) - 1
    faces = call.array("faces", faces, ("F", 3), dtype=np.int64, min_length=1, low=0, high=last)
    shape = call.array("shape", shape, ("F",), dtype=np.int64)
    corners = vertices[faces]
    middle = corners.mean(axis=1)
    order = np.lexsort((_morton(middle), shape))
    first = np.concatenate([[True], np.diff(shape[order]) != 0])
    starts = np.flatnonzero(first)
    since = np.arange(len(order)) - np.repeat(starts, np.diff(np.append(starts, len(order))))
    begins = np.flatnonzero(since % TRIANGLES == 0)
    number = np.empty(len(faces), np.int64)
    number[order] = np.cumsum(since % TRIANGLES == 0) - 1
    low = np.minimum.reduceat(corners.min(axis=1)[order], begins, axis=0)
    high = np.maximum.reduceat(corners.max(axis=1)[order], begins, axis=0)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.sqrt((normals * normals).sum(axis=1))
    normals = normals / np.where(length > 0, length, 1.0)[:, None]
    axis = np.add.reduceat(normals[order], begins, axis=0)
    size = np.sqrt((axis * axis).sum(axis=1))
    axis = axis / np.where(size > 0, size, 1.0)[:, None]
    cosine = (normals * axis[number]).sum(axis=1)
    cosine = np.where(length > 0, cosine, 1.0)  # a triangle without area is not drawn
    spread = np.minimum(np.minimum.reduceat(cosine[order], begins), 1.0)
    half = 0.5 * (high - low)
    return Meshlets(
        number,
        np.stack([low, high], axis=1),
        low + half,
        np.sqrt((half * half).sum(axis=1)),
        axis,
        np.where(size > 0, spread, -1.0),
    )


def _morton(points: FloatArray) -> Array:
    """(N,) numbers on a curve through a lattice of 1024 cells along each axis."""
    low = points.min(axis=0)
    side = max(float((points.max(axis=0) - low).max()), 1e-300)
    cell = np.minimum((points - low) / side * 1024.0, 1023.0).astype(np.int64)
    code = np.zeros(len(points), np.int64)
    for bit in range(10):
        for axis in range(3):
            code |= ((cell[:, axis] >> bit) & 1) << (3 * bit + axis)
    return code
