"""Fitting a network to a picture: random pixels, mean squared error, Adam.

    L = 1 / (3 N) sum over N random pixels of |color(p_i) - picture_i|^2, on display values

The playground of encodings and networks: what takes minutes in space takes seconds here.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from photograd_course.optim import Adam
from photograd_course.random import uniform
from photograd_course.schedules import exponential

from photograd._arrays import Arguments
from photograd._checkpoint import (
    FLOAT,
    Checkpoint,
    check_arrays,
    check_history,
    check_optimizer,
    checked_step,
    load_checkpoint,
    save_checkpoint,
)
from photograd._checks import from_plain, require_bounds
from photograd._compiled import _core
from photograd._descend import Progress, Run, changing, descend, progress_bar, run_folder
from photograd._notebook import EDGE, png_of_sheet, sheet
from photograd.errors import Error, IoError, RangeError, message
from photograd.fields.neural_image import ImagePolicy, NeuralImage, pixel_centers
from photograd.fitting.loss import decibels
from photograd.fitting.steps import RowAdam
from photograd.representation import CanvasBatch, Outputs, RenderOptions
from photograd.types import Array

IMAGE_FILE = "image.npz"


@dataclass(frozen=True)
class ImageFitOptions:
    """How a neural image is fitted.

    Attributes:
        steps: of gradient descent.
        points: random pixels a step.
        learning_rate: of Adam, at the first step.
        final_rate: factor on it at the last step; it falls exponentially.
        seed: of the first parameters and of the pixels.
    """

    steps: int = 600
    points: int = 1 << 16
    learning_rate: float = 1e-2
    final_rate: float = 0.1
    seed: int = 0

    def __post_init__(self) -> None:
        """Raises DtypeError or RangeError for values that make no fit."""
        require_bounds(self, "steps", "points", low=1, high=1 << 30)
        require_bounds(self, "learning_rate", "final_rate", above=0)
        require_bounds(self, "seed", low=0, high=(1 << 63) - 1)


@dataclass(frozen=True, eq=False)
class FittedImage:
    """A network that was fitted to a picture.

    Attributes:
        field: the network; `field.image(height, width)` draws it at any size.
        picture: (H, W, 3) what it was fitted to, display values.
        image: (H, W, 3) what it became, held to [0, 1].
        psnr: of `image`, in dB.
        losses: (steps,) float64, of the pixels of each step.
        finished: False if it was stopped before its last step.
        seconds: that this run took.
    """

    field: NeuralImage
    picture: Array
    image: Array
    psnr: float
    losses: Array
    finished: bool
    seconds: float

    @property
    def size(self) -> int:
        """Bytes of the parameters."""
        return sum(values.nbytes for values in self.field.params.values())

    def _repr_png_(self) -> bytes:
        """Picture, fit, and their difference, gray where there is none."""
        difference = 0.5 + 0.5 * (self.image - self.picture).astype(np.float64)
        shown = [self.picture.astype(np.float64), self.image.astype(np.float64), difference]
        return png_of_sheet(sheet(shown, 3, EDGE // 3))


def fit_image(
    picture: Array,
    policy: ImagePolicy | None = None,
    options: ImageFitOptions | None = None,
    *,
    folder: str | Path | None = None,
    resume: bool = False,
    bar: bool = False,
    should_stop: Callable[[], bool] = lambda: False,
) -> FittedImage:
    """Fit a network to a picture.

    Args:
        picture: (H, W, 3) display values in [0, 1], as `read_image(path).rgba[..., :3]` has them.
        policy: encoding and sizes.
        options: of the descent.
        folder: for the checkpoint, DIR/image.npz, written every 30 s and at the end.
        resume: go on from that checkpoint, to the same bits as without interruption.
        bar: show progress on stderr.
        should_stop: asked before each step.

    Raises:
        DtypeError, ShapeError, RangeError: no such picture, a checkpoint of another fit, or a
            folder that holds one without `resume`.
        IoError: a checkpoint that cannot be written, or is not there to resume from.
        Error: the descent has exploded; names the layer or level. The last checkpoint stays.
    """
    checkpoints = None if folder is None else Path(folder)
    picture = Arguments("fit_image", np.float32).array(
        "picture", picture, ("H", "W", 3), min_length=1, low=0, high=1
    )
    policy = policy or ImagePolicy()
    job = ImageFit(picture, policy, options or ImageFitOptions())
    with run_folder("fit_image", checkpoints, IMAGE_FILE, resume=resume):
        if resume and checkpoints is not None:
            job.load(checkpoints)
        with progress_bar("fit", job, shown=bar) as on_step:

            def after_step(now: float) -> None:
                del now
                if on_step:
                    on_step(Progress(job.step_number, job.steps, job.losses[-1]))

            return descend(
                job, checkpoints, job.result, after_step=after_step, should_stop=should_stop
            )


class ImageFit:
    """Gradient descent of a neural image, as `descend` drives it."""

    def __init__(self, picture: Array, policy: ImagePolicy, options: ImageFitOptions) -> None:
        """Begin with random parameters.

        Args:
            picture: (H, W, 3) float32 in [0, 1].
            policy: encoding and sizes.
            options: of the descent.
        """
        self.options = options
        self.field = NeuralImage(policy, seed=options.seed)
        method = RowAdam if "table" in self.field.params else Adam
        self.optimizer = method(epsilon=1e-15, threads=max(1, _core.thread_count()))
        self.step_number = 0
        self.changing = False
        self.losses: list[float] = []
        self._height, self._width = picture.shape[:2]
        self._colors = picture.reshape(-1, 3)

    @property
    def steps(self) -> int:
        """Of the whole fit."""
        return self.options.steps

    def step(self) -> float:
        """One step; returns the loss of its pixels before it."""
        o = self.options
        u = uniform(o.seed, step=self.step_number, pixel=np.arange(o.points), sample=2)
        pixel = np.minimum((u * len(self._colors)).astype(np.int64), len(self._colors) - 1)
        points = pixel_centers(pixel, self._height, self._width)
        outputs, context = self.field.render(
            CanvasBatch(points), seed=o.seed, step=self.step_number, options=RenderOptions()
        )
        difference = outputs.color - self._colors[pixel]
        loss = float(np.mean(np.square(difference), dtype=np.float64))
        d_color = difference * np.float32(2.0 / difference.size)
        gradients = self.field.render_backward(context, Outputs(d_color))
        rate = o.learning_rate * exponential(o.final_rate, o.steps)(self.step_number)
        with changing(self):
            with np.errstate(over="ignore", invalid="ignore"):  # looked for below
                self.optimizer.step(self.field.params, gradients, dict.fromkeys(gradients, rate))
            self.field.require_bounded("fit_image")
            self.losses.append(loss)
            self.step_number += 1
        return loss

    def result(self, run: Run) -> FittedImage:
        """The network as it is now, beside the picture.

        Args:
            run: that has led to it.
        """
        picture = self._colors.reshape(self._height, self._width, 3)
        image = np.clip(self.field.image(self._height, self._width), 0, 1)
        psnr = decibels(float(np.mean(np.square(image - picture), dtype=np.float64)))
        losses = np.array(self.losses)
        return FittedImage(self.field, picture, image, psnr, losses, run.finished, run.seconds)

    def save(self, folder: Path) -> Path:
        """Write DIR/image.npz atomically.

        Args:
            folder: DIR, which exists.
        """
        meta = {
            "step": self.step_number,
            "policy": asdict(self.field.policy),
            "options": asdict(self.options),
            "picture": self._digest(),
        }
        rows = [(step, loss, decibels(loss)) for step, loss in enumerate(self.losses)]
        history = np.array(rows, np.float64).reshape(-1, 3)
        return save_checkpoint(
            folder / IMAGE_FILE,
            Checkpoint(meta, self.field.params, self.optimizer.state(), {}, history),
        )

    def load(self, folder: Path) -> None:
        """Take what `save` wrote.

        Args:
            folder: that `save` was given.

        Raises:
            IoError: a damaged checkpoint.
            RangeError: one of another picture, policy or options.
        """
        saved = load_checkpoint(folder / IMAGE_FILE)
        told = {"policy": asdict(self.field.policy), "options": asdict(self.options)}
        if {key: saved.meta.get(key) for key in told} | {
            "picture": saved.meta.get("picture")
        } != told | {"picture": self._digest()}:
            expected = "the picture, policy and options of the checkpoint"
            remedy = "resume with what it was started with, or choose another folder"
            raise RangeError(message("fit_image", "resume", expected, "others", remedy))
        self.field = neural_image_of(saved, folder / IMAGE_FILE)
        check_optimizer(saved.optimizer, saved.params)
        self.optimizer.load_state(saved.optimizer)
        self.step_number = checked_step(saved)
        self.losses = saved.history[:, 1].tolist()

    def _digest(self) -> str:
        total = hashlib.blake2b(f"{self._height}x{self._width}".encode(), digest_size=8)
        total.update(self._colors.tobytes())
        return total.hexdigest()


def load_neural_image(path: str | Path) -> NeuralImage:
    """The network that `fit_image`, or `photograd fit` of a picture, left.

    Args:
        path: the folder, or the file image.npz in it.

    Raises:
        IoError: a missing or damaged checkpoint.
    """
    path = Path(path)
    file = path / IMAGE_FILE if path.is_dir() else path
    return neural_image_of(load_checkpoint(file), file)


def neural_image_of(saved: Checkpoint, file: Path) -> NeuralImage:
    """The network of a checkpoint; raises IoError for one of something else.

    Args:
        saved: its contents.
        file: where it lies, for errors.
    """
    try:
        field = NeuralImage(from_plain("checkpoint", ImagePolicy, saved.meta.get("policy")))
        rows: dict[str, Any] = {
            name: (FLOAT, values.shape) for name, values in field.params.items()
        }
        check_arrays("params", saved.params, rows, {})
        check_history(saved.history, checked_step(saved))
    except Error as failure:
        expected = "a checkpoint of a picture's fit"
        raise IoError(message("load_neural_image", f"{file}", expected, failure)) from failure
    return NeuralImage(field.policy, saved.params)
