"""One step of a fit, on rays or on whole views: loss, gradients, and Adam by rows.

`RowAdam` has the formula of photograd_course.optim.Adam; a row whose gradient is zero throughout is
left alone, as if the gradient had been given as (rows, values) without it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from photograd_course.color import srgb_encode, srgb_encode_backward
from photograd_course.optim import Adam, Gradient
from photograd_course.portable_math import integer_power
from photograd_course.random import uniform

from photograd._compiled import _core
from photograd._fit_options import FitOptions
from photograd.capture.capture import Capture
from photograd.fitting.data import (
    TrainingPixels,
    TrainingViews,
    constant_background,
    learned_background,
    learned_background_backward,
    random_background,
)
from photograd.fitting.loss import (
    decibels,
    image_loss,
    image_loss_backward,
    picture_loss,
    picture_loss_backward,
)
from photograd.representation import Fittable, ImageBatch, RenderOptions
from photograd.types import Array


@dataclass(frozen=True)
class Background:
    """What stands behind the scene: `kind` "random", "white", "black" or "learned".

    `raw` (3,) is the parameter of a learned one, see `photograd.fitting.data`.
    """

    raw: Array | None
    kind: str


@dataclass(frozen=True, eq=False)
class LossAndGrad:
    """Loss of a batch, PSNR of its values in dB, gradient of each group, without grids' prior."""

    loss: float
    psnr: float
    gradients: dict[str, Array]


class PixelBatches(TrainingPixels):
    """Random pixels of all views, for fields that render rays."""

    def loss_and_grad(
        self, field: Fittable, chosen: Any, background: Background, options: FitOptions, step: int
    ) -> LossAndGrad:
        """Mean squared error of the chosen pixels.

        Args:
            field: what is fitted.
            chosen: pixel numbers, as `draw` returns them.
            background: behind the scene.
            options: of the fit.
            step: its number, for random numbers.
        """
        outputs, context = field.render(
            self.rays(chosen),
            seed=options.seed,
            step=step,
            options=RenderOptions(stop=options.stop, jitter=True, keep_samples=True),
        )
        behind = background_color(background, len(chosen), seed=options.seed, step=step)
        display = self.color_space == "display"
        loss = image_loss(outputs, self.premultiplied[chosen], behind, display=display)
        d_outputs, d_background = image_loss_backward(loss)
        gradients: dict[str, Any] = dict(field.render_backward(context, d_outputs))
        field.observe(context, gradients)
        if background.raw is not None:
            gradients["background"] = learned_background_backward(background.raw, d_background)
        return LossAndGrad(loss.value, decibels(loss.value), gradients)


class ViewBatches(TrainingViews):
    """One view at a time, for what is drawn a picture at a time."""

    def loss_and_grad(
        self, field: Fittable, chosen: Any, background: Background, options: FitOptions, step: int
    ) -> LossAndGrad:
        """Absolute error and SSIM of one view.

        Args:
            field: what is fitted.
            chosen: number of a view, as `draw` returns it.
            background: behind the scene.
            options: of the fit.
            step: its number, for random numbers.
        """
        view = self.views[chosen]
        behind = display_background(background, seed=options.seed, step=step)
        outputs, context = field.render(
            ImageBatch(view.camera),
            seed=options.seed,
            step=step,
            options=RenderOptions(stop=options.stop),
        )
        loss = picture_loss(outputs, view, behind, ssim_weight=options.ssim_weight)
        d_outputs, d_background = picture_loss_backward(loss)
        gradients: dict[str, Any] = dict(field.render_backward(context, d_outputs))
        field.observe(context, gradients)
        if background.raw is not None:
            color = learned_background(background.raw)
            d_linear = srgb_encode_backward(color, d_background)
            gradients["background"] = learned_background_backward(background.raw, d_linear)
        return LossAndGrad(loss.value, decibels(loss.mean_square), gradients)


def training_data(capture: Capture, field: Fittable) -> PixelBatches | ViewBatches:
    """The photographs in the form that a field learns from.

    Args:
        capture: whose training views are taken.
        field: its capabilities decide whether pixels or whole views are drawn.
    """
    if "rays" in field.capabilities:
        return PixelBatches(capture.train, capture.color_space)
    return ViewBatches(capture.train)


def background_color(background: Background, count: int, *, seed: int, step: int) -> Array:
    """Linear background of each ray of a batch, (R, 3) or (3,).

    Random ones are a function of the seed and the step.

    Args:
        background: kind, and the parameter of a learned one.
        count: R, how many rays.
        seed: of the fit.
        step: of the fit.
    """
    if background.raw is not None:
        return learned_background(background.raw)
    if background.kind == "random":
        return random_background(count, seed=seed, step=step)
    return constant_background(background.kind)


def display_background(background: Background, *, seed: int, step: int) -> Array:
    """Display color (3,) behind a picture; a random one is a function of the seed and the step.

    Args:
        background: kind, and the parameter of a learned one.
        seed: of the fit.
        step: of the fit.
    """
    if background.raw is not None:
        found: Array = srgb_encode(learned_background(background.raw))
        return found
    if background.kind == "random":
        return uniform(seed, step=step, pixel=np.arange(3), sample=1).astype(np.float32)
    return constant_background(background.kind)


# Adam for parameters of which a step touches few rows, in one pass of the core.


class RowAdam(Adam):
    """Adam that updates only rows with a gradient; state and checks are those of Adam."""

    def _step_group(self, name: str, parameter: Array, gradient: Gradient, rate: float) -> None:
        if isinstance(gradient, tuple) or parameter.ndim < 1 or not parameter.flags.c_contiguous:
            super()._step_group(name, parameter, gradient, rate)
            return
        if name not in self._moments:
            self._moments[name] = {slot: np.zeros_like(parameter) for slot in self.slots}
            self._steps[name] = 0
        self._steps[name] += 1
        step = self._steps[name]
        root = math.sqrt(1.0 - integer_power(self.beta_2, step))
        length = rate * root / (1.0 - integer_power(self.beta_1, step))
        p, g, mean, mean_square = (
            a.reshape(len(a), -1)
            for a in (
                parameter,
                np.ascontiguousarray(gradient),
                *(self._moments[name][slot] for slot in self.slots),
            )
        )
        numbers = [self.beta_1, self.beta_2, length, self.epsilon * root]
        _core.sparse_adam(p, g, mean, mean_square, numbers)
