"""Edge sampling: the derivative of a picture through moving silhouettes, unbiased [Li2018].

A pixel is the integral of the radiance f over its square. When an edge moves along its normal N by
m, the integral gains (f_minus - f_plus) m per length of the edge, f_plus being what is seen on the
side to which N points. With random points p on the silhouettes and their lengths dl,

    dL/dm = sum over points of <g(pixel of p), f_minus - f_plus> dl

where g is dL/dpicture. With the line E = a x b of the edge (`Segments`) and p = (x, y, 1),

    m = -<dE, p> / |(E_x, E_y)|

An edge that is hidden has the same color on both sides and adds nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from photograd_course.random import uniform

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.raster.edges import MeshEdges
from photograd.raster.silhouettes import Segments, line_backward
from photograd.types import Array, FloatArray

SIDE = 1e-3
"""Pixels between a point of an edge and where the color on one of its sides is looked up."""


@typed_call
@dataclass(frozen=True, eq=False)
class EdgeSamples:
    """Points on the silhouettes of a mesh within a picture.

    Attributes:
        points: (N, 2) positions in pixels.
        normals: (N, 2) unit normals of the edge in the image.
        lengths: (N,) pixels of edge that a point stands for.
        edges: (N,) number of the edge.
    """

    points: FloatArray
    normals: FloatArray
    lengths: FloatArray
    edges: npt.NDArray[np.int64]

    def sides(self) -> tuple[FloatArray, FloatArray]:
        """Points (N, 2) on the side to which the normal points, and on the other one."""
        return self.points + SIDE * self.normals, self.points - SIDE * self.normals


@typed_call
def sample_edges(
    positions: FloatArray,
    edges: MeshEdges,
    size: tuple[int, int],
    *,
    per_pixel: float = 4.0,
    near: float = 1e-3,
    seed: int = 0,
) -> EdgeSamples:
    """Random points on the silhouettes, evenly along each: one in each of as many equal parts.

    Args:
        positions: (V, 3) vertices in homogeneous pixels, of `project`.
        edges: of the mesh.
        size: (height, width) of the picture; edges are cut at its border and at the near plane.
        per_pixel: points a pixel of length, at least one an edge.
        near: of the near plane, meters.
        seed: of the points.

    Raises:
        DtypeError, ShapeError, RangeError: arrays or numbers that are out of range.
    """
    call = Arguments("sample_edges", np.float64)
    positions = call.array("positions", positions, ("V", 3))
    call.number("per_pixel", per_pixel, above=0, high=1e6)
    call.number("near", near, above=0)
    found = Segments.of(positions, edges, size, near)
    length = np.sqrt(np.square(found.end - found.start).sum(axis=1))
    count = np.maximum(np.ceil(per_pixel * length), 1).astype(np.int64)
    row = np.repeat(np.arange(len(length)), count)
    rank = np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count)
    u = uniform(seed, step=0, pixel=found.edges[row], sample=rank, dimension=0)
    share = (rank + u) / count[row]
    points = found.start[row] + share[:, None] * (found.end - found.start)[row]
    normals = found.line[:, :2] / _slope(found.line)[:, None]
    return EdgeSamples(points, normals[row], (length / count)[row], found.edges[row])


@typed_call
def edge_gradient(
    positions: FloatArray,
    edges: MeshEdges,
    samples: EdgeSamples,
    shade: Callable[[FloatArray], Array],
    d_picture: FloatArray,
) -> FloatArray:
    """dL/dpositions (V, 3) through all silhouettes, and through nothing else.

    Its expectation over seeds is the derivative of a picture whose pixels are integrals over their
    squares, to the rounding of `SIDE`.

    Args:
        positions, edges: as for `sample_edges`.
        samples: what it returned.
        shade: points (N, 2) of the image, in pixels, to the colors (N, C) that are seen there; some
            lie up to `SIDE` outside of the picture.
        d_picture: (H, W, C) dL/d of the picture.

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other types or shapes.
    """
    call = Arguments("edge_gradient", np.float64)
    positions = call.array("positions", positions, ("V", 3))
    d_picture = call.array("d_picture", d_picture, ("H", "W", "C"))
    height, width, channels = d_picture.shape
    count = len(samples.points)
    colors = call.array("shade", shade(np.concatenate(samples.sides())), (2 * count, channels))
    gain = colors[count:] - colors[:count]
    column = np.clip(samples.points[:, 0].astype(np.int64), 0, width - 1)
    row = np.clip(samples.points[:, 1].astype(np.int64), 0, height - 1)
    d_motion = np.einsum("nc,nc->n", d_picture[row, column], gain) * samples.lengths
    return edge_motion_backward(positions, edges, samples, d_motion)


@typed_call
def edge_motion_backward(
    positions: FloatArray, edges: MeshEdges, samples: EdgeSamples, d_motion: FloatArray
) -> FloatArray:
    """The adjoint of how far each point's edge moves along its normal when the vertices move.

    Args:
        positions, edges, samples: as for `edge_gradient`.
        d_motion: (N,) dL/d of the motions, in pixels.

    Returns:
        dL/dpositions (V, 3).

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other types or shapes.
    """
    call = Arguments("edge_motion_backward", np.float64)
    positions = call.array("positions", positions, ("V", 3))
    d_motion = call.array("d_motion", d_motion, (len(samples.points),))
    a, b = (positions[edges.ends[samples.edges, k]] for k in range(2))
    scale = -d_motion / _slope(np.cross(a, b))
    d_line = scale[:, None] * np.insert(samples.points, 2, 1.0, axis=1)
    return line_backward(positions, edges, samples.edges, d_line)


def _slope(line: FloatArray) -> FloatArray:
    """(N,) how fast the value of a line grows with the distance from it, a pixel."""
    found: FloatArray = np.sqrt(np.square(line[:, :2]).sum(axis=1))
    return found
