"""How fast attributes change from pixel to pixel, for the level of a mip map; with the adjoint.

With the lines E_i of a triangle's edges (cpp/photograd/raster/triangle.h) and p = (x, y, 1), the
sums S = sum E_i and A = sum a_i E_i give the attribute a and its derivative along x (y alike):

    s = <S, p>      a = <A, p> / s      a_x = (A_x - a S_x) / s

and of a cotangent g of a_x:

    d_A_x += g / s      d_a -= g S_x / s      d_S_x -= g a / s      d_s -= g a_x / s
    d_A += d_a p / s    d_S += (d_s - d_a a / s) p
    d_a_i += <d_A, E_i>     d_E_i += a_i d_A + d_S     d_V_j += V_k x d_E_i,  d_V_k += d_E_i x V_j

Which face a pixel shows is held.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.raster.silhouettes import sums
from photograd.raster.visibility import Visibility, mesh_arrays
from photograd.types import Array, FloatArray


@dataclass(frozen=True, eq=False)
class _Planes:
    """The quantities above for the N pixels that show a face."""

    corners: npt.NDArray[np.int64]  # (N, 3)
    vertices: FloatArray  # (N, 3, 3): corner, coordinate
    lines: FloatArray  # (N, 3, 3)
    values: FloatArray  # (N, 3, C)
    point: FloatArray  # (N, 3)
    A: FloatArray  # (N, C, 3)
    S: FloatArray  # (N, 3)
    s: FloatArray  # (N, 1, 1)
    a: FloatArray  # (N, C, 1)

    @classmethod
    def of(
        cls, attributes: FloatArray, positions: FloatArray, faces: Array, visibility: Visibility
    ) -> _Planes:
        rows, columns = np.nonzero(visibility.covered)
        corners = faces[visibility.face[rows, columns]].astype(np.int64)
        vertices, values = positions[corners], attributes[corners]
        following, last = (np.roll(vertices, -k, axis=1) for k in (1, 2))
        lines = np.cross(following, last)
        point = np.stack([columns + 0.5, rows + 0.5, np.ones(len(rows))], axis=-1)
        A, S = np.einsum("nic,nik->nck", values, lines), lines.sum(axis=1)
        s = np.einsum("nk,nk->n", S, point)[:, None, None]
        a = np.einsum("nck,nk->nc", A, point)[..., None] / s
        return cls(corners, vertices, lines, values, point, A, S, s, a)

    @property
    def derivatives(self) -> FloatArray:
        """(N, C, 2) a_x and a_y."""
        found: FloatArray = (self.A[..., :2] - self.a * self.S[:, None, :2]) / self.s
        return found


@typed_call
def footprints(
    attributes: Array, positions: FloatArray, faces: Array, visibility: Visibility
) -> FloatArray:
    """Derivatives of interpolated attributes along the axes of the picture.

    Args:
        attributes: (V, C) of the vertices, such as texture coordinates.
        positions: (V, 3) in homogeneous pixels, of `project`.
        faces: (F, 3) that were rasterized.
        visibility: by `rasterize`.

    Returns:
        (H, W, 2, C): d/dx and d/dy a pixel; zero where nothing is seen. Of texture coordinates, the
        rows of it are the footprints that `photograd.textures.mip_level` takes.

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other types or shapes.
    """
    call = Arguments("footprints", np.float64)
    attributes = call.array("attributes", attributes, ("V", "C"))
    positions, faces = mesh_arrays(call, positions, faces)
    out = np.zeros((*visibility.face.shape, 2, attributes.shape[1]))
    planes = _Planes.of(attributes, positions, faces, visibility)
    out[visibility.covered] = planes.derivatives.swapaxes(1, 2)
    return out


@typed_call
def footprints_backward(
    attributes: Array,
    positions: FloatArray,
    faces: Array,
    visibility: Visibility,
    d_footprints: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """The adjoint of `footprints`.

    Args:
        attributes, positions, faces, visibility: as for `footprints`.
        d_footprints: (H, W, 2, C) dL/d of what it returned.

    Returns:
        dL/dattributes (V, C) and dL/dpositions (V, 3).

    Raises:
        DtypeError, ShapeError, RangeError: as for `footprints`.
    """
    call = Arguments("footprints_backward", np.float64)
    attributes = call.array("attributes", attributes, ("V", "C"))
    positions, faces = mesh_arrays(call, positions, faces)
    shape = (*visibility.face.shape, 2, attributes.shape[1])
    d_footprints = call.array("d_footprints", d_footprints, shape)
    k = _Planes.of(attributes, positions, faces, visibility)
    g = d_footprints[visibility.covered].swapaxes(1, 2) / k.s  # (N, C, 2)
    d_a = -np.einsum("nck,nk->nc", g, k.S[:, :2])[..., None]
    d_s = -np.einsum("nck,nck->n", g, k.derivatives) - (d_a * k.a / k.s)[..., 0].sum(axis=1)
    d_A = d_a / k.s * k.point[:, None]
    d_A[..., :2] += g
    d_S = d_s[:, None] * k.point
    d_S[:, :2] -= np.einsum("nck,nc->nk", g, k.a[..., 0])
    d_values = np.einsum("nck,nik->nic", d_A, k.lines)
    d_lines = np.einsum("nic,nck->nik", k.values, d_A) + d_S[:, None]
    # Line i runs from corner i + 1 to corner i + 2.
    following, last = (np.roll(k.vertices, -j, axis=1) for j in (1, 2))
    d_vertices = np.roll(np.cross(last, d_lines), 1, axis=1)
    d_vertices += np.roll(np.cross(d_lines, following), 2, axis=1)
    owner, count = k.corners.reshape(-1), len(positions)
    d_attributes = sums(owner, d_values.reshape(-1, attributes.shape[1]), count)
    return d_attributes, sums(owner, d_vertices.reshape(-1, 3), count)
