"""Where rays meet triangles and spheres, with the adjoints: points, barycentrics, normals.

The triangle or the root of the sphere is held fixed; the point moves with the ray and the surface.
All arrays are float64, one row a ray; vectors are (R, 3).

Triangle with corners v0, v1, v2 [Moller1997]:

    e1 = v1 - v0    e2 = v2 - v0    s = o - v0    P = d x e2    Q = s x e1    D = e1 . P
    b1 = s . P / D            b2 = d . Q / D            p = v0 + b1 e1 + b2 e2
    m  = n0 + b1 (n1 - n0) + b2 (n2 - n0)               n = m / |m|        m = e1 x e2 if flat

Sphere around c of radius r, F(t) = |o + t d - c|^2 - r^2 = 0, and the implicit function theorem:

    p = o + t d    n = (p - c) / r    dt = -((p - c) . (do + t dd - dc) - r dr) / ((p - c) . d)
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from photograd.types import Array, FloatArray


def dot(a: FloatArray, b: FloatArray) -> FloatArray:
    """(R,) inner products of the rows of (R, 3).

    Args:
        a, b: vectors.
    """
    return a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2]


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """(R, 3) cross products of the rows.

    Args:
        a, b: (R, 3) vectors.
    """
    out = np.empty(np.broadcast_shapes(a.shape, b.shape))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        out[:, i] = a[:, j] * b[:, k] - a[:, k] * b[:, j]
    return out


def unit(m: FloatArray) -> FloatArray:
    """Rows of length 1.

    Args:
        m: (R, 3), none of them 0.
    """
    return np.asarray(m / np.sqrt(dot(m, m))[:, None])


def unit_backward(m: FloatArray, d_n: FloatArray) -> FloatArray:
    """dL/dm: (d_n - n (n . d_n)) / |m|.

    Args:
        m: as for `unit`.
        d_n: (R, 3) dL/d of what it returned.
    """
    length = np.sqrt(dot(m, m))[:, None]
    n = m / length
    return np.asarray((d_n - n * dot(n, d_n)[:, None]) / length)


class Point(NamedTuple):
    """Where rays meet a surface."""

    position: Array  # (R, 3) meters
    normal: Array  # (R, 3) unit length, shading normal, outwards
    barycentrics: Array  # (R, 2) of the second and third corner; 0 on spheres


class PointGradient(NamedTuple):
    """dL/d of a ray and of the surface that it meets, one row a ray."""

    origin: Array
    direction: Array
    surface: tuple[Array, ...]


def on_triangle(
    o: FloatArray, d: FloatArray, corners: FloatArray, normals: FloatArray | None
) -> Point:
    """Points of rays (R, 3) in the planes of triangles (R, 3, 3).

    Args:
        o, d: origins, in meters, and directions.
        corners: corner by corner, counter-clockwise seen from outside.
        normals: at the corners, of any length; None is flat.
    """
    e1, e2 = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    s = o - corners[:, 0]
    P, Q = cross(d, e2), cross(s, e1)
    D = dot(e1, P)
    b1, b2 = dot(s, P) / D, dot(d, Q) / D
    position = corners[:, 0] + b1[:, None] * e1 + b2[:, None] * e2
    m = cross(e1, e2) if normals is None else _blended(b1, b2, normals)
    return Point(position, unit(m), np.stack([b1, b2], axis=1))


def on_triangle_backward(
    o: FloatArray, d: FloatArray, corners: FloatArray, normals: FloatArray | None, d_out: Point
) -> PointGradient:
    """The adjoint of `on_triangle`; `surface` holds dL/dcorners and dL/dnormals (R, 3, 3).

    Args:
        o, d, corners, normals: as for `on_triangle`.
        d_out: dL/d of what it returned.
    """
    e1, e2 = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    s = o - corners[:, 0]
    P, Q = cross(d, e2), cross(s, e1)
    D = dot(e1, P)
    b1, b2 = dot(s, P) / D, dot(d, Q) / D
    d_b1 = d_out.barycentrics[:, 0] + dot(d_out.position, e1)
    d_b2 = d_out.barycentrics[:, 1] + dot(d_out.position, e2)
    d_e1, d_e2 = b1[:, None] * d_out.position, b2[:, None] * d_out.position
    d_normals = np.zeros_like(corners)
    if normals is None:
        d_m = unit_backward(cross(e1, e2), d_out.normal)
        d_e1 = d_e1 + cross(e2, d_m)
        d_e2 = d_e2 + cross(d_m, e1)
    else:
        d_m = unit_backward(_blended(b1, b2, normals), d_out.normal)
        d_b1 = d_b1 + dot(d_m, normals[:, 1] - normals[:, 0])
        d_b2 = d_b2 + dot(d_m, normals[:, 2] - normals[:, 0])
        weights = np.stack([1.0 - b1 - b2, b1, b2], axis=1)
        d_normals = weights[:, :, None] * d_m[:, None, :]
    d_x1, d_x2 = (d_b1 / D)[:, None], (d_b2 / D)[:, None]
    d_D = (-(b1 * d_b1 + b2 * d_b2) / D)[:, None]
    d_P, d_Q = d_x1 * s + d_D * e1, d_x2 * d
    d_s = d_x1 * P + cross(e1, d_Q)
    d_e1 = d_e1 + d_D * P + cross(d_Q, s)
    d_e2 = d_e2 + cross(d_P, d)
    d_d = d_x2 * Q + cross(e2, d_P)
    d_v0 = d_out.position - d_s - d_e1 - d_e2
    return PointGradient(d_s, d_d, (np.stack([d_v0, d_e1, d_e2], axis=1), d_normals))


def _blended(b1: FloatArray, b2: FloatArray, normals: FloatArray) -> FloatArray:
    b0 = 1.0 - b1 - b2
    return np.asarray(
        b0[:, None] * normals[:, 0] + b1[:, None] * normals[:, 1] + b2[:, None] * normals[:, 2]
    )


def sphere_distances(
    o: FloatArray, d: FloatArray, center: FloatArray, radius: float
) -> tuple[FloatArray, FloatArray]:
    """(R,) distances of the nearer and the farther point; infinite where a ray misses.

    Args:
        o, d: (R, 3) rays; directions of any length.
        center: (3,) meters.
        radius: meters.
    """
    s = o - center
    a, b, c = dot(d, d), dot(s, d), dot(s, s) - radius * radius
    root = b * b - a * c
    hit = root > 0
    width = np.sqrt(np.where(hit, root, 0.0))
    # The larger of two numbers that agree in sign first: no cancellation.
    q = -(b + np.where(b > 0, width, -width))
    with np.errstate(divide="ignore", invalid="ignore"):
        one, two = q / a, c / q
    near, far = np.minimum(one, two), np.maximum(one, two)
    return np.where(hit, near, np.inf), np.where(hit, far, np.inf)


def on_sphere(o: FloatArray, d: FloatArray, center: FloatArray, radius: float, far: Array) -> Point:
    """Points of rays (R, 3) on a sphere.

    Args:
        o, d: origins, in meters, and directions.
        center: (3,) meters.
        radius: meters.
        far: (R,) bool: which of the two points.
    """
    near_t, far_t = sphere_distances(o, d, center, radius)
    position = o + np.where(far, far_t, near_t)[:, None] * d
    return Point(position, (position - center) / radius, np.zeros((len(o), 2)))


def on_sphere_backward(
    o: FloatArray, d: FloatArray, center: FloatArray, radius: float, far: Array, d_out: Point
) -> PointGradient:
    """The adjoint of `on_sphere`; `surface` holds dL/dcenter (R, 3) and dL/dradius (R,).

    Args:
        o, d, center, radius, far: as for `on_sphere`.
        d_out: dL/d of what it returned.
    """
    near_t, far_t = sphere_distances(o, d, center, radius)
    t = np.where(far, far_t, near_t)[:, None]
    arm = o + t * d - center
    d_p = d_out.position + d_out.normal / radius
    k = (dot(d_p, d) / dot(arm, d))[:, None]
    d_o = d_p - k * arm
    d_center = k * arm - d_out.normal / radius
    d_radius = k[:, 0] * radius - dot(d_out.normal, arm) / (radius * radius)
    return PointGradient(d_o, t * d_o, (d_center, d_radius))
