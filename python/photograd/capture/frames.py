"""Coordinate frames of captures: which axes a file uses, and how to come to ours.

Ours: right-handed world with +Y up; camera axes +X right, +Y down, +Z forward (as OpenCV has them).
Every matrix is named result_from_source and acts on column vectors.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from photograd_course.portable_math import cos, matmul, norm, sin

from photograd._arrays import Arguments
from photograd.errors import SceneError, message
from photograd.types import FloatArray

OPENGL_FROM_OPENCV: FloatArray = np.diag([1.0, -1.0, -1.0, 1.0])
"""OpenGL cameras have +Y up and look along -Z: both axes flip, and the flip is its own inverse."""

Y_UP_FROM_Z_UP: FloatArray = np.array(
    [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
)
"""A quarter turn about X: (x, y, z) with z up becomes (x, z, -y) with y up."""

RIGID_TOLERANCE = 1e-4
"""Largest entry of R^T R - 1 that still counts as a rotation; files store about 7 digits."""

MAX_COORDINATE = 1e9
"""Positions beyond this (in meters, past the moon) are damage; their squares lose all digits."""


def check_pose(function: str, argument: str, matrix: FloatArray) -> FloatArray:
    """Return `matrix` as a (4, 4) float64 rigid transform, or say why it is none.

    Args:
        function: name of the caller, for the error text.
        argument: what the matrix belongs to, for example ``"frame 'r_3': transform_matrix"``.
        matrix: (4, 4), or (3, 4) whose last row is understood to be (0, 0, 0, 1).

    Raises:
        ShapeError: neither (4, 4) nor (3, 4).
        RangeError: non-finite or absurdly large entries.
        SceneError: not a rotation (orthonormal to 1e-4, determinant +1) and a translation.
    """
    call = Arguments(function, np.float64)
    low, high = -MAX_COORDINATE, MAX_COORDINATE
    matrix = call.array(argument, matrix, (4, 4), (3, 4), low=low, high=high)
    if len(matrix) == 3:
        matrix = np.concatenate([matrix, [[0.0, 0.0, 0.0, 1.0]]])
    rotation = matrix[:3, :3]
    deviation = float(np.abs(matmul(rotation.T, rotation) - np.eye(3)).max())
    remedy = "a pose holds a rotation and a translation, no scale or shear"
    if deviation > RIGID_TOLERANCE:
        got = f"columns that deviate by {deviation:.3g} from orthonormal"
        raise SceneError(message(function, argument, "a rigid pose", got, remedy))
    if float((np.cross(rotation[0], rotation[1]) * rotation[2]).sum()) < 0.0:
        got = "a reflection, determinant -1"
        raise SceneError(message(function, argument, "a rotation, determinant +1", got, remedy))
    if float(np.abs(matrix[3] - [0.0, 0.0, 0.0, 1.0]).max()) > RIGID_TOLERANCE:
        raise SceneError(message(function, argument, "last row (0, 0, 0, 1)", matrix[3].tolist()))
    return matrix


def invert_rigid(matrix: FloatArray) -> FloatArray:
    """Inverse of a (4, 4) rigid transform through the transpose, exact to rounding.

    Args:
        matrix: (4, 4), a rotation and a translation.
    """
    inverse = np.eye(4)
    inverse[:3, :3] = matrix[:3, :3].T
    inverse[:3, 3] = -matmul(matrix[:3, :3].T, matrix[:3, 3])
    return inverse


def rotation_from_quaternion(quaternion: FloatArray) -> FloatArray:
    """(3, 3) rotation of a quaternion (w, x, y, z) of any non-zero length."""
    w, x, y, z = np.asarray(quaternion, dtype=np.float64) / norm(np.asarray(quaternion, np.float64))
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def quaternion_from_rotation(rotation: FloatArray) -> FloatArray:
    """Unit quaternion (w, x, y, z), w >= 0, of a (3, 3) rotation.

    The largest of the four squares, which the diagonal gives, is taken first: it is at least 1/4,
    and the others follow from sums and differences across the diagonal.

    Args:
        rotation: (3, 3), orthonormal with determinant 1.
    """
    r = np.asarray(rotation, np.float64)
    x, y, z = r[0, 0], r[1, 1], r[2, 2]
    squares = np.array([x + y + z, x - y - z, y - x - z, z - x - y]) + 1.0  # 4 q^2
    k = int(np.argmax(squares))
    w_products = [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]]  # 4 w (x, y, z)
    yz, zx, xy = r[1, 2] + r[2, 1], r[2, 0] + r[0, 2], r[0, 1] + r[1, 0]  # 4 y z, ...
    products = np.array(
        [
            [squares[0], *w_products],
            [w_products[0], squares[1], xy, zx],
            [w_products[1], xy, squares[2], yz],
            [w_products[2], zx, yz, squares[3]],
        ]
    )
    quaternion: FloatArray = products[k] / norm(products[k])
    return -quaternion if quaternion[0] < 0.0 else quaternion


def rotation_from_axis_angle(vector: FloatArray) -> FloatArray:
    """(3, 3) rotation about `vector` (3,) by its length in radians (Rodrigues' formula)."""
    angle = norm(np.asarray(vector, np.float64))
    if angle == 0.0:
        return np.eye(3)
    half = 0.5 * angle
    xyz = np.asarray(vector, dtype=np.float64) * (float(sin(half)) / angle)
    return rotation_from_quaternion(np.concatenate([[float(cos(half))], xyz]))


def rotation_between(source: FloatArray, target: FloatArray) -> FloatArray:
    """Smallest (3, 3) rotation that turns unit vector `source` into unit vector `target`.

    With h the unit vector halfway between, two half turns compose to it: one about h, one about
    `target`. Opposite vectors have no halfway; then any axis at right angles serves.
    """
    halfway = source + target
    length = norm(halfway)
    if length < 1e-8:
        axis = np.cross(source, np.eye(3)[int(np.argmin(np.abs(source)))])
        return rotation_from_axis_angle(axis / norm(axis) * np.pi)
    half_turn = 2.0 * np.outer(halfway, halfway) / (length * length) - np.eye(3)
    return matmul(2.0 * np.outer(target, target) - np.eye(3), half_turn)


def mean_camera_up(poses: Sequence[FloatArray]) -> FloatArray:
    """Mean (3,) of the cameras' up directions in the frame of `poses` (OpenCV: up is -Y).

    Its length says how well the cameras agree: 1 if all stand alike, near 0 if they have no common
    up. It is not normalized.
    """
    result: FloatArray = np.mean([-pose[:3, 1] for pose in poses], axis=0)
    return result


def world_from_estimated_up(
    poses: Sequence[FloatArray], declared_z_up: bool
) -> tuple[FloatArray, str]:
    """Rotation (4, 4) that brings up to +Y for a file that does not promise which way is up.

    Args:
        poses: world_from_camera of all views in the file's world, OpenCV camera axes.
        declared_z_up: True if the format is customarily +Z up. Then +Z is taken, provided that the
            cameras' mean up lies within 25 degrees of it.

    Returns:
        The rotation and a sentence for the log that says what was done.
    """
    up = mean_camera_up(poses)
    agreement = norm(up)
    if agreement < 0.1:
        if declared_z_up:
            return Y_UP_FROM_Z_UP, "+Z up -> +Y up (assumed: the cameras have no common up)"
        return np.eye(4), "world axes kept (assumed: the cameras have no common up)"
    up = up / agreement
    if declared_z_up and float(up[2]) > cos(np.deg2rad(25.0)):
        return Y_UP_FROM_Z_UP, "+Z up -> +Y up"
    transform = np.eye(4)
    transform[:3, :3] = rotation_between(up, np.array([0.0, 1.0, 0.0]))
    listed = ", ".join(f"{component:.3f}" for component in up)
    return transform, f"mean camera up ({listed}) -> +Y up (estimated: the file does not say)"
