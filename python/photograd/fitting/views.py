"""One step of a fit that draws whole pictures: render a view, compare, differentiate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from photograd_course.color import srgb_encode, srgb_encode_backward
from photograd_course.random import uniform

from photograd.fitting.backgrounds import (
    constant_background,
    learned_background,
    learned_background_backward,
)
from photograd.fitting.imaging import decibels
from photograd.fitting.options import FitOptions
from photograd.fitting.picture_loss import picture_loss, picture_loss_backward
from photograd.fitting.training_views import TrainingView
from photograd.representation import ImageBatch, RenderOptions
from photograd.splats.model import GaussianScene
from photograd.types import Array


@dataclass(frozen=True, eq=False)
class Slope:
    """Loss of a step, PSNR of its picture in dB, gradients by group."""

    loss: float
    psnr: float
    gradients: dict[str, Array]


def view_slope(
    scene: GaussianScene,
    view: TrainingView,
    raw_background: Array | None,
    kind: str,
    options: FitOptions,
    step: int,
) -> Slope:
    """Loss of one view and its gradients, priors of the density control included.

    `raw_background` (3,) is the parameter of a learned background, `kind` one of "random", "white",
    "black", "learned". Adds to the scene's positional gradient statistics.
    """
    behind = display_background(raw_background, kind, seed=options.seed, step=step)
    outputs, context = scene.render(
        ImageBatch(view.camera), seed=options.seed, step=step,
        options=RenderOptions(stop=options.stop),
    )  # fmt: skip
    loss = picture_loss(outputs, view, behind, ssim_weight=options.ssim_weight)
    d_outputs, d_background = picture_loss_backward(loss)
    gradients = scene.render_backward(context, d_outputs)
    scene.observe(context)
    scene.control.add_priors(scene.params, gradients, extent=scene.extent)
    if raw_background is not None:
        d_linear = srgb_encode_backward(learned_background(raw_background), d_background)
        gradients["background"] = learned_background_backward(raw_background, d_linear)
    return Slope(loss.value, decibels(loss.mean_square), gradients)


def display_background(raw: Array | None, kind: str, *, seed: int, step: int) -> Array:
    """Display colour (3,) behind a picture; a random one is a function of the seed and the step."""
    if raw is not None:
        found: Array = srgb_encode(learned_background(raw))
        return found
    if kind == "random":
        return uniform(seed, step=step, pixel=np.arange(3), sample=1).astype(np.float32)
    return constant_background(kind)
