"""Ambient occlusion by disks that stand for the surfaces of a scene [Bunnell2005].

Formulas: cpp/photograd/frame/disk_occlusion.h. Not of one view: what the frame does not show hides
as well.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.errors import RangeError, message
from photograd.frame.scene import KINDS, FrameScene
from photograd.types import Array, FloatArray

MOST_DISKS = 1_000_000
OPENING = 3.0
"""Disks count as one from this many of their radius on."""


@typed_call
@dataclass(frozen=True, eq=False)
class Disks:
    """Disks in the place of surfaces.

    Attributes:
        centers: (E, 3) float64, in the world, meters.
        normals: (E, 3) float64, unit; the side that hides.
        areas: (E,) float64, square meters.
        visible: (E,) float64, how open the sky is in front of each, 0 to 1.
    """

    centers: FloatArray
    normals: FloatArray
    areas: FloatArray
    visible: FloatArray

    def occlusion(self, points: Array, normals: Array, *, radius: float = 1e6) -> Array:
        """How much of the sky points see, weighted by the cosine.

        Args:
            points: (N, 3) in the world, meters.
            normals: (N, 3) unit; where one is 0, the result is 1.
            radius: meters; disks that are further away hide nothing.

        Returns:
            (N,) from 0 to 1, of the dtype of `points`.

        Raises:
            DtypeError, ShapeError, RangeError: other arrays, or a radius that is not positive.
        """
        call = Arguments("Disks.occlusion")
        points = call.array("points", points, ("N", 3))
        normals = call.array("normals", normals, ("N", 3), dtype=points.dtype)
        radius = call.number("radius", radius, above=0.0)
        out = np.empty(len(points), points.dtype)
        disks = (self.centers, self.normals, self.areas, self.visible)
        call.run(_core.disk_occlusion, *disks, OPENING, radius, points, normals, out)
        return out


@typed_call
def scene_disks(scene: FrameScene, *, edge: float, radius: float = 1e6, passes: int = 0) -> Disks:
    """Disks for the opaque surfaces of a scene.

    Args:
        scene: of the surfaces. Faces hide on the side from which they turn counter-clockwise.
        edge: meters; faces with longer edges become several disks.
        radius: meters; disks that are further away hide nothing.
        passes: over all disks, to find how open the sky is before each: disks behind others hide
            less, which they do in stacks of plates. In corners, surfaces that hide nothing else
            hide less as well: there, none is best.

    Raises:
        DtypeError: no numbers.
        RangeError: numbers out of range, or more than a million disks.
    """
    call = Arguments("scene_disks")
    edge = call.number("edge", edge, above=0.0)
    passes = call.integer("passes", passes, low=0, high=16)
    opaque = np.isin(scene.kind, [KINDS.index("opaque"), KINDS.index("mask")])
    corners = scene.vertices[scene.faces[opaque]]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    double = np.sqrt((cross * cross).sum(axis=1))
    corners, cross, double = corners[double > 0], cross[double > 0], double[double > 0]
    sides = corners - np.roll(corners, 1, axis=1)
    longest = np.sqrt((sides * sides).sum(axis=2).max(axis=1))
    count = np.maximum(np.ceil(longest / edge), 1.0)
    if (count * count).sum() > MOST_DISKS:
        got, remedy = f"{(count * count).sum():.3g} of them", "raise edge"
        expected = f"at most {MOST_DISKS} disks"
        raise RangeError(message("scene_disks", "edge", expected, got, remedy))
    centers, owner = _centers(corners, count.astype(np.int64))
    normals = (cross / double[:, None])[owner]
    areas = (0.5 * double / (count * count))[owner]
    disks = Disks(centers, normals, areas, np.ones(len(areas)))
    for _ in range(passes):
        visible = disks.occlusion(centers, normals, radius=radius)
        disks = Disks(centers, normals, areas, visible)
    return disks


def _centers(corners: FloatArray, count: Array) -> tuple[FloatArray, Array]:
    """Centers of the n^2 equal parts of each triangle, and to which they belong."""
    centers, owners = [], []
    for n in np.unique(count):
        of_n = np.flatnonzero(count == n)
        i, j = (grid.reshape(-1) for grid in np.meshgrid(np.arange(n), np.arange(n)))
        inside = i + j < n
        upright = np.stack([i[inside] + 1 / 3, j[inside] + 1 / 3], axis=1)
        inside = i + j < n - 1
        turned = np.stack([i[inside] + 2 / 3, j[inside] + 2 / 3], axis=1)
        u, v = (np.concatenate([upright, turned]) / n).T[:, None, :, None]
        a, b, c = (corners[of_n, k][:, None, :] for k in range(3))
        centers.append((a + u * (b - a) + v * (c - a)).reshape(-1, 3))
        owners.append(np.repeat(of_n, n * n))
    return np.concatenate(centers), np.concatenate(owners)
