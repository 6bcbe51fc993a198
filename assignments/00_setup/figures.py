"""The figure of assignment 00, and the facts its caption claims."""

from __future__ import annotations

from types import ModuleType

import numpy as np
from matplotlib.figure import Figure
from photograd_course.viz.handout import Fact, figures_of
from photograd_course.viz.style import signed_color_map


def fig1_gradient(module: ModuleType) -> tuple[Figure, dict[str, bool]]:
    """An image, the photograph, and the derivative of the loss with respect to each pixel."""
    rows, columns = np.mgrid[0:54, 0:72]
    photograph = np.exp(-((columns - 45.0) ** 2 + (rows - 25.5) ** 2) / 200.0)
    picture = np.exp(-((columns - 28.5) ** 2 + (rows - 30.0) ** 2) / 200.0)
    far = np.hypot(columns - 36, rows - 27) > 33
    photograph[far] = picture[far] = 0.0
    gradient = module.loss_gradient(picture, photograph)
    bright, dark = picture > photograph, picture < photograph
    facts = {
        "positive where the picture is too bright": Fact((gradient[bright] > 0).all()),
        "negative where it is too dark": Fact((gradient[dark] < 0).all()),
        "zero where both agree": Fact((gradient[far] == 0).all() and far.sum() > 50),
    }
    return _draw(picture, photograph, gradient), facts


def _draw(picture: np.ndarray, photograph: np.ndarray, gradient: np.ndarray) -> Figure:
    figure = Figure(figsize=(7.0, 2.2), layout="constrained")
    top = float(np.abs(gradient).max())
    panels = [
        ("image p", picture, "gray", 0.0, 1.0),
        ("photograph q", photograph, "gray", 0.0, 1.0),
        (r"$\partial L\,/\,\partial p$", gradient, signed_color_map(), -top, top),
    ]
    for k, (title, values, colors, low, high) in enumerate(panels):
        axes = figure.add_subplot(1, 3, k + 1)
        image = axes.imshow(values, cmap=colors, vmin=low, vmax=high, interpolation="nearest")
        axes.set_title(title)
        axes.set_xticks([])
        axes.set_yticks([])
    bar = figure.colorbar(image, ax=figure.axes, shrink=0.85, ticks=[-top, 0, top])
    bar.ax.set_yticklabels(["too dark", "0", "too bright"])
    return figure


FIGURES = figures_of(fig1_gradient)
RED = {"fig1_gradient": "sign"}
