"""Figure 1 of the handout, by your functions: a picture, and what its caption claims."""

import numpy as np
from matplotlib.figure import Figure
from photograd_course.viz.style import signed_color_map


def _draw(picture, photograph, gradient):
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


def pictures():
    """(image, photograph, where): two spots of light; beyond a circle both are exactly zero."""
    rows, columns = np.mgrid[0:54, 0:72]
    photograph = np.exp(-((columns - 45.0) ** 2 + (rows - 25.5) ** 2) / 200.0)
    picture = np.exp(-((columns - 28.5) ** 2 + (rows - 30.0) ** 2) / 200.0)
    far = np.hypot(columns - 36, rows - 27) > 33
    photograph[far] = picture[far] = 0.0
    return picture, photograph, far


def draw(module):
    """An image, the photograph, and the derivative of the loss with respect to each pixel."""
    picture, photograph, far = pictures()
    gradient = module.loss_gradient(picture, photograph)
    bright, dark = picture > photograph, picture < photograph
    claims = {
        "positive where the picture is too bright": (gradient[bright] > 0).all(),
        "negative where it is too dark": (gradient[dark] < 0).all(),
        "zero where both agree": (gradient[far] == 0).all() and far.sum() > 50,
    }
    return _draw(picture, photograph, gradient), claims
