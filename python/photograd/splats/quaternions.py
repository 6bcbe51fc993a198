"""Rotations of many quaternions at once."""

from __future__ import annotations

import numpy as np
from photograd_course.portable_math import matmul

from photograd.errors import ShapeError, message
from photograd.types import Array


def rotation_matrices(quats: Array) -> Array:
    """(N, 3, 3) float64 of quaternions (N, 4) as (w, x, y, z), of any length; zero ones turn
    nothing.

    R = I + 2 w [v]x + 2 [v]x [v]x for a unit quaternion (w, v). [Shoemake1985]

    Raises:
        ShapeError: `quats` is not (N, 4).
    """
    if quats.ndim != 2 or quats.shape[1] != 4:
        raise ShapeError(message("rotation_matrices", "quats", "shape (N, 4)", f"{quats.shape}"))
    q = quats.astype(np.float64)
    length = np.linalg.norm(q, axis=1, keepdims=True)
    w, x, y, z = (np.where(length > 0, q / np.where(length > 0, length, 1), [1, 0, 0, 0])).T
    zero = np.zeros_like(w)
    cross = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape(-1, 3, 3)
    turned: Array = np.eye(3) + 2 * w[:, None, None] * cross + 2 * matmul(cross, cross)
    return turned
