"""A soft rasterizer, the biased one, to compare the others with; with the adjoint [Liu2019].

Triangle j covers the center of pixel i with the probability

    D_ij = sigmoid(x_ij),    x_ij = sign_ij d_ij^2 / sigma    [Liu2019, Eq. 1]

where d_ij is the distance in pixels from the center to the boundary of the triangle, the sign is 1
inside and -1 outside, and sigma (square pixels) sets the blur. The silhouette is

    S_i = 1 - prod_j (1 - D_ij) = 1 - exp(-sum_j softplus(x_ij))

    dS_i/dx_ij = (1 - S_i) D_ij

With r from the nearest point a + t (b - a) of the boundary to the center, d(d^2)/da = -2 (1 - t) r
and d(d^2)/db = -2 t r: at the best t, or at a clamped one, dt adds nothing.

S is differentiable, and it is not the coverage of the pixels. It is 1/2 on an edge, above 1/2 on
an edge that two triangles share, and below 1 in a triangle that is not large compared with
sqrt(sigma). With a small sigma, few centers are near enough to an edge to have a derivative. A
triangle that is fitted to coverage with it ends at other vertices.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from photograd_course.portable_math import exp, expm1, sigmoid, softplus

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.errors import RangeError, message
from photograd.raster.silhouettes import sums
from photograd.raster.visibility import mesh_arrays
from photograd.types import Array, FloatArray


@typed_call
def soft_silhouette(
    positions: FloatArray, faces: Array, size: tuple[int, int], sigma: float
) -> FloatArray:
    """The silhouette of a mesh, blurred; for small meshes and pictures, every pair is looked at.

    Args:
        positions: (V, 3) vertices in homogeneous pixels, of `project`, in front of the camera.
        faces: (F, 3) vertex numbers, in either direction around.
        size: (height, width) of the picture in pixels.
        sigma: of the blur, square pixels.

    Returns:
        (H, W) float64 in [0, 1].

    Raises:
        DtypeError, ShapeError, RangeError: arrays of other types or shapes, vertices that are not
            in front of the camera, a sigma that is not positive.
    """
    call = Arguments("soft_silhouette", np.float64)
    positions, faces = mesh_arrays(call, positions, faces)
    sigma = call.number("sigma", sigma, above=0)
    points = _in_image(call, positions, faces)
    return -expm1(-_optical_depth(points, faces, _centers(size), sigma)).reshape(size)


@typed_call
def soft_silhouette_backward(
    positions: FloatArray, faces: Array, d_silhouette: FloatArray, sigma: float
) -> FloatArray:
    """dL/dpositions (V, 3) float64.

    Args:
        positions, faces, sigma: as for `soft_silhouette`.
        d_silhouette: (H, W) dL/d of what it returned.

    Raises:
        DtypeError, ShapeError, RangeError: as for `soft_silhouette`.
    """
    call = Arguments("soft_silhouette_backward", np.float64)
    positions, faces = mesh_arrays(call, positions, faces)
    d_silhouette = call.array("d_silhouette", d_silhouette, ("H", "W"))
    sigma = call.number("sigma", sigma, above=0)
    points = _in_image(call, positions, faces)
    centers = _centers(d_silhouette.shape)
    empty = d_silhouette.reshape(-1) * exp(-_optical_depth(points, faces, centers, sigma))
    d_points = np.zeros_like(points)
    for face in faces:
        squared, sign, edge, t, r = _nearest(points[face], centers)
        d_squared = empty * sigmoid(sign * squared / sigma) * sign / sigma
        d_start = -2 * (d_squared * (1 - t))[:, None] * r
        d_end = -2 * (d_squared * t)[:, None] * r
        owner = np.concatenate([edge, (edge + 1) % 3])
        d_points[face] += sums(owner, np.concatenate([d_start, d_end]), 3)
    z = positions[:, 2:]
    with np.errstate(divide="ignore", invalid="ignore"):  # of vertices without a face
        d_xy = np.where(d_points == 0, 0.0, d_points / z)
    d_z = -np.einsum("vc,vc->v", d_xy, points)
    return np.concatenate([d_xy, d_z[:, None]], axis=1)


def _in_image(call: Arguments, positions: FloatArray, faces: Array) -> FloatArray:
    """(V, 2) in pixels; 0 where no face has the vertex."""
    if faces.size and faces.max() >= len(positions):
        expected = f"numbers of vertices below {len(positions)}"
        raise RangeError(message(call.function, "faces", expected, int(faces.max())))
    used = np.zeros(len(positions), bool)
    used[faces.reshape(-1)] = True
    if not (positions[used, 2] > 0).all():
        lowest = float(positions[used, 2].min())
        raise RangeError(message(call.function, "positions", "depths above 0", lowest))
    depth = np.where(used, positions[:, 2], 1.0)[:, None]
    return np.where(used[:, None], positions[:, :2] / depth, 0.0)


def _centers(size: tuple[int, ...]) -> FloatArray:
    """(P, 2) centers of pixels, row by row."""
    rows, columns = np.indices(size).reshape(2, -1) + 0.5
    return np.stack([columns, rows], axis=-1)


def _optical_depth(
    points: FloatArray, faces: Array, centers: FloatArray, sigma: float
) -> FloatArray:
    """(P,) sum of softplus(x) over the faces, the negative logarithm of 1 - S."""
    total = np.zeros(len(centers))
    for face in faces:
        squared, sign, *_ = _nearest(points[face], centers)
        total += softplus(sign * squared / sigma)
    return total


def _nearest(
    corners: FloatArray, centers: FloatArray
) -> tuple[FloatArray, FloatArray, npt.NDArray[np.int64], FloatArray, FloatArray]:
    """d^2 (P,), the sign (P,), the nearest edge (P,) from that corner on, t (P,) and r (P, 2)."""
    along = np.roll(corners, -1, axis=0) - corners
    to = centers[:, None] - corners
    length = np.square(along).sum(axis=1)
    t = np.einsum("pkc,kc->pk", to, along) / np.where(length > 0, length, 1.0)
    t = np.clip(t, 0.0, 1.0)
    r = to - t[..., None] * along
    squared = np.square(r).sum(axis=2)
    edge = squared.argmin(axis=1)
    every = np.arange(len(centers))
    side = along[:, 0] * to[..., 1] - along[:, 1] * to[..., 0]
    inside = (side > 0).all(axis=1) | (side < 0).all(axis=1)
    sign = np.where(inside, 1.0, -1.0)
    return squared[every, edge], sign, edge, t[every, edge], r[every, edge]
