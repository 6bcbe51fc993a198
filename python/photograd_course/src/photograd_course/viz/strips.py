"""Truth, render and error under each other, one column per view."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from numpy.typing import NDArray

from .. import metrics
from ..checks import require_mask, require_number
from ..errors import RangeError, ShapeError, message
from . import style
from .checks import check_images
from .scale import nice_limit

LEFT, TOP, GAP, HEADING, PSNR_ROOM, BAR_ROOM = 0.62, 0.08, 0.06, 0.26, 0.28, 0.9  # inches
ROOM = 6.2  # inches for all columns
WIDEST, TALLEST = 1.9, 1.9  # inches for one picture
ROWS = ("truth", "render", "error")

MaskedError: TypeAlias = "np.ma.MaskedArray[Any, Any]"
"""Mean absolute error (H, W), masked where the photograph has no pixel."""


def comparison_strips(
    truths: Sequence[NDArray[np.floating]],
    renders: Sequence[NDArray[np.floating]],
    *,
    names: Sequence[str] | None = None,
    psnr: Sequence[float] | None = None,
    valid: Sequence[NDArray[np.bool_]] | None = None,
    error_limit: float | None = None,
    title: str | None = None,
    caption: str | None = None,
) -> Figure:
    """Truth, render and error map of several views, the PSNR below each.

    The error map is the mean over the channels of |render - truth|, on one scale for all views.

    Args:
        truths: display-encoded images (H, W, 3) in [0, 1], float32 or float64; all of one size.
        renders: the same number of images of the same size.
        names: one heading per view; "view 0", "view 1", ... if None.
        psnr: numbers to print (dB), so that the figure agrees with a table made by another
            protocol; by default those of `photograd_course.metrics.psnr` over the valid pixels.
        valid: (H, W) for each view, the pixels that its photograph has; the others are gray in
            truth and error. All of them if None.
        error_limit: upper end of the error scale; by default the 99.5 % quantile, rounded up.
        title: a line above the pictures.
        caption: text below the pictures.

    Raises:
        DtypeError, ShapeError, RangeError: an argument is not as described.
    """
    function = "comparison_strips"
    true, rendered = _pairs(function, truths, renders)
    labels = [f"view {i}" for i in range(len(true))] if names is None else list(names)
    _check_count(function, "names", labels, len(true))
    views = list(zip(true, rendered, _masks(function, valid, true), strict=True))
    numbers = [_psnr(*view) for view in views] if psnr is None else psnr
    _check_count(function, "psnr", numbers, len(true))
    errors = [np.ma.array(np.abs(r - t).mean(axis=2), mask=~kept) for t, r, kept in views]
    limit = _limit(function, errors, error_limit)
    shown_truth = [np.where(kept[..., None], t, to_rgb(style.MISSING)) for t, _, kept in views]

    with style.house_style():
        figure, grid = _layout(len(true), true[0].shape[:2], 0.26 if title else 0.0, caption)
        for column, (pictures, name, number) in enumerate(
            zip(zip(shown_truth, rendered, errors, strict=True), labels, numbers, strict=True)
        ):
            shown = [
                _draw(grid[row][column], picture, limit) for row, picture in enumerate(pictures)
            ]
            grid[0][column].set_title(name)
            grid[2][column].set_xlabel(_decibels(number), labelpad=4.0)
        for row, word in enumerate(ROWS):
            grid[row][0].set_ylabel(word, fontsize=style.TITLE_SIZE, labelpad=6.0)
        clipped = any(float(error.max()) > limit for error in errors)
        style.color_bar(
            figure,
            _beside(figure, grid[2][-1]),
            shown[2],
            "mean |error|",
            extend="max" if clipped else "neither",
        )
        style.write_title(figure, title, left=0.12)
        style.write_caption(figure, caption, left=0.12, right=0.12)
    return figure


def _check_count(function: str, argument: str, given: Sequence[object], count: int) -> None:
    if len(given) != count:
        raise ShapeError(message(function, argument, f"{count} entries", len(given)))


def _pairs(
    function: str, truths: Sequence[NDArray[np.floating]], renders: Sequence[NDArray[np.floating]]
) -> tuple[list[NDArray[np.floating]], list[NDArray[np.floating]]]:
    """Both lists checked against each other: same count, one size."""
    true = check_images(function, "truths", truths)
    rendered = check_images(function, "renders", renders)
    if len(true) != len(rendered):
        raise ShapeError(message(function, "renders", f"{len(true)} images", len(rendered)))
    for argument, images in (("truths", true), ("renders", rendered)):
        for index, image in enumerate(images):
            if image.shape != true[0].shape:
                expected = f"shape {true[0].shape} as truths[0] has"
                raise ShapeError(message(function, f"{argument}[{index}]", expected, image.shape))
    return true, rendered


def _masks(
    function: str, valid: Sequence[NDArray[np.bool_]] | None, images: Sequence[NDArray[np.floating]]
) -> list[NDArray[np.bool_]]:
    """A mask (H, W) for each image, all True by default."""
    shape = images[0].shape[:2]
    if valid is None:
        return [np.ones(shape, np.bool_)] * len(images)
    _check_count(function, "valid", valid, len(images))
    for index, mask in enumerate(valid):
        if not require_mask(function, f"valid[{index}]", mask, shape).any():
            raise RangeError(message(function, f"valid[{index}]", "a valid pixel", "none"))
    return list(valid)


def _psnr(
    truth: NDArray[np.floating], render: NDArray[np.floating], valid: NDArray[np.bool_]
) -> float:
    return metrics.psnr(render.astype(np.float64), truth.astype(np.float64), valid=valid)


def _decibels(number: float) -> str:
    return "identical" if number == float("inf") else f"{number:.2f} dB"


def _limit(function: str, errors: list[MaskedError], given: float | None) -> float:
    if given is None:
        scored = np.concatenate([error.compressed() for error in errors])
        return nice_limit(float(np.quantile(scored, 0.995)))
    if require_number(function, "error_limit", given) <= 0.0:
        raise RangeError(message(function, "error_limit", "a positive number", given))
    return float(given)


def _layout(
    count: int, size: tuple[int, int], title: float, caption: str | None
) -> tuple[Figure, list[list[Axes]]]:
    """An empty figure with three rows of ``count`` axes for pictures of ``size`` (H, W)."""
    aspect = size[0] / size[1]
    width = min((ROOM - (count - 1) * GAP) / count, WIDEST, TALLEST / aspect)
    height = width * aspect
    total_width = LEFT + count * width + (count - 1) * GAP + BAR_ROOM
    top = TOP + title + HEADING
    total_height = top + 3 * height + 2 * GAP + PSNR_ROOM
    total_height += style.caption_height(caption, total_width - 0.24)
    figure = style.new_figure(total_width, total_height)
    grid = [
        [
            style.place_axes(
                figure, LEFT + column * (width + GAP), top + row * (height + GAP), width, height
            )
            for column in range(count)
        ]
        for row in range(3)
    ]
    return figure, grid


def _draw(axes: Axes, picture: NDArray[np.floating] | MaskedError, limit: float) -> AxesImage:
    """A color image as it is, or an error map in the magnitude colors, gray where masked."""
    image = axes.imshow(
        picture,
        cmap=mpl.colormaps[style.MAGNITUDE_MAP].with_extremes(bad=style.MISSING),
        vmin=0.0,
        vmax=limit,
        interpolation="nearest" if picture.ndim == 2 else "auto",  # error is not to be smoothed
        aspect="auto",  # the axes box already has the right proportions
    )
    axes.set_xticks([])
    axes.set_yticks([])
    return image


def _beside(figure: Figure, axes: Axes) -> tuple[float, float, float, float]:
    """A color bar right of ``axes``, as (left, top, width, height) in inches."""
    total_width, total_height = figure.get_size_inches()
    place = axes.get_position()
    top, height = (1.0 - place.y1) * total_height, (place.y1 - place.y0) * total_height
    return place.x1 * total_width + 0.12, top, 0.12, height
