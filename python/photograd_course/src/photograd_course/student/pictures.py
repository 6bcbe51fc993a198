"""A picture of a wrong array: yours and the right one on one scale, the difference on its own."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from ..grading.outcome import Outcome
from ..viz.scale import nice_limit
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
    figure = Figure(figsize=(6.0, 4.0), layout="constrained")
    axes, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    # Points: neighbors need have nothing to do with one another.
    axes.plot(expected.ravel(), "o", color="0.6", markersize=8, label="expected")
    axes.plot(got.ravel(), "o", color="C0", markersize=3.5, label="yours")
    axes.set_ylabel("value")
    axes.legend()
    below.axhline(0.0, color="0.8", linewidth=1.0)
    below.plot((got - expected).ravel(), "o", color="C3", markersize=3.5)
    below.set(xlabel="index", ylabel="difference")
    below.locator_params(axis="x", integer=True)
    return figure


def _planes(got: Array, expected: Array) -> Figure:
    worst = worst_index(got, expected)
    axes_shown = _drawn(got.shape)
    cut = tuple(slice(None) if axis in axes_shown else at for axis, at in enumerate(worst))
    row, column = (worst[axis] for axis in axes_shown)
    yours, right, difference = (array[cut] for array in (got, expected, got - expected))
    top, own = _limit(yours, right), _limit(difference)
    panels = (
        (yours, "yours", top),
        (right, "expected", top),
        (difference, magnified(top, own), own),
    )
    # As high as the planes are, side by side, so that nothing is cut off and no space is empty.
    rows, columns = yours.shape
    colors = signed_color_map().with_extremes(bad="0.6")  # of what is not finite
    height = float(np.clip(2.1 * rows / columns, 0.9, 4.5)) + 1.3
    figure = Figure(figsize=(9.0, height), layout="constrained")
    for k, (plane, name, limit) in enumerate(panels):
        axes = figure.add_subplot(1, 3, k + 1)
        image = axes.imshow(plane, cmap=colors, vmin=-limit, vmax=limit, interpolation="nearest")
        frame = Rectangle((column - 0.5, row - 0.5), 1, 1, fill=False, edgecolor=INK, linewidth=1.5)
        axes.add_patch(frame)  # the entry that the message names
        axes.set_title(name, fontsize=9)
        axes.set_xlabel(f"axis {axes_shown[1]}")
        axes.set_ylabel(f"axis {axes_shown[0]}" if k == 0 else "")
        axes.locator_params(integer=True)
        if k > 0:  # the first two share one
            figure.colorbar(image, ax=figure.axes[:2] if k == 1 else axes, shrink=0.9)
    return figure


def _limit(*planes: Array) -> float:
    """The end of a color scale that suits all planes; what is not finite has no color."""
    sizes = np.concatenate([np.abs(plane[np.isfinite(plane)]) for plane in planes])
    return nice_limit(float(sizes.max(initial=0.0)))


def magnified(top: float, own: float) -> str:
    """The title of a difference: by how much finer its scale is than that of the values."""
    factor = top / own
    if 0.4 < factor < 2.0:
        return "difference"
    return f"difference, magnified × {factor:,.{0 if factor >= 10 else 1}f}"


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
