"""Recovering a texture from its colors at points, by gradient descent.

    L(T) = 1 / (N C) sum over points i, channels c of (T(uv_i)_c - color_ic)^2

The lookup is linear in T, so L is a quadratic bowl: its second derivative H is one symmetric matrix
for all T, the same for every channel. Descent with step s multiplies the error along an
eigenvector of H with eigenvalue h by 1 - s h, and so converges if s < 2 / h for the largest h of
all. Directions with small h take long: texels that few points see, and only from far.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd_course.portable_math import norm

from photograd._arrays import Arguments
from photograd._checkpoint import (
    Checkpoint,
    check_arrays,
    check_history,
    checked_step,
    load_checkpoint,
    save_checkpoint,
)
from photograd._descend import Progress, Run, changing, descend, progress_bar, run_folder
from photograd._notebook import EDGE, RED, png_of_sheet, sheet
from photograd._typed import typed_call
from photograd.errors import Error, IoError, RangeError, message
from photograd.textures.sample import TexturePlan, sample_backward
from photograd.types import Array

FILE_NAME = "texture.npz"
SAFETY = 0.95  # of the bound that keeps descent from diverging


@typed_call
@dataclass(frozen=True, eq=False)
class RecoveredTexture:
    """A texture recovered from samples.

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

    def _repr_png_(self) -> bytes:
        """The first three channels, or one as gray; beside it, in red, the texels that are unseen.

        Values are shown as display values.
        """
        channels = [min(k, self.texture.shape[2] - 1) for k in range(3)]
        shown = self.texture[..., channels].astype(np.float64)
        unseen = np.where(self.unseen[..., None], RED, 1.0)
        return png_of_sheet(sheet([shown, unseen], 2, EDGE // 2))


@typed_call
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
    call = Arguments("stable_learning_rate")
    uv = call.array("uv", uv, ("N", 2), finite=False, min_length=1)
    call.integer("channels", channels, low=1)
    call.integer("steps", steps, low=1)
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


@typed_call
def recover(
    uv: Array,
    colors: Array,
    shape: Sequence[int],
    *,
    steps: int,
    learning_rate: float | None = None,
    start: float = 0.5,
    folder: Path | None = None,
    resume: bool = False,
    bar: bool = False,
    should_stop: Callable[[], bool] = lambda: False,
) -> RecoveredTexture:
    """Recover a texture (H, W, C) from colors (N, C) at points uv (N, 2).

    Args:
        uv, colors: of one dtype, which is the texture's.
        shape: (H, W).
        steps: of plain gradient descent.
        learning_rate: its step; None takes `stable_learning_rate`.
        start: value of all texels before the first step, and of unseen ones after the last.
        folder: for the checkpoint, DIR/texture.npz, written every 30 s and at the end.
        resume: go on from that checkpoint, to the same bits as without interruption.
        bar: show progress on stderr.
        should_stop: asked before each step; the losses then end with that of the last step.

    Raises:
        DtypeError, ShapeError, RangeError: arrays that do not fit each other, steps below 1, a
            learning rate that is not positive, a checkpoint of another recovery, or a folder that
            holds one without `resume`.
        IoError: a checkpoint that cannot be written, or is not there to resume from.
        Error: the loss is no longer finite; the learning rate is too large.
    """
    uv = Arguments("recover").array("uv", uv, ("N", 2), finite=False)
    plan = TexturePlan(uv, colors, shape)
    Arguments("recover").integer("steps", steps, low=1)
    if learning_rate is None:
        learning_rate = stable_learning_rate(uv, shape, plan.shape[2])
    Arguments("recover").number("learning_rate", learning_rate, above=0)
    with run_folder("recover", folder, FILE_NAME, resume=resume):
        texture = np.full(plan.shape, start, uv.dtype)
        told = {"steps": steps, "learning_rate": learning_rate, "start": start}
        job = _Descent(plan, texture, told, _digest(uv, colors))
        if resume and folder is not None:
            job.load(folder)
        with progress_bar("recover", job, shown=bar) as on_step:

            def after_step(now: float) -> None:
                del now
                if on_step:
                    on_step(Progress(job.step_number, steps, job.losses[-1]))

            def result(run: Run) -> RecoveredTexture:
                last = [job.loss()] if run.finished else []
                losses = np.array(job.losses + last)
                return RecoveredTexture(job.texture, losses, _unseen(uv, shape), learning_rate)

            return descend(job, folder, result, after_step=after_step, should_stop=should_stop)


class _Descent:
    """Plain gradient descent of a texture, as `descend` drives it."""

    def __init__(
        self, plan: TexturePlan, texture: Array, options: dict[str, float], digest: str
    ) -> None:
        self.plan, self.texture, self.options, self.digest = plan, texture, options, digest
        self.gradient = np.empty_like(texture)
        self.losses: list[float] = []
        self.step_number = 0
        self.changing = False

    @property
    def steps(self) -> int:
        return int(self.options["steps"])

    def loss(self) -> float:
        """Of the texture as it is; its gradient lies in `gradient`."""
        loss, _ = self.plan.loss_and_gradient(self.texture, out=self.gradient)
        if not np.isfinite(loss):
            got = f"{loss} before step {self.step_number}"
            remedy = f"lower learning_rate, {self.options['learning_rate']:.6g}"
            raise Error(message("recover", "loss", "a finite number", got, remedy))
        return loss

    def step(self) -> float:
        loss = self.loss()
        self.gradient *= self.texture.dtype.type(self.options["learning_rate"])
        with changing(self):
            self.texture -= self.gradient
            self.losses.append(loss)
            self.step_number += 1
        return loss

    def save(self, folder: Path) -> Path:
        meta = {"step": self.step_number, "points": self.digest, "options": self.options}
        rate = self.options["learning_rate"]
        history = np.array([(k, loss, rate) for k, loss in enumerate(self.losses)])
        return save_checkpoint(
            folder / FILE_NAME,
            Checkpoint(meta, {"texture": self.texture}, {}, {}, history.reshape(-1, 3)),
        )

    def load(self, folder: Path) -> None:
        """Raises IoError for a damaged checkpoint, RangeError for one of another recovery."""
        saved = load_checkpoint(folder / FILE_NAME)
        try:
            row = ((self.texture.dtype.name,), self.texture.shape)
            check_arrays("params", saved.params, {"texture": row}, {})
            step = checked_step(saved)
            check_history(saved.history, step)
            if step > self.steps or len(saved.history) != step:
                got = f"{step}, {len(saved.history)}"
                raise RangeError(message("checkpoint", "meta.step", "a loss for each step", got))
        except Error as failure:
            expected = "a checkpoint of this recovery"
            path = folder / FILE_NAME
            raise IoError(message("recover", f"{path}", expected, failure)) from failure
        if (saved.meta.get("points"), saved.meta.get("options")) != (self.digest, self.options):
            expected = "the points, colors and options of the checkpoint"
            remedy = "resume with what it was started with, or choose another folder"
            raise RangeError(message("recover", "resume", expected, "others", remedy))
        self.texture = saved.params["texture"]
        self.losses = saved.history[:, 1].tolist()
        self.step_number = step


def _digest(uv: Array, colors: Array) -> str:
    total = hashlib.blake2b(uv.tobytes(), digest_size=8)
    total.update(np.ascontiguousarray(colors).tobytes())
    return total.hexdigest()


def _unseen(uv: Array, shape: Sequence[int]) -> NDArray[np.bool_]:
    """(H, W) texels whose weights in all lookups are zero."""
    ones: NDArray[Any] = np.ones((len(uv), 1), uv.dtype)
    weights, _ = sample_backward(np.zeros((*shape, 1), uv.dtype), uv, ones)
    mask: NDArray[np.bool_] = weights[..., 0] == 0
    return mask
