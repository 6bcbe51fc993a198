"""One step of a fit that draws rays: render them, compare, differentiate."""

from __future__ import annotations

from typing import Any

from photograd.fields.octree_sh import OctreeSh
from photograd.fitting.backgrounds import (
    constant_background,
    learned_background,
    learned_background_backward,
    random_background,
)
from photograd.fitting.imaging import image_loss, image_loss_backward
from photograd.fitting.options import FitOptions
from photograd.fitting.pixels import TrainingPixels
from photograd.fitting.start import FittedGrid
from photograd.representation import RenderOptions
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
        pixels.rays(chosen), seed=options.seed, step=step,
        options=RenderOptions(stop=options.stop, jitter=True),
    )  # fmt: skip
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
