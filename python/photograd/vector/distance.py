"""The exact distance to a Bezier curve and a stroke from it, which polylines are compared with.

The closest point of a curve B to p is an end of it, or a point where <B(t) - p, B'(t)> = 0: a
polynomial in t of degree 2 d - 1, whose real roots in [0, 1] are all tried. The derivative of the
distance with respect to the control points holds t, since it changes nothing to first order:

    d_P_k = B_k(t) (B(t) - p) / |B(t) - p|
"""

from __future__ import annotations

import numpy as np

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.types import Array, FloatArray
from photograd.vector.flatten import bernstein

# Coefficients of powers of t, lowest first, from control points.
POWERS = {
    1: np.array([[1.0, 0], [-1, 1]]),
    2: np.array([[1.0, 0, 0], [-2, 2, 0], [1, -2, 1]]),
    3: np.array([[1.0, 0, 0, 0], [-3, 3, 0, 0], [3, -6, 3, 0], [-1, 3, -3, 1]]),
}


@typed_call
def curve_distance(control: Array, points: Array) -> tuple[FloatArray, FloatArray]:
    """Distances to a Bezier curve, and where on it the closest points are.

    Args:
        control: (d + 1, 2) control points, of degree d = 1, 2 or 3.
        points: (N, 2).

    Returns:
        Distances (N,) and parameters t (N,) in [0, 1] of the closest points.

    Raises:
        DtypeError, ShapeError, RangeError: other shapes, numbers that are not finite.
    """
    call = Arguments("curve_distance", np.float64)
    control = call.array("control", control, (2, 2), (3, 2), (4, 2))
    points = call.array("points", points, ("N", 2))
    degree = len(control) - 1
    curve = np.einsum("ij,jk->ik", POWERS[degree], control)  # (d + 1, 2) coefficients
    slope = curve[1:] * np.arange(1, degree + 1)[:, None]
    # <B - p, B'>: only the constant of B - p depends on the point.
    product = np.zeros((len(points), 2 * degree))
    for i in range(degree + 1):
        shifted = curve[i] - points if i == 0 else np.broadcast_to(curve[i], points.shape)
        for j in range(degree):
            product[:, i + j] += np.einsum("nk,k->n", shifted, slope[j])
    t = np.concatenate([np.zeros((len(points), 1)), np.ones((len(points), 1)), _roots(product)], 1)
    weights = bernstein(np.full(t.size, degree), t.reshape(-1))[:, : degree + 1]
    at = np.einsum("nk,ki->ni", weights, control).reshape(*t.shape, 2)
    distance = np.sqrt(np.square(at - points[:, None]).sum(axis=2))
    best = distance.argmin(axis=1)[:, None]
    nearest, where = (np.take_along_axis(each, best, axis=1)[:, 0] for each in (distance, t))
    return nearest, where


@typed_call
def curve_distance_backward(control: Array, points: Array, d_distance: Array) -> FloatArray:
    """dL/dcontrol (d + 1, 2); points on the curve contribute nothing.

    Args:
        control, points: as for `curve_distance`.
        d_distance: (N,) dL/d of the distances.

    Raises:
        DtypeError, ShapeError, RangeError: as for `curve_distance`.
    """
    distance, t = curve_distance(control, points)
    call = Arguments("curve_distance_backward", np.float64)
    control = call.array("control", control, (2, 2), (3, 2), (4, 2))
    points = call.array("points", points, ("N", 2))
    d_distance = call.array("d_distance", d_distance, ("N",))
    weights = bernstein(np.full(len(t), len(control) - 1), t)[:, : len(control)]
    away = np.einsum("nk,ki->ni", weights, control) - points
    scale = np.divide(d_distance, distance, out=np.zeros_like(distance), where=distance > 0)
    found: FloatArray = np.einsum("nk,ni,n->ki", weights, away, scale)
    return found


@typed_call
def distance_stroke(control: Array, width: float, size: tuple[int, int]) -> FloatArray:
    """Coverage (H, W) of a stroke with round caps, as a ramp over the distance to its border.

    A pixel holds clip(1/2 + width / 2 - distance, 0, 1) with the distance of its center to the
    curve: the area where the border is straight and along an axis, and an estimate elsewhere.

    Args:
        control: as for `curve_distance`.
        width: in pixels, at least 1.
        size: (height, width) of the picture.

    Raises:
        DtypeError, ShapeError, RangeError: as for `curve_distance`, a width below 1.
    """
    call = Arguments("distance_stroke")
    width = call.number("width", width, low=1)
    size = call.size("size", size)
    y, x = np.mgrid[: size[0], : size[1]] + 0.5
    distance, _ = curve_distance(control, np.stack([x.ravel(), y.ravel()], axis=1))
    found: FloatArray = np.clip(0.5 + width / 2 - distance, 0, 1).reshape(size)
    return found


def _roots(coefficients: FloatArray) -> FloatArray:
    """(N, D) real parts of the roots of polynomials (N, D + 1), lowest power first, cut to [0, 1].

    As eigenvalues of companion matrices; where the highest coefficients are almost 0 the roots
    that they stand for are far away. A number that is no root is only a point too many to try.
    """
    degree = coefficients.shape[1] - 1
    scale = np.abs(coefficients).max(axis=1, keepdims=True)
    scaled = coefficients / np.where(scale > 0, scale, 1)
    highest = scaled[:, -1]
    highest = np.where(np.abs(highest) < 1e-14, 1e-14, highest)
    matrix = np.zeros((len(scaled), degree, degree))
    matrix[:, np.arange(1, degree), np.arange(degree - 1)] = 1
    matrix[:, :, -1] = -scaled[:, :-1] / highest[:, None]
    return np.clip(np.linalg.eigvals(matrix).real, 0, 1)
