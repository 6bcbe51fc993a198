"""Coarser meshes for small pictures, and which of them is good enough for a camera [Clark1976].

A mesh is made coarser by clustering [Rossignac1993]: all vertices in a cell of a lattice become
one, their mean, and triangles that lose a corner are dropped. A point of a triangle then moves by
no more than the corner that moves most, so the coarse surface is known to lie near the fine one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from photograd_course.checks import require_number

from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.errors import RangeError, message
from photograd.geometry.mesh import Mesh, drop_degenerate
from photograd.types import Array


@typed_call
@dataclass(frozen=True, eq=False)
class Level:
    """A mesh and a bound on its distance from the finest one.

    Attributes:
        mesh: without texture coordinates.
        error: m; every point of either surface has a point of the other within it (a bound on the
            Hausdorff distance).
    """

    mesh: Mesh
    error: float


@typed_call
def clustered(mesh: Mesh, cell: float) -> Level:
    """The mesh with one vertex a lattice cell of `cell` meters.

    The error is the way of the vertex that moves most, and, where triangles vanish and leave a
    segment that belongs to no other triangle, what `_removed_error` says of it.

    Raises:
        RangeError: a cell that is not positive, or so large that no triangle is left.
    """
    require_number("clustered", "cell", cell, least=0.0, open_ends=True)
    vertices = mesh.vertices.astype(np.float64)
    cells = np.floor((vertices - vertices.min(axis=0)) / cell).astype(np.int64)
    _, cluster, size = np.unique(cells, axis=0, return_inverse=True, return_counts=True)
    cluster = cluster.reshape(-1)
    means = np.zeros((len(size), 3))
    np.add.at(means, cluster, vertices)
    means = (means / size[:, None]).astype(np.float32).astype(np.float64)
    moved = float(np.linalg.norm(vertices - means[cluster], axis=1).max())
    faces = cluster[mesh.faces]
    whole = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    kept = drop_degenerate(means, _without_doubles(faces[whole]))
    if not len(kept):
        got = f"{cell}, which leaves no triangle"
        raise RangeError(message("clustered", "cell", "a smaller lattice", got))
    used, kept_again = np.unique(kept, return_inverse=True)
    coarse = Mesh(means[used], kept_again.reshape(-1, 3))
    return Level(coarse, moved + _removed_error(faces, kept, means))


def _without_doubles(faces: Array) -> Array:
    """Each triangle once; those that run the other way are others."""
    first = faces.argmin(axis=1)[:, None]
    turned = np.take_along_axis(faces, (first + np.arange(3)) % 3, axis=1)
    rows: Array = np.unique(turned, axis=0)
    return rows


def _removed_error(faces: Array, kept: Array, means: Array) -> float:
    """How far from the kept triangles the rest of the clustered surface can be.

    A dropped triangle became a segment or a point. An edge of a kept triangle is no loss. On any
    other segment, no point is farther from a kept vertex than half its length and the way from an
    end to the nearest kept vertex.
    """
    there = np.zeros(len(means), np.bool_)
    there[kept] = True
    alone = np.flatnonzero(~there)
    gap = np.zeros(len(means))
    for vertex in alone:
        gap[vertex] = np.linalg.norm(means[there] - means[vertex], axis=1).min()
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    known = np.concatenate([kept[:, [0, 1]], kept[:, [1, 2]], kept[:, [2, 0]]])
    edges, known = np.sort(edges, axis=1), np.sort(known, axis=1)
    code = edges[:, 0] * len(means) + edges[:, 1]
    removed = edges[~np.isin(code, known[:, 0] * len(means) + known[:, 1])]
    removed = removed[(removed[:, 0] != removed[:, 1]) | (gap[removed[:, 0]] > 0)]
    if not len(removed):
        return 0.0
    length = np.linalg.norm(means[removed[:, 0]] - means[removed[:, 1]], axis=1)
    return float((0.5 * length + gap[removed].max(axis=1)).max())


@typed_call
class LevelsOfDetail:
    """A mesh and coarser ones.

    Attributes:
        levels: the mesh itself with error 0, then by growing error.
    """

    def __init__(self, mesh: Mesh, cells: Sequence[float]) -> None:
        """Cluster the mesh with each of the lattices.

        Args:
            mesh: the finest.
            cells: side of a lattice cell, m, growing.

        Raises:
            RangeError: cells that do not grow, are not positive, or leave no triangle.
        """
        if any(b <= a for a, b in pairwise(cells)):
            raise RangeError(message("LevelsOfDetail", "cells", "growing lengths", list(cells)))
        coarser = [clustered(mesh, cell) for cell in cells]
        self.levels = [Level(mesh, 0.0), *sorted(coarser, key=lambda level: level.error)]
        low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
        self._corners = np.array(
            [
                [x, y, z]
                for x in (low[0], high[0])
                for y in (low[1], high[1])
                for z in (low[2], high[2])
            ],
            np.float64,
        )

    def screen_error(self, level: int, camera: Camera, pixels: float) -> float:
        """Bound, in pixels, on how far what the camera sees of a level is from where it belongs.

        A pixel is f p / z, and its derivative with respect to the point has the norm
        f / z sqrt(1 + tan^2), tan that of the angle to the viewing direction. Between a point in
        the picture and one that is `pixels` away, that is at most its value at the picture's
        corner, moved out by `pixels`, and at the nearest depth of the box, less the error.
        The bound holds if it is at most `pixels`; it is infinite where the
        box is not wholly in front of the camera.
        """
        error = self.levels[level].error
        toward = (self._corners - camera.position) @ camera.forward
        depth = float(toward.min()) - error
        if depth <= 0.0:
            return np.inf if error > 0.0 else 0.0
        focal = max(camera.fx, camera.fy)
        across = max(camera.cx, camera.width - camera.cx) / camera.fx
        down = max(camera.cy, camera.height - camera.cy) / camera.fy
        tan = float(np.hypot(across, down)) + pixels / min(camera.fx, camera.fy)
        return focal * error / depth * float(np.sqrt(1.0 + tan**2))

    def choose(self, camera: Camera, pixels: float = 1.0) -> int:
        """The coarsest level that shows everything within `pixels` of where it belongs.

        Raises:
            RangeError: pixels that are not positive.
        """
        require_number("choose", "pixels", pixels, least=0.0, open_ends=True)
        fit = [i for i in range(len(self.levels)) if self.screen_error(i, camera, pixels) <= pixels]
        return max(fit)
