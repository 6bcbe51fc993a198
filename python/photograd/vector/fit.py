"""Fitting drawings to pictures: control points, widths and colors by gradient descent.

    L = mean of (C_rgb - picture)^2, with C over an opaque background

A step draws the whole picture; there are no random samples, so that the loss falls smoothly and
differs between two steps by what was moved alone.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
from photograd_course.optim import Adam
from photograd_course.random import uniform
from photograd_course.schedules import exponential

from photograd._arrays import Arguments
from photograd._checkpoint import (
    Checkpoint,
    check_arrays,
    check_history,
    check_optimizer,
    checked_step,
    load_checkpoint,
    save_checkpoint,
)
from photograd._checks import require_bounds
from photograd._compiled import _core
from photograd._descend import Progress, Run, changing, descend, progress_bar, run_folder
from photograd._typed import typed_call
from photograd.errors import RangeError, message
from photograd.types import Array, FloatArray
from photograd.vector.drawing import Drawing, DrawingParameters
from photograd.vector.flatten import Flattening
from photograd.vector.picture import Rendering
from photograd.vector.shapes import LARGEST, Shape, Solid, Stroke, Subpath, check_choice

CurveKind = Literal["stroke", "fill"]
CURVE_KINDS: tuple[CurveKind, ...] = get_args(CurveKind)
MAX_CURVES = 1 << 20
DRAWING_FILE = "drawing.npz"
WHITE = (1.0, 1.0, 1.0)
NARROWEST = 0.25
"""Pixels: a stroke that became narrower would have no gradient to grow by."""
RATES = {
    "points": "point_rate",
    "widths": "width_rate",
    "geometry": "point_rate",
    "opacities": "color_rate",
    "offsets": "color_rate",
    "colors": "color_rate",
}
"""The option that is the learning rate of each group of numbers."""


@typed_call
@dataclass(frozen=True)
class VectorFitOptions:
    """How a drawing is fitted.

    Attributes:
        steps: of gradient descent.
        point_rate: learning rate of control points and of the geometry of gradients, in pixels.
        width_rate: of widths of strokes, in pixels.
        color_rate: of colors, opacities and offsets.
        final_rate: factor on all rates at the last step; they fall exponentially.
        seed: of random curves.
    """

    steps: int = 300
    point_rate: float = 0.6
    width_rate: float = 0.1
    color_rate: float = 0.02
    final_rate: float = 0.1
    seed: int = 0

    def __post_init__(self) -> None:
        """Raises DtypeError or RangeError for values that make no fit."""
        require_bounds(self, "steps", low=1, high=1 << 30)
        require_bounds(self, "point_rate", "width_rate", "color_rate", "final_rate", above=0)
        require_bounds(self, "seed", low=0, high=(1 << 63) - 1)


@typed_call
@dataclass(frozen=True, eq=False)
class FittedDrawing:
    """A drawing that was fitted to a picture.

    Attributes:
        drawing: what it became.
        image: (H, W, 3) float64, drawn over the background.
        losses: (steps,) mean squared error before each step.
        loss: of `image`.
        finished: False if it was stopped before its last step.
        seconds: that this run took.
    """

    drawing: Drawing
    image: FloatArray
    losses: FloatArray
    loss: float
    finished: bool
    seconds: float


@typed_call
def fit_drawing(
    drawing: Drawing,
    picture: Array,
    options: VectorFitOptions | None = None,
    *,
    groups: Sequence[str] = ("points", "widths", "colors"),
    background: Sequence[float] = WHITE,
    flattening: Flattening | None = None,
    folder: str | Path | None = None,
    resume: bool = False,
    bar: bool = False,
    should_stop: Callable[[], bool] = lambda: False,
    checkpoint_seconds: float = 30.0,
) -> FittedDrawing:
    """Fit numbers of a drawing to a picture.

    Args:
        drawing: to start with.
        picture: (H, W, 3); composited are the numbers as they are, so colors become what the
            picture's are: linear values, or display values as viewers of SVG composite them.
        options: of the descent.
        groups: fields of `DrawingParameters` that are fitted; the others are held.
        background: (3,) opaque color behind the drawing.
        flattening: of curves; None takes the defaults.
        folder: for the checkpoint, DIR/drawing.npz, written on the way and at the end.
        resume: go on from that checkpoint, to the same bits as without interruption.
        bar: show progress on stderr.
        should_stop: asked before each step.
        checkpoint_seconds: between two checkpoints.

    Raises:
        DtypeError, ShapeError, RangeError: no such picture, unknown groups, a checkpoint of another
            fit, or a folder that holds one without `resume`.
        IoError: a checkpoint that cannot be written, or is not there to resume from.
    """
    call = Arguments("fit_drawing", np.float64)
    picture = call.array("picture", picture, ("H", "W", 3), min_length=1)
    behind = call.array("background", background, (3,))
    for group in groups:
        check_choice("fit_drawing", "groups", group, list(RATES))
    job = VectorFit(
        drawing, picture, behind, options or VectorFitOptions(), tuple(groups), flattening
    )
    checkpoints = None if folder is None else Path(folder)
    with run_folder("fit_drawing", checkpoints, DRAWING_FILE, resume=resume):
        if resume and checkpoints is not None:
            job.load(checkpoints)
        with progress_bar("vectorize", job, shown=bar) as on_step:

            def after_step(now: float) -> None:
                del now
                if on_step:
                    on_step(Progress(job.step_number, job.steps, job.losses[-1]))

            return descend(
                job,
                checkpoints,
                job.result,
                after_step=after_step,
                should_stop=should_stop,
                checkpoint_seconds=checkpoint_seconds,
            )


@typed_call
def fit_curves(
    picture: Array,
    count: int = 200,
    options: VectorFitOptions | None = None,
    *,
    kind: CurveKind = "stroke",
    background: Sequence[float] | None = None,
    folder: str | Path | None = None,
    resume: bool = False,
    bar: bool = False,
    should_stop: Callable[[], bool] = lambda: False,
    checkpoint_seconds: float = 30.0,
) -> FittedDrawing:
    """Fit random curves to a picture [Li2020].

    Args:
        picture: (H, W, 3), as for `fit_drawing`.
        count: of curves.
        options: of the descent, and the seed of the curves.
        kind: "stroke" takes cubic curves with a width, "fill" closed shapes of four cubic curves.
        background: (3,) behind the curves; None takes the mean color of the picture.
        folder, resume, bar, should_stop, checkpoint_seconds: as for `fit_drawing`.

    Raises:
        DtypeError, ShapeError, RangeError, IoError: as of `fit_drawing`; no curves.
    """
    call = Arguments("fit_curves", np.float64)
    picture = call.array("picture", picture, ("H", "W", 3), min_length=1)
    call.integer("count", count, low=1, high=MAX_CURVES)
    check_choice("fit_curves", "kind", kind, CURVE_KINDS)
    options = options or VectorFitOptions()
    return fit_drawing(
        random_curves(picture, count, kind=kind, seed=options.seed),
        picture,
        options,
        background=picture.mean(axis=(0, 1)) if background is None else background,
        folder=folder,
        resume=resume,
        bar=bar,
        should_stop=should_stop,
        checkpoint_seconds=checkpoint_seconds,
    )


@typed_call
def random_curves(picture: FloatArray, count: int, *, kind: CurveKind, seed: int) -> Drawing:
    """Curves all over a picture in the colors that it has there, large ones at the bottom.

    Args:
        picture: (H, W, 3).
        count: of curves.
        kind: as for `fit_curves`.
        seed: of their places and forms.

    Raises:
        DtypeError, ShapeError, RangeError: no picture, no curves or more than 2^20.
    """
    call = Arguments("random_curves", np.float64)
    picture = call.array("picture", picture, ("H", "W", 3), min_length=1)
    call.integer("count", count, low=1, high=MAX_CURVES)
    check_choice("random_curves", "kind", kind, CURVE_KINDS)
    height, width = picture.shape[:2]
    u = np.stack([uniform(seed, pixel=np.arange(count), dimension=d) for d in range(26)], axis=1)
    size = np.linspace(0.3, 0.05, count) * max(height, width)
    centers = u[:, :2] * [width, height]
    row, column = (centers[:, i].astype(np.int64) for i in (1, 0))
    colors = np.clip(picture[row, column], 0, 1)
    shapes = []
    for k in range(count):
        moves = (u[k, 2:].reshape(12, 2) - 0.5) * size[k]
        if kind == "stroke":
            path = Subpath(centers[k] + moves[:4] * 1.5, (3,))
            stroke = Stroke(max(0.2 * size[k], 1.0), "round", "round")
            shapes.append(Shape((path,), Solid(colors[k], 0.8), stroke=stroke))
        else:
            ring = Subpath.circle(centers[k], 0.4 * size[k])
            points = ring.points + 0.3 * moves
            shapes.append(Shape((Subpath(points, ring.degrees, True),), Solid(colors[k], 0.8)))
    return Drawing.of(shapes)


class VectorFit:
    """Gradient descent of a drawing, as `descend` drives it."""

    def __init__(
        self,
        drawing: Drawing,
        picture: FloatArray,
        background: Array,
        options: VectorFitOptions,
        groups: tuple[str, ...],
        flattening: Flattening | None,
    ) -> None:
        """Begin.

        Args:
            drawing: to start with.
            picture: (H, W, 3) float64.
            background: (3,) float64.
            options: of the descent.
            groups: fields of `DrawingParameters` that are fitted.
            flattening: of curves.
        """
        self.options, self.groups = options, groups
        self.layout = drawing.layout
        self.params = {name: a.copy() for name, a in drawing.parameters.arrays().items()}
        self.optimizer = Adam(epsilon=1e-12, threads=max(1, _core.thread_count()))
        self.step_number = 0
        self.changing = False
        self.losses: list[float] = []
        self._picture, self._flattening = picture, flattening
        self._background = np.append(background, 1.0)

    @property
    def steps(self) -> int:
        """Of the whole fit."""
        return self.options.steps

    @property
    def drawing(self) -> Drawing:
        """As it is now."""
        return Drawing(self.layout, DrawingParameters(**self.params))

    def rendering(self) -> Rendering:
        """Of the drawing as it is now."""
        size = self._picture.shape[:2]
        return Rendering(
            self.drawing, size, flattening=self._flattening, background=self._background
        )

    def step(self) -> float:
        """One step; returns the loss before it."""
        rendering = self.rendering()
        difference = rendering.picture[..., :3] - self._picture
        loss = float(np.mean(np.square(difference)))
        d_picture = np.zeros_like(rendering.picture)
        d_picture[..., :3] = 2 * difference / difference.size
        found = rendering.backward(d_picture).parameters.arrays()
        factor = exponential(self.options.final_rate, self.steps)(self.step_number)
        rates = {name: factor * getattr(self.options, RATES[name]) for name in self.groups}
        fitted = {name: self.params[name] for name in self.groups}
        with changing(self):
            self.optimizer.step(fitted, {name: found[name] for name in self.groups}, rates)
            self._hold()
            self.losses.append(loss)
            self.step_number += 1
        return loss

    def result(self, run: Run) -> FittedDrawing:
        """The drawing as it is now, compared with the picture.

        Args:
            run: that has led to it.
        """
        image = self.rendering().picture[..., :3]
        loss = float(np.mean(np.square(image - self._picture)))
        losses = np.array(self.losses)
        return FittedDrawing(self.drawing, image, losses, loss, run.finished, run.seconds)

    def _hold(self) -> None:
        """Hold numbers to where they mean something."""
        p = self.params
        for name in ("points", "geometry"):
            np.clip(p[name], -LARGEST, LARGEST, out=p[name])
        for name in ("opacities", "offsets", "colors"):
            np.clip(p[name], 0, 1, out=p[name])
        if "widths" in self.groups:
            np.clip(p["widths"], NARROWEST, LARGEST, out=p["widths"])
        for first, end in zip(self.layout.stop_begin[:-1], self.layout.stop_begin[1:], strict=True):
            if end - first > 1:
                np.maximum.accumulate(p["offsets"][first:end], out=p["offsets"][first:end])

    def save(self, folder: Path) -> Path:
        """Write the checkpoint atomically.

        Args:
            folder: for DIR/drawing.npz.

        Raises:
            IoError: the file cannot be written.
        """
        meta = {"step": self.step_number, **self._told()}
        rows = [(step, loss, 0.0) for step, loss in enumerate(self.losses)]
        history = np.array(rows, np.float64).reshape(-1, 3)
        checkpoint = Checkpoint(meta, self.params, self.optimizer.state(), {}, history)
        return save_checkpoint(folder / DRAWING_FILE, checkpoint)

    def load(self, folder: Path) -> None:
        """Take what `save` wrote.

        Args:
            folder: that `save` was given.

        Raises:
            IoError, DtypeError, ShapeError, RangeError: a damaged checkpoint, or one of another
                picture, drawing or options.
        """
        saved = load_checkpoint(folder / DRAWING_FILE)
        told = self._told()
        if {key: saved.meta.get(key) for key in told} != told:
            expected = "the picture, drawing and options of the checkpoint"
            remedy = "resume with what it was started with, or choose another folder"
            raise RangeError(message("fit_drawing", "resume", expected, "others", remedy))
        rows: dict[str, Any] = {name: (("float64",), a.shape) for name, a in self.params.items()}
        check_arrays("params", saved.params, rows, {})
        check_optimizer(saved.optimizer, saved.params)
        self.step_number = checked_step(saved)
        check_history(saved.history, self.step_number)
        self.params = saved.params
        self.optimizer.load_state(saved.optimizer)
        self.losses = saved.history[:, 1].tolist()

    def _told(self) -> dict[str, Any]:
        """What a checkpoint belongs to."""
        total = hashlib.blake2b(digest_size=8)
        for array in (self._picture, self._background, *vars(self.layout).values()):
            total.update(f"{array.shape}".encode() + np.ascontiguousarray(array).tobytes())
        return {
            "options": asdict(self.options),
            "groups": list(self.groups),
            "flattening": asdict(self._flattening or Flattening()),
            "on": total.hexdigest(),
        }
