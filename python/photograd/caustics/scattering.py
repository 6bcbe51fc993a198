"""What a specular surface makes of a ray: refraction, reflection and Fresnel, with the adjoint.

d is the unit direction of a ray, n the unit normal outwards, eta the index inside over outside:

    c = -d . n,  e = eta                 from outside (d . n < 0)
    c =  d . n,  e = 1 / eta,  n <- -n   from inside
    t = sqrt(1 - (1 - c^2) / e^2)        no refraction where the square is not positive
    refracted   w = d / e + (c / e - t) n           times (1 - F(e, c)) / p
    reflected   w = d + 2 c n                       times F(e, c) / p
    mirror      w = d + 2 c n                       times 1, black from inside

F is Fresnel's reflectance [Born1999, Sec. 1.5.2], p the probability with which the lobe was chosen,
held fixed. Power is carried, not radiance: the factor 1 / e^2 of radiance cancels between two ends
of a chain that lie in the same medium.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from photograd.caustics.intersections import dot
from photograd.types import Array, FloatArray


class Scattered(NamedTuple):
    """A ray behind a surface."""

    direction: Array  # (R, 3)
    factor: Array  # (R,) of the power


class ScatteredGradient(NamedTuple):
    """dL/d of what went into `scatter`."""

    direction: Array  # (R, 3)
    normal: Array  # (R, 3)
    eta: Array  # (R,), to be summed up


def fresnel(e: FloatArray, c: FloatArray) -> FloatArray:
    """Reflectance of unpolarized light; 1 under total reflection.

    Args:
        e: (R,) index on the far side over the near one.
        c: (R,) cosine on the near side.
    """
    square = 1.0 - (1.0 - c * c) / (e * e)
    t = np.sqrt(np.maximum(square, 0.0))
    s, p = (c - e * t) / (c + e * t), (e * c - t) / (e * c + t)
    return np.where(square > 0, 0.5 * (s * s + p * p), 1.0)


def fresnel_backward(
    e: FloatArray, c: FloatArray, d_F: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """dL/de and dL/dc; 0 under total reflection.

    Args:
        e, c: as for `fresnel`.
        d_F: (R,) dL/d of what it returned.
    """
    square = 1.0 - (1.0 - c * c) / (e * e)
    through = square > 0
    t = np.sqrt(np.where(through, square, 1.0))
    d_F = np.where(through, d_F, 0.0)
    s, p = c + e * t, e * c + t
    q_s, q_p = 2.0 * d_F * (c - e * t) / (s * s * s), 2.0 * d_F * (e * c - t) / (p * p * p)
    d_y, d_x = -q_s * c, q_p * t  # of e t in s, of e c in p
    d_t = d_y * e - q_p * e * c
    d_e = d_y * t + d_x * c + d_t * (1.0 - c * c) / (e * e * e * t)
    d_c = q_s * e * t + d_x * e + d_t * c / (e * e * t)
    return d_e, d_c


def sides(
    d: FloatArray, n: FloatArray, eta: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """+1 from outside and -1 from inside (R,), the normal towards the ray, c and e.

    Args:
        d, n: (R, 3) as for `scatter`.
        eta: index inside over outside.
    """
    along = dot(d, n)
    side = np.where(along < 0, 1.0, -1.0)
    return side, side[:, None] * n, np.abs(along), np.where(along < 0, eta, 1.0 / eta)


def scatter(
    d: FloatArray, n: FloatArray, eta: float | None, reflected: Array, pmf: FloatArray
) -> Scattered:
    """Rays that go on from a surface.

    Args:
        d: (R, 3) unit directions.
        n: (R, 3) unit normals.
        eta: index inside over outside; None is a mirror.
        reflected: (R,) bool, which lobe.
        pmf: (R,) its probability.
    """
    side, n, c, e = sides(d, n, 1.0 if eta is None else eta)
    bounced = d + (2.0 * c)[:, None] * n
    if eta is None:
        return Scattered(bounced, np.where(side > 0, 1.0, 0.0))
    t = np.sqrt(np.maximum(1.0 - (1.0 - c * c) / (e * e), 0.0))
    bent = d / e[:, None] + (c / e - t)[:, None] * n
    F = fresnel(e, c)
    factor = np.where(reflected, F, 1.0 - F) / pmf
    return Scattered(np.where(reflected[:, None], bounced, bent), factor)


def scatter_backward(
    d: FloatArray,
    n: FloatArray,
    eta: float | None,
    reflected: Array,
    pmf: FloatArray,
    d_out: Scattered,
) -> ScatteredGradient:
    """The adjoint of `scatter`.

    Args:
        d, n, eta, reflected, pmf: as for `scatter`.
        d_out: dL/d of what it returned.
    """
    side, n, c, e = sides(d, n, 1.0 if eta is None else eta)
    back = reflected if eta is not None else np.ones(len(d), bool)
    d_w = d_out.direction
    along = dot(d_w, n)
    t = np.sqrt(np.where(back, 1.0, 1.0 - (1.0 - c * c) / (e * e)))
    d_t = np.where(back, 0.0, -along)
    d_c = np.where(back, 2.0 * along, along / e)
    d_e = np.where(back, 0.0, -(dot(d, d_w) + c * along) / (e * e))
    d_d = np.where(back[:, None], d_w, d_w / e[:, None])
    d_n = np.where(back, 2.0 * c, c / e - t)[:, None] * d_w
    d_c = d_c + d_t * c / (e * e * t)
    d_e = d_e + d_t * (1.0 - c * c) / (e * e * e * t)
    if eta is not None:
        F_e, F_c = fresnel_backward(e, c, d_out.factor * np.where(reflected, 1.0, -1.0) / pmf)
        d_e, d_c = d_e + F_e, d_c + F_c
    d_d = d_d - d_c[:, None] * n
    d_n = side[:, None] * (d_n - d_c[:, None] * d)
    return ScatteredGradient(d_d, d_n, np.where(side > 0, d_e, -d_e * e * e))
