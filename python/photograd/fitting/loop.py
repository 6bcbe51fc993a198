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
from collections.abc import Callable
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from photograd_course.optim import Adam
from photograd_course.random import uniform
from photograd_course.schedules import exponential

from photograd._compiled import _core
from photograd.capture.bounds import estimate_bounds, require_views_of
from photograd.capture.capture import Capture
from photograd.fields.dense_grid import DenseGrid
from photograd.fields.dense_sh import DenseSh
from photograd.fields.octree_sh import OctreeSh
from photograd.fields.sparse_sh import SparseSh
from photograd.fitting.checkpoint import (
    FILE_NAME,
    Checkpoint,
    load_checkpoint,
    make_folder,
    save_checkpoint,
)
from photograd.fitting.checks import (
    require_background_of,
    require_finite,
    require_finite_loss,
    require_first_model,
    require_pixels_of,
    require_room_to_refine,
    require_room_to_start,
    require_split_of,
    require_startable,
)
from photograd.fitting.data import (
    TrainingPixels,
    TrainingViews,
    background_kind,
    first_background,
    raw_background,
)
from photograd.fitting.loss import decibels
from photograd.fitting.model import Model, model_of, save_snapshot, snapshot_steps
from photograd.fitting.options import FitOptions, FitResult, Pace, Progress
from photograd.fitting.start import FittedField, frozen_field, start_field
from photograd.fitting.steps import RowAdam, background_color, prune_voxels, ray_slope, view_slope
from photograd.fitting.surface_points import surface_points
from photograd.splats.model import GaussianScene
from photograd.types import Array

PRUNE_AT = 0.5  # fraction of the steps; before that, pruning goes along with refining


