"""Antialiasing of silhouettes, which makes a rasterized picture differentiable; with the adjoint.

Where a silhouette crosses the segment between the centers of two neighboring pixels, at s in [0, 1]
from the center on its own side (in) to the other (out) [Laine2020, Sect. 3.6]

    s > 1/2:  out takes the weight w = s - 1/2 of the color of in
    s < 1/2:  in takes w = 1/2 - s of the color of out

Steep edges are asked in rows, the others in columns: row y is crossed at x = -(B y + C) / A of the
line E = (A, B, C), and dx/dE = -(x, y, 1) / A. A pixel that takes from several neighbors takes no
more than all: with W = max(1, sum w_n),

    C' = C + sum (w_n / W) (C_n - C)

lies between the least and the greatest of the colors. With g = d_C':

    d_C_n += (w_n / W) g        d_C += (1 - sum w_n / W) g
    d_w_n = <g, C_n - C>  while the sum is at most 1,   <g, C_n - C'> / W  beyond

Held: what each pixel sees, which edges are silhouettes, and which of them are hidden. The last is
looked up at each crossing, so that a mesh with faces smaller than pixels loses none of its
silhouette. Where two faces intersect there is no edge, and no derivative. Blend colors, after
shading and last of all: attributes that are blended before shading, or a mask after it, are wrong
at silhouettes.

Of transparent faces each layer of a depth peeling is blended by itself. With S_k the layer k over
what the layers behind it leave, C_k = antialias(S_k, crossings k); the silhouettes of layer k are
those that k faces hide.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.raster.edges import MeshEdges
from photograd.raster.lookup import FaceLookup
from photograd.raster.silhouettes import Segments, line_backward, sums
from photograd.raster.visibility import Visibility
from photograd.types import Array, FloatArray

OUTSIDE = 1e-3
"""Pixels beside a silhouette, where something nearer than it hides it."""


@typed_call
@dataclass(frozen=True, eq=False)
class Crossings:
    """Where visible silhouettes cross the segments between the centers of neighboring pixels.

    Attributes:
        taker, giver: (N,) numbers of pixels, row by row; the first takes of the second's color.
        weight: (N,) in (0, 1/2].
        d_line: (N, 3) dw/dE.
        edge: (N,) number of the edge.
    """

    taker: npt.NDArray[np.int64]
    giver: npt.NDArray[np.int64]
    weight: FloatArray
    d_line: FloatArray
    edge: npt.NDArray[np.int64]


@typed_call
def find_crossings(
    positions: FloatArray,
    faces: Array,
    visibility: Visibility,
    edges: MeshEdges,
    *,
    near: float = 1e-3,
) -> Crossings:
    """What `antialias` blends.

    Args:
        positions: (V, 3) in homogeneous pixels, of `project`.
        faces: (F, 3) that were rasterized.
        visibility: by `rasterize`.
        edges: of the faces.
        near: meters, that of the `RasterOptions`.

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other types or shapes, or that do not belong
            together.
    """
    return layered_crossings(positions, faces, [visibility], edges, near=near)[0]


@typed_call
def layered_crossings(
    positions: FloatArray,
    faces: Array,
    layers: Sequence[Visibility],
    edges: MeshEdges,
    *,
    near: float = 1e-3,
) -> list[Crossings]:
    """What `antialias` blends in each layer.

    Args:
        positions, faces, edges, near: as for `find_crossings`.
        layers: at least one, from the nearest on: each by `rasterize` with the depth of the one
            before it as `behind`.

    Raises:
        DtypeError, ShapeError, RangeError: as for `find_crossings`.
    """
    call = Arguments("find_crossings", np.float64)
    positions = call.array("positions", positions, ("V", 3))
    call.number("near", near, above=0)
    height, width = layers[0].face.shape
    segments = Segments.of(positions, edges, (height, width), near)
    lookup = FaceLookup(positions, faces, (height, width), near=near)
    parts = [_along(segments, axis, (height, width), positions, edges, lookup) for axis in (0, 1)]
    found = _Candidates.joined(parts)
    return [found.of_layer(k, layer) for k, layer in enumerate(layers)]


@typed_call
def antialias(color: FloatArray, crossings: Crossings) -> FloatArray:
    """Blend neighboring pixels by how far a silhouette between them reaches across.

    Args:
        color: (H, W, C) shaded, background filled in.
        crossings: of the picture.

    Returns:
        (H, W, C) float64; each number lies between the least and the greatest of the pixel and its
        four neighbors.

    Raises:
        DtypeError, ShapeError: a color that is not (H, W, C).
    """
    call = Arguments("antialias", np.float64)
    color = call.array("color", color, ("H", "W", "C"), finite=False)
    rows = color.reshape(-1, color.shape[2])
    share = crossings.weight / _limit(crossings, len(rows))[crossings.taker]
    gain = share[:, None] * (rows[crossings.giver] - rows[crossings.taker])
    return color + sums(crossings.taker, gain, len(rows)).reshape(color.shape)


@typed_call
def antialias_backward(
    color: FloatArray,
    crossings: Crossings,
    d_out: FloatArray,
    positions: FloatArray,
    edges: MeshEdges,
) -> tuple[FloatArray, FloatArray]:
    """The adjoint of `antialias`, through the color and through the silhouettes.

    Args:
        color, crossings: as for `antialias`.
        d_out: (H, W, C) dL/d of what it returned.
        positions, edges: as for `find_crossings`.

    Returns:
        dL/dcolor (H, W, C) and dL/dpositions (V, 3).

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other types or shapes.
    """
    call = Arguments("antialias_backward", np.float64)
    color = call.array("color", color, ("H", "W", "C"), finite=False)
    d_out = call.array("d_out", d_out, color.shape, finite=False)
    positions = call.array("positions", positions, ("V", 3))
    rows, g = (each.reshape(-1, color.shape[2]) for each in (color, d_out))
    taker, giver = crossings.taker, crossings.giver
    limit = _limit(crossings, len(rows))
    passed = (crossings.weight / limit[taker])[:, None] * g[taker]
    d_color = d_out + (sums(giver, passed, len(rows)) - sums(taker, passed, len(rows))).reshape(
        color.shape
    )
    blended = antialias(color, crossings).reshape(rows.shape)
    full = (limit > 1)[taker, None]
    base = np.where(full, blended[taker], rows[taker])
    d_weight = np.einsum("nc,nc->n", g[taker], rows[giver] - base) / limit[taker]
    d_line = d_weight[:, None] * crossings.d_line
    return d_color, line_backward(positions, edges, crossings.edge, d_line)


def _limit(crossings: Crossings, pixels: int) -> FloatArray:
    """(P,) W of each pixel."""
    taken = np.bincount(crossings.taker, weights=crossings.weight, minlength=pixels)
    return np.maximum(taken, 1.0)


@dataclass(frozen=True, eq=False)
class _Candidates:
    """Silhouettes between the centers of pixels, hidden ones too; N rows each.

    Attributes:
        inner, outer: numbers of pixels, on the side of the face and on the other.
        s: where the segment from the first to the second is crossed.
        d_line: (N, 3) ds/dE.
        edge: number of the edge.
        hidden: how many faces hide it; -1 where its depth is out of float64's range.
    """

    inner: npt.NDArray[np.int64]
    outer: npt.NDArray[np.int64]
    s: FloatArray
    d_line: FloatArray
    edge: npt.NDArray[np.int64]
    hidden: npt.NDArray[np.int64]

    @classmethod
    def joined(cls, parts: Sequence[_Candidates]) -> _Candidates:
        columns = zip(*(vars(part).values() for part in parts), strict=True)
        return cls(*(np.concatenate(each) for each in columns))

    def of_layer(self, number: int, visibility: Visibility) -> Crossings:
        """Those that so many faces hide, where the layer shows other faces on both sides."""
        face = visibility.face.reshape(-1)
        kept = (self.hidden == number) & (face[self.inner] != face[self.outer])
        outer_takes = self.s > 0.5
        sign = np.where(outer_takes, 1.0, -1.0)
        found = (
            np.where(outer_takes, self.outer, self.inner),
            np.where(outer_takes, self.inner, self.outer),
            sign * (self.s - 0.5),
            sign[:, None] * self.d_line,
            self.edge,
        )
        return Crossings(*(each[kept] for each in found))


def _along(
    segments: Segments,
    axis: int,
    size: tuple[int, int],
    positions: FloatArray,
    edges: MeshEdges,
    lookup: FaceLookup,
) -> _Candidates:
    """Silhouettes that cross rows (axis 0) or columns (axis 1)."""
    height, width = size
    other = 1 - axis
    steep = np.abs(segments.line[:, 0]) >= np.abs(segments.line[:, 1])
    asked = (steep == (axis == 0)) & (segments.side != 0)
    ends = np.sort(np.stack([segments.start[:, other], segments.end[:, other]]), axis=0)
    first, last = np.ceil(ends - 0.5).astype(np.int64)
    row = np.repeat(np.arange(len(asked)), np.where(asked, last - first, 0))
    rank = np.arange(len(row)) - np.searchsorted(row, row)
    at = first[row] + rank + 0.5
    line, side = segments.line[row], segments.side[row]
    crossing = -(line[:, other] * at + line[:, 2]) / line[:, axis]
    # The face lies where the line's value has the sign `side`: before or behind the crossing.
    direction = -side * np.sign(line[:, axis])  # of the outside
    low = np.floor(crossing - 0.5)
    inner = np.where(direction > 0, low, low + 1)
    s = (crossing - inner - 0.5) * direction
    kept = (low >= 0) & (low + 1 < (width, height)[axis]) & (s != 0.5)
    row, at, line, crossing, direction, inner, s = (
        each[kept] for each in (row, at, line, crossing, direction, inner, s)
    )
    points = np.stack([crossing, at] if axis == 0 else [at, crossing], axis=-1)
    edge = segments.edges[row]
    depth = _depth(positions[edges.ends[edge, 0]], positions[edges.ends[edge, 1]], points)
    beside = points.copy()
    beside[:, axis] += OUTSIDE * direction
    inner_pixel, outer_pixel = (
        _pixel(number, at, axis, width) for number in (inner, inner + direction)
    )
    homogeneous = np.insert(points, 2, 1.0, axis=1)
    d_line = (-direction / line[:, axis])[:, None] * homogeneous
    known = np.isfinite(depth)
    hidden = np.where(known, lookup.count(beside, np.where(known, depth, 0.0)), -1)
    return _Candidates(inner_pixel, outer_pixel, s, d_line, edge, hidden)


def _pixel(number: FloatArray, at: FloatArray, axis: int, width: int) -> npt.NDArray[np.int64]:
    row, column = (at - 0.5, number) if axis == 0 else (number, at - 0.5)
    found: npt.NDArray[np.int64] = row.astype(np.int64) * width + column.astype(np.int64)
    return found


def _depth(a: FloatArray, b: FloatArray, points: FloatArray) -> FloatArray:
    """(N,) depth of the point of an edge that the image shows at `points` (N, 2).

    a + t (b - a) is a multiple of (x, y, 1); the coordinate in which the ends differ most gives t.
    """
    rest_a, rest_b = (v[:, :2] - v[:, 2:] * points for v in (a, b))
    axis = np.abs(rest_b - rest_a).argmax(axis=1)[:, None]
    at_a, at_b = (np.take_along_axis(rest, axis, axis=1)[:, 0] for rest in (rest_a, rest_b))
    t = at_a / (at_a - at_b)
    found: FloatArray = a[:, 2] + t * (b[:, 2] - a[:, 2])
    return found
