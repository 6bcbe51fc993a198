"""Recovering a texture from its colours at points, by gradient descent.

    L(T) = 1 / (N C) sum over points i, channels c of (T(uv_i)_c - color_ic)^2

The lookup is linear in T, so L is a quadratic bowl: its second derivative H is one symmetric matrix
for all T, the same for every channel. Descent with step s multiplies the error along an
eigenvector of H with eigenvalue h by 1 - s h, and so converges if s < 2 / h for the largest h of
all. Directions with small h take long: texels that few points see, and only from far.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd_course.portable_math import norm

from photograd._arrays import Arguments
from photograd.errors import Error, RangeError, message
from photograd.textures.sample import TexturePlan, sample_backward
from photograd.types import Array

SAFETY = 0.95  # of the bound that keeps descent from diverging


@dataclass(frozen=True, eq=False)
class Recovery:
    """What came out of a recovery.

    Attributes:
        texture: (H, W, C). Unseen texels hold the value that they started with.
        losses: (steps + 1,) float64, before the first step, between steps, and after the last.
        unseen: (H, W) bool, texels in no point's lookup: nothing is known about them.
        learning_rate: the step that was taken.
    """

    texture: Array
    losses: NDArray[np.float64]
    unseen: NDArray[np.bool_]
    learning_rate: float


def stable_learning_rate(
    uv: Array, shape: Sequence[int], channels: int, *, steps: int = 100
) -> float:
    """0.95 of 2 / h, with h the largest eigenvalue of the loss's second derivative.

    h comes from power iteration, from the constant texture: H has no negative entry, so that start
    is not orthogonal to the eigenvector wanted. The estimate approaches h from below, which the
    0.95 makes up for.

    Args:
        uv: (N, 2) points.
        shape: (H, W) of the texture.
        channels: C; the loss is a mean over channels, too.
        steps: of the power iteration.

    Raises:
        DtypeError, ShapeError, RangeError: points or shape that make no plan.
    """
    uv = Arguments("stable_learning_rate").array("uv", uv, ("N", 2), finite=False)
    # With black targets the gradient is H T itself, here of a texture with one channel.
    plan = TexturePlan(uv, np.zeros((len(uv), 1), uv.dtype), shape)
    vector = np.ones(plan.shape, uv.dtype)
    largest = 0.0
    for _ in range(steps):
        vector /= uv.dtype.type(norm(vector))
        _, image = plan.loss_and_gradient(vector)
        largest = float((vector * image).sum(dtype=np.float64))
        vector = image
    return SAFETY * 2.0 / (largest / channels)


def recover(
    uv: Array,
    colors: Array,
    shape: Sequence[int],
    *,
    steps: int,
    learning_rate: float | None = None,
    start: float = 0.5,
) -> Recovery:
    """Recover a texture (H, W, C) from colours (N, C) at points uv (N, 2).

    Args:
        uv, colors: of one dtype, which is the texture's.
        shape: (H, W).
        steps: of plain gradient descent.
        learning_rate: its step; None takes `stable_learning_rate`.
        start: value of all texels before the first step, and of unseen ones after the last.

    Raises:
        DtypeError, ShapeError, RangeError: arrays that do not fit each other, steps below 1, a
            learning rate that is not positive.
        Error: the loss is no longer finite; the learning rate is too large.
    """
    uv = Arguments("recover").array("uv", uv, ("N", 2), finite=False)
    plan = TexturePlan(uv, colors, shape)
    if steps < 1:
        raise RangeError(message("recover", "steps", "at least 1", steps))
    if learning_rate is None:
        learning_rate = stable_learning_rate(uv, shape, plan.shape[2])
    if not learning_rate > 0:
        raise RangeError(message("recover", "learning_rate", "a positive number", learning_rate))
    texture = np.full(plan.shape, start, uv.dtype)
    gradient = np.empty_like(texture)
    losses = np.empty(steps + 1)
    for step in range(steps + 1):
        losses[step], _ = plan.loss_and_gradient(texture, out=gradient)
        if not np.isfinite(losses[step]):
            got = f"{losses[step]} before step {step}"
            remedy = f"lower learning_rate, {learning_rate:.6g}"
            raise Error(message("recover", "loss", "a finite number", got, remedy))
        if step < steps:
            gradient *= uv.dtype.type(learning_rate)
            texture -= gradient
    return Recovery(texture, losses, _unseen(uv, shape), learning_rate)


def _unseen(uv: Array, shape: Sequence[int]) -> NDArray[np.bool_]:
    """(H, W) texels whose weights in all lookups are zero."""
    ones: NDArray[Any] = np.ones((len(uv), 1), uv.dtype)
    weights, _ = sample_backward(np.zeros((*shape, 1), uv.dtype), uv, ones)
    mask: NDArray[np.bool_] = weights[..., 0] == 0
    return mask
