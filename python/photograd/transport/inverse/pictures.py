"""What a recovery looks like: curves of loss and values, and its picture beside the target."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from photograd_course.color import srgb_encode
from photograd_course.viz import style
from photograd_course.viz.curves import running_mean

from photograd.transport.inverse.options import RecoveryResult
from photograd.types import Array

CHANNELS = ("#c0392b", "#2e8b57", "#2b6cb0")
LINES = ("-", "--", ":", "-.")


def display(radiance: Array) -> Array:
    """Linear radiance as a screen wants it, clipped at white."""
    return np.asarray(srgb_encode(np.clip(radiance, 0.0, 1.0)))


def curves_figure(result: RecoveryResult, truth: Mapping[str, Any] | None = None) -> Figure:
    """Loss (logarithmic) on the left, values of the parameters on the right.

    A loss below zero, which noise makes now and then, leaves a gap. Large ones are shown by the
    means of their channels. `truth` {name: value} adds thin horizontal lines.

    Args:
        result: what `recover` returned.
        truth: values that are known.
    """
    with style.house_style():
        figure = style.new_figure(7.6, 3.1)
        left = style.place_axes(figure, 0.66, 0.36, 3.0, 2.2)
        right = style.place_axes(figure, 4.36, 0.36, 3.0, 2.2)
        draw_loss(left, result.history)
        for number, (name, rows) in enumerate(result.curves.items()):
            known = None if truth is None else truth.get(name)
            draw_values(right, name, rows, LINES[number % len(LINES)], known)
        right.set_title("values")
        right.legend(loc="best", fontsize=6.0)
        for axes in (left, right):
            axes.set_xlabel("step")
            axes.grid(visible=True)
    return figure


def draw_loss(axes: Axes, history: Array) -> None:
    """Single steps faintly, their running mean on top.

    Args:
        axes: of Matplotlib.
        history: (steps, 3): step, loss, learning rate.
    """
    steps, loss = history[:, 0], history[:, 1]
    smooth = running_mean(loss)
    for values, width, alpha in ((loss, 0.6, 0.25), (smooth, 1.5, 1.0)):
        shown = np.where(values > 0, values, np.nan)
        axes.plot(steps, shown, color=style.BLUE, linewidth=width, alpha=alpha)
    axes.set_yscale("log")
    axes.set_title("loss")


def draw_values(axes: Axes, name: str, rows: Array, line: str, truth: Any = None) -> None:
    """One line a number, colored by channel where there are three.

    Args:
        axes: of Matplotlib.
        name: of the parameter.
        rows: (steps + 1, k) values.
        line: style of the lines.
        truth: value that is known, or None.
    """
    colors = CHANNELS if rows.shape[1] == 3 else ("#30363d",) * rows.shape[1]
    known = None if truth is None else np.asarray(truth, np.float64).reshape(-1)
    for k, color in enumerate(colors):
        label = name.removeprefix("materials.") if k == 0 else None
        axes.plot(rows[:, k], line, color=color, linewidth=1.2, label=label)
        if known is not None and known.size == len(colors):
            axes.axhline(known[k], color=color, linewidth=0.6, alpha=0.6)


def comparison_figure(target: Array, picture: Array) -> Figure:
    """The target, what was found, and the signed difference of the means of the channels.

    Args:
        target: (H, W, 3) linear radiance.
        picture: (H, W, 3) linear radiance.
    """
    tall, wide = target.shape[:2]
    side = 2.3
    height = side * tall / wide
    difference = (picture - target).mean(axis=2)
    limit = max(float(np.quantile(np.abs(difference), 0.99)), 1e-9)
    with style.house_style():
        figure = style.new_figure(3 * side + 0.6, height + 0.5)
        for k, (title, image) in enumerate((("target", target), ("found", picture))):
            axes = style.place_axes(figure, 0.15 + k * (side + 0.15), 0.35, side, height)
            axes.imshow(display(image))
            axes.set_title(title)
            axes.axis("off")
        axes = style.place_axes(figure, 0.45 + 2 * side, 0.35, side, height)
        axes.imshow(difference, norm=style.symmetric_scale(limit), cmap=style.signed_color_map())
        axes.set_title(f"found - target, ±{limit:.2g}")
        axes.axis("off")
    return figure
