"""One step of a fit, by rays or by whole views, and what steps need: Adam by rows, pruning.

Of a sparse grid, a voxel stays if it weighs something in some pixel of some view, or if the loss
would fall for more density in it: dL/d density is below -`WANTED` times the greatest |dL/d
density|. Their neighbors stay, too. The weight alone would drop voxels that matter is about to grow
into.

`RowAdam` has the formula of photograd_course.optim.Adam; a row whose gradient is zero throughout is
left alone, as if the gradient had been given as (rows, values) without it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd_course.color import srgb_encode, srgb_encode_backward
from photograd_course.optim import Adam, Gradient
from photograd_course.portable_math import integer_power
from photograd_course.random import uniform
from photograd_course.row_map import RowMap

from photograd._compiled import _core
from photograd.fields.octree_sh import OctreeSh
from photograd.fields.sparse_sh import SparseSh
from photograd.fitting.data import (
    TrainingPixels,
    TrainingView,
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
from photograd.fitting.options import FitOptions
from photograd.fitting.start import FittedGrid
from photograd.representation import ImageBatch, RenderOptions
from photograd.splats.model import GaussianScene
from photograd.types import Array


def ray_slope(
    field: FittedGrid | OctreeSh,
    pixels: TrainingPixels,
    chosen: Array,
    raw_background: Array | None,
    kind: str,
    options: FitOptions,
    step: int,
) -> tuple[float, dict[str, Array]]:
    """Loss of the chosen pixels and its gradient by group, without the prior."""
    model: Any = field  # which takes back the context that it gave
    outputs, context = model.render(
        pixels.rays(chosen),
        seed=options.seed,
        step=step,
        options=RenderOptions(stop=options.stop, jitter=True),
    )
    display = pixels.color_space == "display"
    behind = background_color(raw_background, kind, len(chosen), seed=options.seed, step=step)
    loss = image_loss(outputs, pixels.premultiplied[chosen], behind, display=display)
    d_outputs, d_background = image_loss_backward(loss)
    gradients: dict[str, Array] = dict(model.render_backward(context, d_outputs))
    if raw_background is not None:
        gradients["background"] = learned_background_backward(raw_background, d_background)
    return loss.value, gradients


def background_color(raw: Array | None, kind: str, count: int, *, seed: int, step: int) -> Array:
    """Linear background of each ray of a batch, (R, 3) or (3,).

    Random ones are a function of the seed and the step.
    """
    if raw is not None:
        return learned_background(raw)
    if kind == "random":
        return random_background(count, seed=seed, step=step)
    return constant_background(kind)


# One step of a fit that draws whole pictures: render a view, compare, differentiate.


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
        ImageBatch(view.camera),
        seed=options.seed,
        step=step,
        options=RenderOptions(stop=options.stop),
    )
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


# Which voxels of a sparse grid a fit drops: those without weight that do not want density either.


WEIGHT_RAYS = 1 << 20
"""From all views; what they do not need is dropped."""
GRADIENT_RAYS = 1 << 17
"""From all views, for the gradient, of which a ray costs as much as two weights."""
WANTED = 0.05
"""Of the greatest |dL/d density|: below, a wish for density is noise of the photographs."""

_RAYS_AT_ONCE = 1 << 16
LossAndGradients = Callable[[NDArray[np.int64]], tuple[float, dict[str, Array]]]


def prune_voxels(
    field: SparseSh,
    pixels: TrainingPixels,
    loss_and_gradients: LossAndGradients,
    *,
    threshold: float,
    step: int,
) -> RowMap | None:
    """Drop voxels from `field` in place; returns where each row that is left came from.

    `loss_and_gradients` takes numbers of pixels; `threshold` is the weight that is enough.
    """
    weight = field.greatest_weights(pixels.batches(WEIGHT_RAYS))
    wanted = wants_density(density_gradient(pixels, loss_and_gradients))
    statistics = {"weight": weight, "threshold": np.array(threshold), "wanted": wanted}
    return field.refine(step, statistics)


def density_gradient(
    pixels: TrainingPixels, loss_and_gradients: LossAndGradients, *, most: int = GRADIENT_RAYS
) -> Array:
    """dL/d density (N,) of the loss over all views, from about `most` evenly spaced pixels."""
    chosen = np.arange(0, len(pixels), max(1, -(-len(pixels) // most)))
    starts = range(0, len(chosen), _RAYS_AT_ONCE)
    parts = (chosen[start : start + _RAYS_AT_ONCE] for start in starts)
    share = 1 / len(chosen)
    return np.asarray(
        sum(len(part) * share * loss_and_gradients(part)[1]["density"] for part in parts)
    )


def wants_density(d_density: Array) -> NDArray[np.bool_]:
    """(N,) where the loss would clearly fall for more density."""
    return np.asarray(d_density < -WANTED * np.abs(d_density).max(initial=0.0))


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
