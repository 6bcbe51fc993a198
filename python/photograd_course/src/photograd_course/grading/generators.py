"""Random and regular inputs that checks of several assignments need."""

from __future__ import annotations

import numpy as np

Array = np.ndarray[tuple[int, ...], np.dtype[np.float64]]


def unit_vectors(rng: np.random.Generator, count: int) -> Array:
    """Vectors (count, 3) of length 1, uniform on the sphere.

    Args:
        rng: random numbers.
        count: how many.
    """
    v = rng.normal(size=(count, 3))
    unit: Array = v / np.linalg.norm(v, axis=1, keepdims=True)
    return unit


def upper_directions(rng: np.random.Generator, count: int, low: float = 0.1, up: int = 2) -> Array:
    """Unit vectors (count, 3) whose height is uniform from ``low`` to 1.

    Args:
        rng: random numbers.
        count: how many.
        low: the least height; -1 for the whole sphere.
        up: the axis that points up.
    """
    height, phi = rng.uniform(low, 1.0, count), rng.uniform(0.0, 2 * np.pi, count)
    return _raised(height, phi, up)


def random_rotation(rng: np.random.Generator) -> Array:
    """A rotation matrix (3, 3) about any axis, of determinant 1.

    Args:
        rng: random numbers.
    """
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    q[:, 0] *= np.sign(np.linalg.det(q))
    return q


def hemisphere_quadrature(heights: int, turns: int, up: int = 2) -> tuple[Array, Array]:
    """Directions (heights * turns, 3) above a plane, and their quadrature weights in steradians.

    Gauss-Legendre in the root of the height, so that lobes near the horizon are resolved; even
    steps around the axis ``up``.
    """
    nodes, weights = np.polynomial.legendre.leggauss(heights)
    root = (nodes + 1) / 2
    step = 2 * np.pi / turns
    height, phi = np.meshgrid(root**2, (np.arange(turns) + 0.5) * step, indexing="ij")
    return _raised(height, phi, up).reshape(-1, 3), np.repeat(root * weights * step, turns)


def cell_centers(shape: tuple[int, ...]) -> Array:
    """Centers of the cells of a grid over the unit cube, (product of shape, axes), last axis first.

    Column k runs along axis k; the last axis changes fastest.
    """
    parts = np.meshgrid(*((np.arange(n) + 0.5) / n for n in shape), indexing="ij")
    return np.stack([part.ravel() for part in parts], axis=1)


def _raised(height: Array, phi: Array, up: int) -> Array:
    """Unit vectors of given height along the axis ``up``; the other two axes in their order."""
    r = np.sqrt(1 - height * height)
    level = [r * np.cos(phi), r * np.sin(phi)]
    return np.stack([*level[:up], height, *level[up:]], axis=-1)
