"""How a fit went: loss (logarithmic) and PSNR over the steps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike, NDArray

from ..errors import RangeError, ShapeError, message
from . import style

WIDTH, PANEL_WIDTH, PANEL_HEIGHT, LEFT, TOP, GAP, BELOW = 7.6, 3.05, 2.15, 0.66, 0.36, 0.7, 0.46


@dataclass(frozen=True)
class FitCurves:
    """What is drawn: sequences of equal length, paired with the steps they were taken at."""

    steps: ArrayLike  # step numbers, increasing
    loss: ArrayLike  # training loss at those steps, positive
    psnr: ArrayLike | None = None  # training PSNR at those steps, dB
    test_steps: ArrayLike = ()  # steps at which the held-out views were rendered
    test_psnr: ArrayLike = ()  # their PSNR, dB
    events: Mapping[int, str] = field(default_factory=dict)  # step -> a word, e.g. "64³"


def fit_curves(
    curves: FitCurves, *, title: str | None = None, caption: str | None = None
) -> Figure:
    """Two panels: loss on a logarithmic axis, and PSNR in dB with the held-out views as markers.

    Single steps are drawn faintly, since each sees other rays; the strong line is their running
    geometric mean (loss) or mean (PSNR) over a fiftieth of the fit. Dotted lines mark the events.

    Raises:
        ShapeError: sequences of different length, or empty ones.
        RangeError: steps that do not increase, a loss that is not positive, non-finite values.
    """
    steps, loss = _pair("steps", curves.steps, "loss", curves.loss)
    if steps.size == 0:
        raise ShapeError(message("fit_curves", "steps", "at least one step", "none"))
    if not (loss > 0.0).all():
        raise RangeError(message("fit_curves", "loss", "positive values", float(loss.min())))
    test_steps, test_psnr = _pair("test_steps", curves.test_steps, "test_psnr", curves.test_psnr)

    with style.house_style():
        head = 0.26 if title else 0.0
        height = head + TOP + PANEL_HEIGHT + BELOW + style.caption_height(caption, WIDTH - 0.24)
        figure = style.new_figure(WIDTH, height)
        left = style.place_axes(figure, LEFT, head + TOP, PANEL_WIDTH, PANEL_HEIGHT)
        right = style.place_axes(
            figure, LEFT + PANEL_WIDTH + GAP, head + TOP, PANEL_WIDTH, PANEL_HEIGHT
        )
        left.set_yscale("log")
        _line(left, steps, loss, np.exp(running_mean(np.log(loss))), "training rays")
        left.set_title("loss")
        if curves.psnr is not None:
            _, psnr = _pair("steps", curves.steps, "psnr", curves.psnr)
            _line(right, steps, psnr, running_mean(psnr), "training rays")
        if test_steps.size:
            _markers(right, test_steps, test_psnr)
        right.set_title("PSNR [dB]")
        right.yaxis.set_major_locator(MaxNLocator(nbins=6, steps=[1, 2, 5, 10]))
        for axes in (left, right):
            _finish(axes, steps, curves.events)
        if right.get_legend_handles_labels()[0]:
            right.legend(loc="lower right")
        style.write_title(figure, title, left=0.12)
        style.write_caption(figure, caption, left=0.12, right=0.12)
    return figure


def running_mean(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Centered mean over a window of a fiftieth of the values (at least 1), shorter at the ends."""
    half = values.size // 100
    total = np.concatenate([[0.0], np.cumsum(values)])
    start = np.maximum(np.arange(values.size) - half, 0)
    stop = np.minimum(np.arange(values.size) + half + 1, values.size)
    return np.asarray((total[stop] - total[start]) / (stop - start))


def _pair(
    steps_name: str, steps: ArrayLike, name: str, values: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    x, y = np.asarray(steps, dtype=np.float64), np.asarray(values, dtype=np.float64)
    if x.ndim != 1 or x.shape != y.shape:
        expected = f"as many values as {steps_name}, {x.shape}"
        raise ShapeError(message("fit_curves", name, expected, y.shape))
    if not (np.isfinite(x).all() and np.isfinite(y).all()):
        raise RangeError(message("fit_curves", name, "finite values", "some that are not"))
    if (np.diff(x) <= 0.0).any():
        raise RangeError(message("fit_curves", steps_name, "increasing steps", "some that are not"))
    return x, y


def _line(
    axes: Axes,
    steps: NDArray[np.float64],
    values: NDArray[np.float64],
    smooth: NDArray[np.float64],
    label: str,
) -> None:
    axes.plot(steps, values, color=style.BLUE, linewidth=0.6, alpha=0.25)
    axes.plot(steps, smooth, color=style.BLUE, label=label)


def _markers(axes: Axes, steps: NDArray[np.float64], psnr: NDArray[np.float64]) -> None:
    axes.plot(
        steps,
        psnr,
        color=style.ORANGE,
        linewidth=1.0,
        marker="o",
        markersize=4.5,
        markeredgecolor="white",
        markeredgewidth=0.7,
        label="held-out views",
        zorder=4,
    )
    axes.annotate(
        f"{psnr[-1]:.2f}",
        (float(steps[-1]), float(psnr[-1])),
        xytext=(0, -13),
        textcoords="offset points",
        ha="right",
        fontsize=style.SMALL_SIZE,
        color=style.ORANGE,
    )


def _finish(axes: Axes, steps: NDArray[np.float64], events: Mapping[int, str]) -> None:
    axes.set_xlabel("step")
    span = max(float(steps[-1] - steps[0]), 1.0)
    axes.set_xlim(float(steps[0]) - 0.01 * span, float(steps[0]) + 1.04 * span)
    axes.xaxis.set_major_locator(MaxNLocator(nbins=5, integer=True))
    axes.grid(visible=True)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    for step, word in sorted(events.items()):
        axes.axvline(step, color=style.GRAY, linewidth=0.8, linestyle=":")
        axes.annotate(
            word,
            (step, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(3, -2),
            textcoords="offset points",
            va="top",
            fontsize=style.SMALL_SIZE,
            color=style.GUIDE,
        )
