"""The gradient of any field, as the fit sees it: in the pixels of a view, and in every group.

d_pixel = dL/d color of a view, mean over the channels     what the photograph asks of the pixel
rms     = root mean square of dL/d p over a group, times its learning rate
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from photograd_course.viz import style
from photograd_course.viz.scale import signed_scale

from photograd._notebook import EDGE, png_of_sheet, sheet, signed_colors, smaller
from photograd.capture.capture import Capture
from photograd.fitting.data import TrainingView, TrainingViews, constant_background
from photograd.fitting.evaluate import display_image
from photograd.fitting.loss import picture_loss, picture_loss_backward
from photograd.fitting.model import Model
from photograd.fitting.options import options_for
from photograd.fitting.steps import Background, training_data
from photograd.representation import Fittable, Outputs, dense_gradient
from photograd.types import Array

MAX_RAYS = 1 << 16
PANEL, GAP, LEFT, TOP = 2.1, 0.55, 0.75, 0.62  # inches
CAPTION = (
    "Left: the first training view. Middle: the derivative of its loss with respect to each pixel; "
    "blue: brighter lowers the loss, red: darker does. Right: {image}root mean square of the "
    "derivative with respect to each group of parameters, times the group's learning rate."
)


@dataclass(frozen=True, eq=False)
class GroupGradients:
    """Of one field: its picture (H, W, 3) in display values, d_pixel (H, W), rms by group.

    `image` (h, w) is what the field shows of its parameters' gradient, or None; `gradients` has
    the derivatives themselves, in the shapes of the parameters.
    """

    picture: Array
    d_pixel: Array
    rms: dict[str, float]
    image: Array | None
    loss: float
    gradients: dict[str, Array]

    def _repr_png_(self) -> bytes:
        """The picture, the derivative with respect to its pixels, and `image` if there is one."""
        signed = [d for d in (self.d_pixel, self.image) if d is not None]
        shown = [self.picture, *(signed_colors(smaller(d)) for d in signed)]
        return png_of_sheet(sheet(shown, 3, EDGE // 2))


def group_gradients(
    model: Model, field: Fittable, capture: Capture, *, seed: int, max_rays: int = MAX_RAYS
) -> GroupGradients:
    """The gradient of the loss over all training views, from evenly spaced rays or views.

    Args:
        model: whose background and options hold.
        field: of the model, or of one of its snapshots.
        capture: the photographs.
        seed: of random numbers.
        max_rays: about so many rays, or views with so many pixels.
    """
    data = training_data(capture, field)
    options = options_for(field.name, seed=seed, ssim_weight=0.0)
    total: dict[str, Any] = {name: np.zeros(p.shape) for name, p in field.params.items()}
    loss = 0.0
    for chosen, share in data.spread(max_rays):
        found = data.loss_and_grad(field, chosen, Background(None, "white"), options, 0)
        loss += share * found.loss
        for name, parameter in field.params.items():
            total[name] += share * dense_gradient(found.gradients[name], parameter)
    rates = {name: spec.learning_rate for name, spec in field.param_groups().items()}
    rms = {name: rates[name] * float(np.sqrt(np.square(d).mean())) for name, d in total.items()}
    shown = Model(field, None, model.options, {}, model.history)
    view = TrainingViews(capture.train[:1]).views[0]
    picture = display_image(shown, view.camera)
    d_pixel, _ = pixel_gradient(picture, view)
    return GroupGradients(picture, d_pixel, rms, field.gradient_image(total), loss, total)


def pixel_gradient(picture: Array, view: TrainingView) -> tuple[Array, float]:
    """dL/d pixel (H, W), mean over the channels, of the absolute error of a picture; and the loss.

    Args:
        picture: (H, W, 3) display values, over white where the photograph has alpha.
        view: the photograph.
    """
    outputs = Outputs(picture.reshape(-1, 3), np.ones(picture[..., 0].size))
    loss = picture_loss(outputs, view, constant_background("white"), ssim_weight=0.0)
    d_outputs, _ = picture_loss_backward(loss)
    return d_outputs.color.mean(axis=1).reshape(picture.shape[:2]), loss.value


def draw_group_gradients(rows: Mapping[int, GroupGradients]) -> Figure:
    """A row of panels for each step.

    Args:
        rows: {step: gradients}.
    """
    first = next(iter(rows.values()))
    count = 3 if first.image is None else 4
    width = LEFT + count * (PANEL + GAP)
    shown = "" if first.image is None else "the derivative with respect to what is shown; "
    caption = CAPTION.format(image=shown)
    bottom = 0.35 + style.caption_height(caption, width - LEFT - 0.1)
    with style.house_style():
        figure = style.new_figure(width, TOP + len(rows) * (PANEL + GAP) + bottom)
        for k, (step, found) in enumerate(rows.items()):
            panels = (
                style.place_axes(
                    figure, LEFT + n * (PANEL + GAP), TOP + k * (PANEL + GAP), PANEL, PANEL
                )
                for n in range(count)
            )
            axes = next(panels)
            axes.imshow(np.clip(found.picture, 0, 1))
            axes.set(xticks=[], yticks=[], ylabel=f"step {step}\nloss {found.loss:.3g}")
            _signed(next(panels), found.d_pixel, "pixels")
            if found.image is not None:
                _signed(next(panels), found.image, "parameters")
            _bars(next(panels), found.rms)
        style.write_title(figure, "What the loss asks of the parameters", left=LEFT)
        style.write_caption(figure, caption, left=LEFT, right=0.1)
    return figure


def _signed(axes: Axes, values: Array, title: str) -> None:
    limits = signed_scale("draw_group_gradients", [values], None, quantile=0.995)
    scale = style.symmetric_scale(limits.limit)
    axes.imshow(values, norm=scale, cmap=style.signed_color_map(), interpolation="nearest")
    axes.set(xticks=[], yticks=[], title=title)


def _bars(axes: Axes, rms: Mapping[str, float]) -> None:
    values = [max(value, 1e-12) for value in rms.values()]
    axes.barh(list(rms), values, color=style.BLUE)
    axes.set_xscale("log")
    axes.set_title("groups")
