"""What was hit by a click in `photograd view`: its facts, and lines that mark it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from photograd.capture.camera import Camera
from photograd.geometry.mesh import Bvh, Mesh
from photograd.types import Array, FloatArray


@dataclass(frozen=True, eq=False)
class Pick:
    """What was hit.

    Attributes:
        title: what it is, with its number.
        facts: {name: text} of its parameters and its gradient.
        position: (3,) where, in the frame of the field.
        lines: (S, 2, 3) segments that mark it, in the same frame.
    """

    title: str
    facts: dict[str, str]
    position: Array
    lines: FloatArray

    def markdown(self) -> str:
        """A heading and a list."""
        rows = [f"**{self.title}**", f"- position: {numbers(self.position)} m"]
        return "\n".join([*rows, *(f"- {name}: {text}" for name, text in self.facts.items())])


def numbers(values: Any) -> str:
    """Numbers with four digits each.

    Args:
        values: a number or an array; of a long one, the first eight.
    """
    flat = np.asarray(values, np.float64).reshape(-1)
    more = ", ..." if flat.size > 8 else ""
    return ", ".join(f"{value:.4g}" for value in flat[:8]) + more


def ray_through(camera: Camera, at: tuple[float, float]) -> tuple[FloatArray, FloatArray]:
    """Origin (3,) and unit direction (3,) of the ray through a point of a picture.

    Args:
        camera: of the picture.
        at: (column, row) in pixels.
    """
    origins, directions = only_at(camera, at).rays()
    return origins[0], directions[0]


def only_at(camera: Camera, at: tuple[float, float]) -> Camera:
    """The camera of a single pixel whose center is a point of the picture.

    Args:
        camera: of the picture.
        at: (column, row) in pixels.
    """
    cx, cy = camera.cx - at[0] + 0.5, camera.cy - at[1] + 0.5
    return replace(camera, width=1, height=1, cx=cx, cy=cy)


@dataclass(frozen=True, eq=False)
class TriangleHit:
    """The nearest triangle of some meshes: mesh, face, distance, barycentrics (3,), corners."""

    mesh: int
    face: int
    t: float
    weights: FloatArray
    corners: FloatArray


def nearest_triangle(meshes: Sequence[Mesh], origin: Array, direction: Array) -> TriangleHit | None:
    """The first triangle that a ray meets.

    Args:
        meshes: in the frame of the ray.
        origin, direction: (3,).
    """
    ray = np.asarray(origin, np.float64)[None], np.asarray(direction, np.float64)[None]
    hits = Bvh(meshes).trace(*ray)
    if not hits.hit[0]:
        return None
    mesh, face = int(hits.instance[0]), int(hits.primitive[0])
    u, v = hits.barycentrics[0].tolist()
    corners = meshes[mesh].vertices[meshes[mesh].faces[face]].astype(np.float64)
    return TriangleHit(mesh, face, float(hits.t[0]), np.array([1 - u - v, u, v]), corners)


def box_edges(low: Array, high: Array) -> FloatArray:
    """(12, 2, 3) edges of a box.

    Args:
        low, high: (3,) corners.
    """
    ends = np.stack([low, high])
    lines = []
    for axis in range(3):
        a, b = (other for other in range(3) if other != axis)
        for i, j in np.ndindex(2, 2):
            line = np.stack([ends[0], ends[1]]).astype(np.float64)
            line[:, a], line[:, b] = ends[i, a], ends[j, b]
            lines.append(line)
    return np.stack(lines)


def closed(corners: FloatArray) -> FloatArray:
    """(N, 2, 3) the segments of a closed line through N corners (N, 3)."""
    return np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)
