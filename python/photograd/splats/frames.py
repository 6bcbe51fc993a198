"""Frames of Gaussians: which axis of a file points up, and scenes rotated as a whole.

The world of this project has +Y up. Files of Gaussians usually have -y up: their frame is that of
structure from motion, y down and z forward, half a turn about x away.
"""

from __future__ import annotations

import numpy as np

from photograd import sh
from photograd.capture.frames import rotation_from_quaternion
from photograd.errors import RangeError, message
from photograd.splats.splatting import Gaussians
from photograd.types import Array

UP_AXES = ("+x", "-x", "+y", "-y", "+z", "-z")
USUAL_UP = "-y"
WORLD_UP = "+y"


def file_from_upright(up: str) -> Array:
    """(3, 3) rotation from a frame with +Y up to one in which `up`, such as "-y", points up.

    About x where that is possible: for "-y" it is the half turn, for "+y" the identity.

    Raises:
        RangeError: no axis of that name.
    """
    y = _axis("file_from_upright", up)
    if y[0] == 0.0:
        x = np.eye(3)[0]
        return np.stack([x, y, np.cross(x, y)], axis=1)
    z = np.eye(3)[2]
    return np.stack([np.cross(y, z), y, z], axis=1)


def half_turn(gaussians: Gaussians) -> Gaussians:
    """The Gaussians after half a turn about x, which is its own inverse, to the bit.

    Their axes turn too and are then reversed in y and z, which changes no Gaussian: the quaternion
    (w, x, y, z) becomes (w, x, -y, -z). A harmonic keeps its sign or changes it.
    """
    flips = np.array([1, -1, -1], gaussians.means.dtype)
    turn = sh.rotation(np.diag([1.0, -1.0, -1.0]), gaussians.degree)
    signs = np.rint(np.diag(turn)).astype(flips.dtype)
    return Gaussians(
        means=gaussians.means * flips,
        log_scales=gaussians.log_scales,
        quats=gaussians.quats * np.array([1, 1, -1, -1], flips.dtype),
        opacity_logits=gaussians.opacity_logits,
        sh=gaussians.sh * signs[:, None],
    )


def with_usual_up(gaussians: Gaussians, up: str) -> Gaussians:
    """Gaussians in whose frame `up` points up, rotated as a whole so that -y does.

    Raises:
        RangeError: no axis of that name.
    """
    source, target = _axis("with_usual_up", up), _axis("with_usual_up", USUAL_UP)
    if source @ target < 0.0:
        return half_turn(gaussians)
    # From one direction to another the shorter way; of length one where they agree.
    turn = np.array([1.0 + source @ target, *np.cross(source, target)])
    return _rotated(gaussians, turn / np.linalg.norm(turn))


def _rotated(gaussians: Gaussians, turn: Array) -> Gaussians:
    """The Gaussians turned by a unit quaternion (4,): means, axes and harmonics."""
    rotation = rotation_from_quaternion(turn)
    w, x, y, z = turn
    product = np.array([[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]])
    of_harmonics = sh.rotation(rotation, gaussians.degree)
    dtype = gaussians.means.dtype
    return Gaussians(
        means=(gaussians.means @ rotation.T).astype(dtype),
        log_scales=gaussians.log_scales,
        quats=(gaussians.quats @ product.T).astype(dtype),
        opacity_logits=gaussians.opacity_logits,
        sh=np.einsum("jk,nkc->njc", of_harmonics, gaussians.sh).astype(dtype),
    )


def _axis(function: str, up: str) -> Array:
    if up not in UP_AXES:
        raise RangeError(message(function, "up", f"one of {', '.join(UP_AXES)}", up))
    sign = 1.0 if up[0] == "+" else -1.0
    return np.asarray(sign * np.eye(3)["xyz".index(up[1])])
