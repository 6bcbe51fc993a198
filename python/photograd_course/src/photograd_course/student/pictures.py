"""A picture of a wrong array: yours, what it should be, and the difference, on shared scales."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from ..grading.outcome import Outcome
from ..viz.style import INK, house_style, save_figure, signed_color_map

Array = np.ndarray[Any, np.dtype[np.float64]]


def draw_failure(outcome: Outcome, folder: Path) -> Path | None:
    """Draw the arrays of a failed check to `folder/check_<id>.png`; None if there are none."""
    if outcome.arrays is None:
        return None
    got, expected = (np.asarray(array, np.float64) for array in outcome.arrays)
    if got.ndim == 0 or got.size < 3:
        return None
    with house_style():
        flat = got.squeeze().ndim < 2
        figure = _lines(got, expected) if flat else _planes(got, expected)
        where = "" if flat else slice_name(got.shape, worst_index(got, expected))
        title = textwrap.wrap(f"{outcome.id}: {outcome.title}{where}", 80)
        figure.suptitle("\n".join(title), fontsize=9)
        return save_figure(figure, picture_path(outcome, folder))


def remove_picture(outcome: Outcome, folder: Path) -> None:
    """Remove what an earlier run has drawn of this check."""
    picture_path(outcome, folder).unlink(missing_ok=True)


def picture_path(outcome: Outcome, folder: Path) -> Path:
    """Where the picture of a check lies."""
    return folder / f"check_{outcome.id}.png"


def _lines(got: Array, expected: Array) -> Figure:
    figure = Figure(figsize=(6.0, 3.0), layout="constrained")
    axes = figure.add_subplot()
    # Points: neighbors need have nothing to do with one another.
    axes.plot(expected.ravel(), "o", color="0.6", markersize=8, label="expected")
    axes.plot(got.ravel(), "o", color="C0", markersize=3.5, label="yours")
    axes.set(xlabel="index", ylabel="value")
    axes.locator_params(axis="x", integer=True)
    axes.legend()
    return figure


def _planes(got: Array, expected: Array) -> Figure:
    worst = worst_index(got, expected)
    axes_shown = _drawn(got.shape)
    cut = tuple(slice(None) if axis in axes_shown else at for axis, at in enumerate(worst))
    row, column = (worst[axis] for axis in axes_shown)
    shown = [array[cut] for array in (got, expected, got - expected)]
    top = max(float(np.abs(plane).max()) for plane in shown[:2]) or 1.0
    figure = Figure(figsize=(7.5, 2.8), layout="constrained")
    for k, (plane, name) in enumerate(zip(shown, ("yours", "expected", "difference"), strict=True)):
        axes = figure.add_subplot(1, 3, k + 1)
        image = axes.imshow(
            plane, cmap=signed_color_map(), vmin=-top, vmax=top, interpolation="nearest"
        )
        frame = Rectangle((column - 0.5, row - 0.5), 1, 1, fill=False, edgecolor=INK, linewidth=1.5)
        axes.add_patch(frame)  # the entry that the message names
        axes.set_title(name, fontsize=9)
        axes.set_xlabel(f"axis {axes_shown[1]}")
        axes.locator_params(integer=True)
    figure.axes[0].set_ylabel(f"axis {axes_shown[0]}")
    figure.colorbar(image, ax=figure.axes, shrink=0.8)
    return figure


def worst_index(got: Array, expected: Array) -> tuple[int, ...]:
    """The entry that is furthest off; what is not finite is."""
    off = np.nan_to_num(np.abs(got - expected), nan=np.inf)
    return tuple(int(i) for i in np.unravel_index(int(np.argmax(off)), off.shape))


def slice_name(shape: tuple[int, ...], worst: tuple[int, ...]) -> str:
    """Which slice is drawn, as in " (slice [:, :, 1, 0])"; nothing where it is the whole array."""
    if sum(n > 1 for n in shape) <= 2:
        return ""
    at = [":" if axis in _drawn(shape) else str(i) for axis, i in enumerate(worst)]
    return f" (slice [{', '.join(at)}])"


def _drawn(shape: tuple[int, ...]) -> list[int]:
    """The two axes that are drawn: the first two that are longer than 1."""
    return [axis for axis, n in enumerate(shape) if n > 1][:2]