class Fit:
    """A fit in progress: parameters, optimiser, step number.

    `Fit.start` begins one, `Fit.resume` continues from a folder; `run` goes on until the end,
    saving a checkpoint every `checkpoint_seconds` and whenever `should_stop()` says so.
    """

    def __init__(
        self, capture: Capture, options: FitOptions, model: FittedField, background: Array | None
    ) -> None:
        """Use `start` or `resume`."""
        self.capture = capture
        self.options = options
        self.model = model
        self.background = background  # raw (3,) if learned, see photograd.fitting.data
        self.pixels = training_set(capture, model)
        method = Adam if isinstance(model, DenseGrid) else RowAdam
        self.optimiser = method(threads=max(1, _core.thread_count()))
        self.start_rule = "that of the checkpoint"
        self.background_kind = background_kind(options.background, has_alpha=capture.has_alpha)
        self.step_number = 0
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

        Gaussians may begin on the surfaces of another model; the leaves of an octree have to be cut
        from one.

        Raises RangeError for an unknown or unfit representation, or options that take more memory
        than there is; SceneError naming the training cameras that do not see the scene's box (with
        `allow_blind` only if none does).
        """
        require_startable(options.representation)
        bounds = estimate_bounds(capture)
        if not allow_blind:
            require_views_of(capture.train, bounds.box)
        require_background_of(capture, options)
        require_first_model(options.representation, given=start_from is not None)
        require_room_to_start(capture, bounds.box, options)
        model: FittedField
        if start_from is not None and options.representation == OctreeSh.name:
            model, rule = frozen_field(start_from.field, options)
        else:
            points = None
            if start_from is not None:
                points = partial(surface_points, start_from, capture, seed=options.seed)
            model, rule = start_field(capture, bounds, options, points)
        fit = cls(capture, options, model, None)
        if fit.background_kind == "learned":
            fit.background = first_background(fit.pixels.mean_color())
            if isinstance(model, OctreeSh) and start_from and start_from.background is not None:
                fit.background = raw_background(start_from.background)
        fit.start_rule = rule
        return fit

    @classmethod
    def resume(cls, capture: Capture, folder: Path) -> Fit:
        """Continue the fit that left a checkpoint in `folder`.

        Raises IoError for a missing or damaged checkpoint, RangeError if it belongs to another
        capture: other names, other images, other cameras or another size.
        """
        saved = load_checkpoint(folder)
        model = model_of(saved, folder)
        require_split_of(saved, capture)
        fit = cls(capture, model.options, model.field, saved.params.get("background"))
        require_pixels_of(saved, fit.pixels.digest)
        fit.optimiser.load_state(saved.optimiser)
        fit.step_number = int(saved.meta["step"])
        fit.history = [tuple(row) for row in saved.history.tolist()]
        return fit

    def step(self) -> float:
        """One step of gradient descent; returns the loss before it."""
        self._refine()
        loss, gradients = self.loss_and_gradients(self.draw())
        require_finite_loss(loss, self.step_number)
        self._add_prior(gradients)
        rates = self._rates()
        params = dict(self.model.params)
        if self.background is not None:
            params["background"] = self.background
        with np.errstate(over="ignore", invalid="ignore"):  # looked for where it is saved and used
            self.optimiser.step(params, gradients, rates)
        if isinstance(self.model, GaussianScene):
            self.model.explore(rates["means"], self.step_number)
        self.history.append((self.step_number, loss, self.batch_psnr))
        self.step_number += 1
        return loss

    def draw(self) -> Any:
        """What this step looks at: numbers of pixels, or of a view."""
        seed, step = self.options.seed, self.step_number
        if isinstance(self.pixels, TrainingViews):
            return self.pixels.draw(seed=seed, step=step)
        return self.pixels.draw(self.options.rays, seed=seed, step=step)

    def loss_and_gradients(self, chosen: Any) -> tuple[float, dict[str, Array]]:
        """Loss of the chosen pixels, or view, and its gradient by group, without the prior."""
        rest = (self.background, self.background_kind, self.options, self.step_number)
        model = self.model
        if isinstance(self.pixels, TrainingViews):
            assert isinstance(model, GaussianScene)
            slope = view_slope(model, self.pixels.views[chosen], *rest)
            self.batch_psnr = slope.psnr
            return slope.loss, slope.gradients
        assert not isinstance(model, GaussianScene)
        loss, gradients = ray_slope(model, self.pixels, chosen, *rest)
        self.batch_psnr = decibels(loss)
        return loss, gradients

    def background_color(self, count: int) -> Array:
        """Linear background of each ray of a batch, (R, 3) or (3,)."""
        return background_color(
            self.background,
            self.background_kind,
            count,
            seed=self.options.seed,
            step=self.step_number,
        )

    def run(
        self,
        folder: Path,
        *,
        on_step: Callable[[Progress], None] | None = None,
        should_stop: Callable[[], bool] = lambda: False,
        checkpoint_seconds: float = 30.0,
    ) -> FitResult:
        """Step until the end or until `should_stop`; the folder then holds the checkpoint.

        Raises IoError if it cannot be written, Error if the loss or a gradient is not finite; the
        last checkpoint then stays as it was.
        """
        make_folder(folder)
        began = saved = time.perf_counter()
        keep, pace = snapshot_steps(self.options), Pace(began)
        if self.step_number == 0:
            save_snapshot(folder, self.model, self.options, 0)
        while self.step_number < self.options.steps and not should_stop():
            self.step()
            if self.step_number in keep:
                require_finite(self.model.params, self.step_number)
                save_snapshot(folder, self.model, self.options, self.step_number)
            now = time.perf_counter()
            rate = pace.after(self._rays(), now)
            if on_step:
                on_step(
                    Progress(
                        self.step_number,
                        self.options.steps,
                        *self.history[-1][1:],
                        self.model.resolution,
                        rate,
                    )
                )
            if now - saved > checkpoint_seconds:
                self.save(folder)
                saved = time.perf_counter()
        self.save(folder)
        finished = self.step_number >= self.options.steps
        loss = self.history[-1][1] if self.history else float("nan")
        return FitResult(
            folder / FILE_NAME, self.step_number, finished, time.perf_counter() - began, loss
        )

    def save(self, folder: Path) -> None:
        """Write the checkpoint DIR/model.npz atomically.

        Raises IoError if there is no room, Error if a parameter is not finite: a good checkpoint is
        never replaced by a bad one.
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
            "pixels": self.pixels.digest,
            "color_space": self.capture.color_space,
        }
        history = np.array(self.history, np.float64).reshape(-1, 3)
        save_checkpoint(
            folder / FILE_NAME,
            Checkpoint(meta, params, self.optimiser.state(), self.model.state(), history),
        )

    def _rates(self) -> dict[str, float]:
        """Learning rate of every group at this step."""
        options, scene = self.options, isinstance(self.model, GaussianScene)
        fall, fall_of_means = (
            options.learning_rate * exponential(final, options.steps)(self.step_number)
            for final in (options.final_rate, options.final_mean_rate)
        )
        rates = {
            name: spec.learning_rate * (fall_of_means if scene and name == "means" else fall)
            for name, spec in self.model.param_groups().items()
        }
        return rates | {"background": 0.02 * fall}

    def _rays(self) -> int:
        """Pixels a step, on average."""
        if isinstance(self.pixels, TrainingViews):
            return self.pixels.mean_size()
        return self.options.rays

    def _refine(self) -> None:
        """Change the resolution, or the Gaussians, where the schedule says so.

        The optimiser's moments go along.
        """
        if isinstance(self.model, OctreeSh):
            return
        if isinstance(self.model, GaussianScene):
            self._refine_gaussians(self.model)
            return
        if self.step_number == int(PRUNE_AT * self.options.steps):
            self._prune()
        size = self.options.levels().get(self.step_number)
        if size is None or size == self.model.resolution:
            return
        self._prune()
        before: Any = self.model
        require_room_to_refine(before, size)
        after = before.refined(size, steps_per_voxel=self.options.steps_per_voxel)
        for group in before.params:
            self.optimiser.resample(group, lambda moment: before.resampled(moment, after))
        self.model = after

    def _refine_gaussians(self, scene: GaussianScene) -> None:
        """Draw higher harmonics, and whatever the density control decides."""
        scene.active_degree = self.options.active_degree(self.step_number)
        rows = scene.refine(self.step_number, {})
        if rows is None:
            return
        self.optimiser.apply_row_map(rows, scene.params)

    def _prune(self) -> None:
        """Drop voxels of a sparse grid that no view needs, and that do not want density."""
        if not isinstance(self.model, SparseSh) or isinstance(self.model, DenseSh):
            return
        if self.options.prune == 0:
            return
        assert isinstance(self.pixels, TrainingPixels)
        rows = prune_voxels(
            self.model,
            self.pixels,
            self.loss_and_gradients,
            threshold=self.options.prune,
            step=self.step_number,
        )
        if rows is not None:
            self.optimiser.apply_row_map(rows, self.model.params)

    def _add_prior(self, gradients: dict[str, Array]) -> None:
        """Total variation on a random part of the grid, which stands for the whole."""
        weight = self.options.total_variation
        if weight == 0 or isinstance(self.model, GaussianScene | OctreeSh):
            return
        u = uniform(self.options.seed, step=self.step_number, pixel=0, sample=2, dimension=0)
        self.model.add_prior(gradients, weight, float(u))


def training_set(capture: Capture, model: FittedField) -> TrainingPixels | TrainingViews:
    """The photographs in the form that the model learns from."""
    if isinstance(model, GaussianScene):
        return TrainingViews(capture.train)
    return TrainingPixels(capture.train, capture.color_space)
