"""Real spherical harmonics to degree 4: evaluate, differentiate, project, rotate, light a surface.

Coefficient k = l (l + 1) + m, m from -l to l. Signs are those of Plenoxels and Gaussian splatting,
which keep the phase (-1)^m; `from_convention` and `to_convention` convert. Directions are unit
vectors; what a direction means (towards the viewer, from the light) is for the caller to say, and
a wrong sign shows in the odd degrees only. [Sloan2008]
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photograd._arrays import Arguments
from photograd._checks import typed
from photograd._compiled import _core
from photograd.errors import RangeError, message
from photograd.types import Array

Convention = Literal["splat", "no_phase"]
MAX_DEGREE = 4
Y_0 = 0.28209479177387814
"""The constant harmonic, 1/2 sqrt(1/pi), as in cpp/photograd/ops/sh.h."""
# Lambert's cosine lobe in zonal harmonics, degree by degree [Ramamoorthi2001, Eq. 8]: pi, 2 pi / 3,
# pi / 4, 0, -pi / 24.
COSINE_LOBE = np.array([np.pi, 2 * np.pi / 3, np.pi / 4, 0.0, -np.pi / 24])


def count(degree: int) -> int:
    """Number of coefficients, (degree + 1)^2.

    Raises:
        RangeError: the degree is not 0 to 4.
    """
    return (Arguments("sh.count").integer("degree", degree, low=0, high=MAX_DEGREE) + 1) ** 2


def degree_of(coefficients: int) -> int:
    """The degree that has so many coefficients.

    Raises:
        RangeError: none has.
    """
    for degree in range(MAX_DEGREE + 1):
        if count(degree) == coefficients:
            return degree
    raise RangeError(message("sh.degree_of", "coefficients", "1, 4, 9, 16 or 25", coefficients))


def evaluate(coefficients: Array, directions: Array, *, out: Array | None = None) -> Array:
    """The values sum_k Y_k(directions) coefficients[:, k].

    Args:
        coefficients: (N, K, C) with C 1 or 3, float32 or float64.
        directions: (N, 3), of the same dtype; unit vectors.
        out: (N, C), overwritten; by default a new array.

    Returns:
        (N, C), `out` where it is given.

    Raises:
        DtypeError, RangeError, ShapeError: arrays other than these.
    """
    call = Arguments("sh.evaluate")
    coefficients = call.array("coefficients", coefficients, ("N", "K", "C"), finite=False)
    directions = call.array("directions", directions, ("N", 3), finite=False)
    values = np.empty(coefficients.shape[::2], coefficients.dtype) if out is None else out
    call.run(_core.sh_colors, directions, coefficients, values)
    return values


def evaluate_backward(
    coefficients: Array,
    directions: Array,
    d_values: Array,
    *,
    out: tuple[Array, Array] | None = None,
) -> tuple[Array, Array]:
    """Derivatives of a loss with respect to coefficients (N, K, C) and directions (N, 3).

    That with respect to a direction is the derivative of the polynomials, before
    normalization. `out`, a pair of such arrays, is overwritten; by default they are new.
    """
    call = Arguments("sh.evaluate_backward")
    coefficients = call.array("coefficients", coefficients, ("N", "K", "C"), finite=False)
    directions = call.array("directions", directions, ("N", 3), finite=False)
    d_values = call.array("d_values", d_values, ("N", "C"), finite=False)
    d_coefficients, d_directions = (
        (np.empty_like(coefficients), np.empty_like(directions)) if out is None else out
    )
    arrays = (directions, coefficients, d_values, d_directions, d_coefficients)
    call.run(_core.sh_colors_backward, *arrays, add=False)
    return d_coefficients, d_directions


def basis(directions: ArrayLike, degree: int) -> NDArray[np.float64]:
    """Y (N, K) at directions (N, 3), in float64."""
    d = np.ascontiguousarray(directions, np.float64)
    k = count(degree)
    columns = np.empty((k, len(d)))
    for i in range(k):
        unit = np.zeros((len(d), k, 1))
        unit[:, i] = 1.0
        columns[i] = evaluate(unit, d)[:, 0]
    return np.ascontiguousarray(columns.T)


def project(
    directions: ArrayLike, values: ArrayLike, weights: ArrayLike, degree: int
) -> NDArray[np.float64]:
    """Coefficients (K, C) of a function: sum_i weights_i Y_k(directions_i) values_i.

    Args:
        directions: (N, 3), unit vectors.
        values: (N, C), the function there.
        weights: (N,), solid angles in sr that add up to 4 pi; 4 pi / N for uniform directions.
        degree: 0 to 4.
    """
    Y = basis(directions, degree)
    return Y.T @ (np.asarray(weights, np.float64)[:, None] * np.asarray(values, np.float64))


def rotation(rotation_matrix: ArrayLike, degree: int) -> NDArray[np.float64]:
    """The matrix (K, K) that turns coefficients: rotate(f)(R d) = f(d).

    Found degree by degree from more than 2 l + 1 directions, by solving for what makes both sides
    equal; exact up to rounding, because harmonics of one degree rotate among themselves.

    Args:
        rotation_matrix: (3, 3), orthonormal with determinant 1.
        degree: 0 to 4.

    Raises:
        RangeError: the matrix is no rotation.
    """
    R = np.asarray(rotation_matrix, np.float64)
    if R.shape != (3, 3) or not np.allclose(R @ R.T, np.eye(3), atol=1e-9) or np.linalg.det(R) < 0:
        raise RangeError(message("sh.rotation", "rotation_matrix", "a rotation (3, 3)", R.shape))
    k = count(degree)
    d = np.random.default_rng(1).normal(size=(4 * k, 3))
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    here, there = basis(d, degree), basis(d @ R.T, degree)
    turned = np.zeros((k, k))
    for band in range(degree + 1):
        at = slice(band * band, (band + 1) ** 2)
        # there @ turned @ c = here @ c for every c
        turned[at, at] = np.linalg.lstsq(there[:, at], here[:, at], rcond=None)[0]
    return turned


def irradiance(coefficients: ArrayLike, normals: ArrayLike) -> NDArray[np.float64]:
    """Irradiance (N, C) on surfaces of these normals (N, 3), from radiance coefficients (K, C).

    Radiance arriving from direction d is sum_k c_k Y_k(d). Nine coefficients (degree 2) keep the
    error of a distant light below 3 % on average [Ramamoorthi2001].
    """
    c = np.asarray(coefficients, np.float64)
    degree = degree_of(len(c))
    lobe = np.repeat(COSINE_LOBE[: degree + 1], 2 * np.arange(degree + 1) + 1)
    return basis(normals, degree) @ (lobe[:, None] * c)


def from_convention(coefficients: Array, convention: Convention) -> Array:
    """Coefficients (..., K, C) of another convention in ours.

    "splat" is ours; "no_phase" lacks the sign (-1)^m, as most textbooks of computer graphics.
    """
    typed("sh.from_convention", "convention", Convention, convention)
    if convention == "splat":
        return coefficients.copy()
    degree = degree_of(coefficients.shape[-2])
    orders = np.concatenate([np.arange(-band, band + 1) for band in range(degree + 1)])
    signs = np.where(orders % 2 == 0, 1, -1).astype(coefficients.dtype)
    return np.asarray(coefficients * signs[:, None])


def to_convention(coefficients: Array, convention: Convention) -> Array:
    """Our coefficients (..., K, C) in another convention; the inverse of `from_convention`."""
    return from_convention(coefficients, convention)  # a change of signs is its own inverse
