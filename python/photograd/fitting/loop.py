"""The fit: render random rays or a random view, compare with the photographs, step downhill.

    rays, truth   = pixels drawn by (seed, step); a whole view for what is splatted
    image         = render(rays), over a background
    loss          = mean squared error on display-encoded values (linear for linear captures);
                    absolute error and SSIM for whole views
    gradient      = render_backward(d_loss), plus the prior's
    parameters   -= Adam step

Every random number is a function of (seed, step), and everything else that a step depends on is in
the checkpoint: a resumed run ends with the same bits as an uninterrupted one.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from photograd_course.optim import Adam
from photograd_course.random import uniform
from photograd_course.schedules import exponential
from photograd_course.suggest import choose_from

from photograd._checkpoint import FILE_NAME, Checkpoint, load_checkpoint, save_checkpoint
from photograd._checks import require_instance
from photograd._compiled import _core
from photograd._descend import Run, changing, descend
from photograd._fit_options import FitOptions
from photograd.capture.baseline import baseline_warning
from photograd.capture.bounds import estimate_bounds, require_views_of
from photograd.capture.capture import Capture
from photograd.errors import RangeError, message
from photograd.fields import fittable
from photograd.fitting.checks import (
    require_background_of,
    require_finite,
    require_finite_loss,
    require_first_model,
    require_pixels_of,
    require_room_to_start,
    require_split_of,
    require_startable,
)
from photograd.fitting.data import (
    background_kind,
    first_background,
    learned_background,
    raw_background,
)
from photograd.fitting.drawing import field_html
from photograd.fitting.model import Model, model_of, save_snapshot, snapshot_steps
from photograd.fitting.options import FitResult, Pace, Progress
from photograd.fitting.steps import Background, RowAdam, training_data
from photograd.fitting.surface_points import surface_points
from photograd.representation import Fittable, RayBatch, Start
from photograd.types import Array


class Fit:
    """A fit in progress: parameters, optimizer, step number.

    `Fit.start` begins one, `Fit.resume` continues from a folder; `run` goes on until the end,
    saving a checkpoint every `checkpoint_seconds` and whenever `should_stop()` says so.

    Attributes:
        capture: the photographs.
        options: of the fit.
        model: the field as it is now, a representation; `load_model` makes a `Model` of what `run`
            saved.
        background: (3,) parameter of a learned background, or None.
        step_number: how many steps were done.
        history: (step, loss, PSNR of the batch in dB) of each.
    """

    def __init__(
        self, capture: Capture, options: FitOptions, model: Fittable, background: Array | None
    ) -> None:
        """Use `start` or `resume`.

        Args:
            capture: the photographs.
            options: of the fit.
            model: the field at the first step.
            background: (3,) parameter of a learned background, or None.
        """
        self.capture = capture
        self.options = options
        self.model = model
        self.background = background  # raw (3,) if learned, see photograd.fitting.data
        self.data = training_data(capture, model)
        method = RowAdam if model.row_updates else Adam
        self.optimizer = method(threads=max(1, _core.thread_count()))
        self.start_rule = "that of the checkpoint"
        self.background_kind = background_kind(options.background, has_alpha=capture.has_alpha)
        self.step_number = 0
        self.changing = False
        self.batch_psnr = float("nan")  # dB, of the last step's pixels
        self.history: list[tuple[float, float, float]] = []

    @classmethod
    def start(
        cls,
        capture: Capture,
        options: FitOptions,
        *,
        allow_blind: bool = False,
        start_from: Model | None = None,
    ) -> Fit:
        """Begin from nearly empty space, or with what `start_from` shows.

        A UserWarning says if the training cameras stand so close together that depth is uncertain,
        see `photograd.capture.baseline`; not if the fit has to start from another model.

        Args:
            capture: the photographs.
            options: of the fit; `options_for` has those of a representation. Grids begin coarse:
                see `FitOptions`.
            allow_blind: accept training cameras that do not see the scene's box, if any does.
            start_from: another model: Gaussians may begin on its surfaces, the leaves of an octree
                have to be cut from one, and a textured mesh needs one with its mesh.

        Raises:
            DtypeError: no `Capture`, or no `FitOptions`.
            RangeError: an unknown representation, or one that no capture can start; options that
                take more memory than there is.
            SceneError: training cameras that do not see the scene's box; names them.
        """
        require_instance("Fit.start", "capture", capture, Capture, "load_capture reads one")
        require_instance("Fit.start", "options", options, FitOptions)
        require_startable(options.representation)
        bounds = estimate_bounds(capture)
        if not allow_blind:
            require_views_of(capture.train, bounds.box)
        require_background_of(capture, options)
        require_first_model(options.representation, given=start_from is not None)
        require_room_to_start(capture, bounds.box, options)
        points = None
        if start_from is not None:
            points = partial(surface_points, start_from, capture, seed=options.seed)
        kind = fittable()[options.representation]
        narrow = baseline_warning(capture.train, bounds.box)
        if narrow and kind.first_model != "required":
            warnings.warn(narrow, UserWarning, stacklevel=2)
        first = None if start_from is None else start_from.field
        model, rule = kind.start(Start(capture, bounds, options, first, points))
        fit = cls(capture, options, model, None)
        if fit.background_kind == "learned":
            fit.background = first_background(fit.data.mean_color())
            if kind.keeps_background and start_from and start_from.background is not None:
                fit.background = raw_background(start_from.background)
        fit.start_rule = rule
        return fit

    @classmethod
    def resume(cls, capture: Capture, folder: str | Path) -> Fit:
        """Continue the fit that left a checkpoint in a folder.

        Args:
            capture: that the fit was started on.
            folder: that `run` was given.

        Raises:
            IoError: a missing or damaged checkpoint.
            RangeError: one of another capture: other names, images, cameras or another size.
        """
        saved = load_checkpoint(folder)
        model = model_of(saved, Path(folder))
        require_split_of(saved, capture)
        fit = cls(capture, model.options, model.field, saved.params.get("background"))
        require_pixels_of(saved, fit.data.digest)
        fit.optimizer.load_state(saved.optimizer)
        fit.step_number = int(saved.meta["step"])
        fit.history = [tuple(row) for row in saved.history.tolist()]
        return fit

    def _repr_html_(self) -> str:
        """How far it is, and a picture of the field."""
        behind = None if self.background is None else learned_background(self.background)
        facts: dict[str, object] = {"step": f"{self.step_number} of {self.options.steps}"}
        if self.history:
            facts["loss"] = f"{self.history[-1][1]:.3g}"
        return field_html("Fit", self.model, behind, facts)

    @property
    def steps(self) -> int:
        """Of the whole fit."""
        return self.options.steps

    def step(self) -> float:
        """One step of gradient descent; returns the loss before it."""
        with changing(self):
            self.model = self.model.adapted(self)
            return self._descended()

    def _descended(self) -> float:
        loss, gradients = self.loss_and_gradients(self.draw())
        require_finite_loss(loss, self.step_number)
        self._add_prior(gradients)
        rates = self._rates()
        params = dict(self.model.params)
        if self.background is not None:
            params["background"] = self.background
        with np.errstate(over="ignore", invalid="ignore"):  # looked for where it is saved and used
            self.optimizer.step(params, gradients, rates)
        self.model.after_step(rates, self.step_number)
        self.history.append((self.step_number, loss, self.batch_psnr))
        self.step_number += 1
        return loss

    def draw(self) -> Any:
        """What this step looks at: numbers of pixels, or of a view."""
        options = self.options
        return self.data.draw(options.rays, seed=options.seed, step=self.step_number)

    def loss_and_gradients(self, chosen: Any) -> tuple[float, dict[str, Array]]:
        """Loss of the chosen pixels, or view, and the gradient of each group, without the prior.

        Args:
            chosen: what `draw` returned.
        """
        behind = Background(self.background, self.background_kind)
        found = self.data.loss_and_grad(self.model, chosen, behind, self.options, self.step_number)
        self.batch_psnr = found.psnr
        return found.loss, found.gradients

    def batches(self, max_rays: int) -> Iterator[RayBatch]:
        """Rays of all training views, evenly spaced, at most about `max_rays`.

        Args:
            max_rays: about so many in all.
        """
        return self.data.batches(max_rays)

    def mean_gradient(self, group: str, max_rays: int) -> Array:
        """dL/d params[group] of the loss over all training views, from about `max_rays` rays.

        Args:
            group: of `model.params`, or "background" where one is learned.
            max_rays: evenly spaced over the views; more rays, lower variance.

        Returns:
            An array of the shape of the parameter.

        Raises:
            RangeError: no group of that name; names the nearest, or all.
        """
        known = [*self.model.params, *(["background"] if self.background is not None else [])]
        if group not in known:
            expected, remedy = "a group of parameters", choose_from(group, known)
            raise RangeError(message("Fit.mean_gradient", "group", expected, repr(group), remedy))
        parts = self.data.spread(max_rays)
        return np.asarray(sum(w * self.loss_and_gradients(rows)[1][group] for rows, w in parts))

    def run(
        self,
        folder: str | Path,
        *,
        on_step: Callable[[Progress], None] | None = None,
        should_stop: Callable[[], bool] = lambda: False,
        checkpoint_seconds: float = 30.0,
    ) -> FitResult:
        """Step until the end or until `should_stop`; the folder then holds the checkpoint.

        Args:
            folder: for the checkpoint, model.npz, and for snapshots of some steps.
            on_step: called after each step.
            should_stop: asked after each step; True saves and ends the run.
            checkpoint_seconds: between two checkpoints.

        Returns:
            Where the checkpoint lies, and how far the fit came.

        Raises:
            IoError: the checkpoint cannot be written.
            Error: the loss or a gradient is not finite; the last checkpoint stays as it was.
            BaseException: what `on_step` raises, and KeyboardInterrupt, once the checkpoint is
                written; `partial_result` of the exception is what would have been returned.
        """
        folder = Path(folder)
        keep, pace = snapshot_steps(self.options), Pace(time.perf_counter())
        if self.step_number == 0:
            save_snapshot(folder, self.model, self.options, 0)

        def after_step(now: float) -> None:
            rate = pace.after(self.data.size_of(self.options.rays), now)
            if self.step_number in keep:
                require_finite(self.model.params, self.step_number)
                save_snapshot(folder, self.model, self.options, self.step_number)
            if on_step:
                last = self.history[-1][1:]
                size = self.model.resolution
                on_step(Progress(self.step_number, self.options.steps, *last, size, rate))

        def result(run: Run) -> FitResult:
            loss = self.history[-1][1] if self.history else float("nan")
            return FitResult(folder / FILE_NAME, self.step_number, run.finished, run.seconds, loss)

        return descend(
            self,
            folder,
            result,
            after_step=after_step,
            should_stop=should_stop,
            checkpoint_seconds=checkpoint_seconds,
        )

    def save(self, folder: str | Path) -> Path:
        """Write the checkpoint DIR/model.npz atomically.

        Raises IoError if there is no room, Error if a parameter is not finite: a good checkpoint is
        never replaced by a bad one.

        Args:
            folder: DIR, which exists.
        """
        require_finite(self.model.params, self.step_number)
        params = dict(self.model.params)
        if self.background is not None:
            params["background"] = self.background
        meta = {
            "step": self.step_number,
            "options": asdict(self.options),
            "policy": asdict(self.model.policy),
            "capture": str(self.capture.source),
            "split": self.capture.split_hash(),
            "pixels": self.data.digest,
            "color_space": self.capture.color_space,
        }
        history = np.array(self.history, np.float64).reshape(-1, 3)
        return save_checkpoint(
            Path(folder) / FILE_NAME,
            Checkpoint(meta, params, self.optimizer.state(), self.model.state(), history),
        )

    def _rates(self) -> dict[str, float]:
        """Learning rate of every group at this step."""
        options = self.options
        fall = options.learning_rate * exponential(options.final_rate, options.steps)(
            self.step_number
        )
        return self.model.learning_rates(options, self.step_number) | {"background": 0.02 * fall}

    def _add_prior(self, gradients: dict[str, Array]) -> None:
        """Total variation on a random part of the grid, which stands for the whole."""
        weight = self.options.total_variation
        if weight == 0:
            return
        u = uniform(self.options.seed, step=self.step_number, pixel=0, sample=2, dimension=0)
        self.model.add_prior(gradients, weight, float(u))
