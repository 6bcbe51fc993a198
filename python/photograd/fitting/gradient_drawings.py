"""Pictures of the gradient of Gaussians: where they are pulled, which get denser, which split."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import EllipseCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from photograd_course.viz import style
from photograd_course.viz.scale import nice_limit, signed_scale

from photograd.fitting.view_gradients import ViewGradients
from photograd.types import Array

PANEL, GAP, LEFT, TOP = 2.3, 0.14, 0.75, 0.62  # inches
BAR = 1.05  # room of a color bar beside its panel
ARROWS = 350
ELLIPSES = 4000
LONGEST = 0.08  # of the picture's width: the arrow at the 98th percentile

CAPTION = (
    "Arrows: where lower loss would take the most pulled means; lengths have the scale of their "
    "row. Ellipses: the derivative with respect to opacity, one standard deviation wide; blue: "
    "more lowers the loss, red: less does. Positional gradient: |dL/d mean| on the screen, "
    "averaged over the pictures; the line is where a Gaussian is cloned or split."
)


def draw_gaussian_gradients(
    rows: Mapping[int, tuple[ViewGradients, Array]], *, threshold: float, title: str | None = None
) -> Figure:
    """Three panels for each step: arrows of the means, opacity's derivative, grad2d.

    Args:
        rows: {step: gradients, grad2d (H, W) as `grad2d_picture` draws it}.
        threshold: grad2d above which Gaussians are cloned or split.
        title: above everything.
    """
    first = next(iter(rows.values()))[0]
    height = PANEL * first.picture.shape[0] / first.picture.shape[1]
    frame = _frame(first)
    width = LEFT + 3 * PANEL + GAP + 2 * BAR
    bottom = style.caption_height(CAPTION, width - LEFT - 0.1) + 0.05
    with style.house_style():
        figure = style.new_figure(width, TOP + len(rows) * (height + GAP) + bottom)
        for k, (step, (found, grad2d)) in enumerate(rows.items()):
            top = TOP + k * (height + GAP)
            left = LEFT
            axes = _panel(figure, left, top, height, found.picture)
            axes.set_ylabel(f"step {step}\nloss {found.loss:.3g}")
            draw_arrows(axes, found)
            left += PANEL + GAP
            middle = _panel(figure, left, top, height, found.picture)
            bar = (left + PANEL + 0.06, top, 0.1, height)
            _ellipses(figure, middle, found, bar)
            left += PANEL + BAR
            last = _panel(figure, left, top, height, None)
            _grad2d(figure, last, grad2d, threshold, (left + PANEL + 0.06, top, 0.1, height))
            for panel in (axes, middle, last):
                panel.set(xlim=frame[:2], ylim=frame[2:])
            if k == 0:
                for panel, name in (
                    (axes, "means"),
                    (middle, "opacity"),
                    (last, "positional gradient"),
                ):
                    panel.set_title(name)
        style.write_title(figure, title, left=LEFT)
        style.write_caption(figure, CAPTION, left=LEFT, right=0.1)
    return figure


def _panel(figure: Figure, left: float, top: float, height: float, picture: Array | None) -> Axes:
    """Axes in pixels, with the picture paled so that marks stand out."""
    axes = style.place_axes(figure, left, top, PANEL, height)
    if picture is None:
        axes.set(xticks=[], yticks=[])
    else:
        draw_picture(axes, picture, pale=True)
    return axes


def draw_picture(axes: Axes, picture: Array, *, pale: bool) -> None:
    """A picture (H, W, 3) of display values in axes that count its pixels; pale ones bear marks."""
    shown = np.clip(picture, 0, 1)
    height, width = picture.shape[:2]
    axes.imshow(0.55 + 0.45 * shown if pale else shown, extent=(0, width, height, 0))
    axes.set(xticks=[], yticks=[])


def _frame(found: ViewGradients) -> tuple[float, float, float, float]:
    """What of the picture is shown: x from, to, y from (below), to; its shape is the picture's."""
    height, width = found.picture.shape[:2]
    visible = found.pixels[found.visible]
    if not len(visible):
        return 0.0, float(width), float(height), 0.0
    low, high = np.quantile(visible, [0.01, 0.99], axis=0)
    zoom = min(1.0, 1.45 * float(((high - low) / [width, height]).max()) + 0.02)
    half = 0.5 * zoom * np.array([width, height])
    middle = np.clip((low + high) / 2, half, np.array([width, height]) - half)
    (left, up), (right, down) = middle - half, middle + half
    return float(left), float(right), float(down), float(up)


def draw_arrows(axes: Axes, found: ViewGradients) -> None:
    """Downhill, for the most pulled Gaussians of this view.

    Args:
        axes: of Matplotlib, in pixels of the view.
        found: of the view.
    """
    strength = np.hypot(found.screen[:, 0], found.screen[:, 1])
    strength = np.where(found.visible, strength, 0)
    rows = np.argsort(-strength, kind="stable")[:ARROWS]
    rows = rows[strength[rows] > 0]
    if not len(rows):
        return
    scale = LONGEST * found.picture.shape[1] / float(np.quantile(strength[rows], 0.98))
    way = -found.screen[rows] * scale
    length = np.maximum(np.hypot(*way.T), 1e-12)
    way *= np.minimum(1, 1.5 * LONGEST * found.picture.shape[1] / length)[:, None]
    axes.quiver(
        *found.pixels[rows].T,
        *way.T,
        color=style.ORANGE,
        angles="xy",
        scale_units="xy",
        scale=1,
        width=0.006,
        headwidth=4,
        headlength=4.5,
        headaxislength=4,
    )


def _ellipses(
    figure: Figure, axes: Axes, found: ViewGradients, bar: tuple[float, float, float, float]
) -> None:
    """One standard deviation of each Gaussian of this view, the strongest wishes on top."""
    wish = np.where(found.visible, found.d_logit, 0)
    rows = np.argsort(np.abs(wish), kind="stable")[-ELLIPSES:]
    rows = rows[wish[rows] != 0]
    limits = signed_scale("draw_gaussian_gradients", [wish], None, quantile=0.98)
    scale = style.symmetric_scale(limits.limit)
    sizes, axes_of = np.linalg.eigh(found.spread[rows])
    angle = np.degrees(np.arctan2(axes_of[:, 1, 1], axes_of[:, 0, 1]))
    drawn = EllipseCollection(
        2 * np.sqrt(np.maximum(sizes[:, 1], 0.05)),
        2 * np.sqrt(np.maximum(sizes[:, 0], 0.05)),
        angle,
        units="xy",
        offsets=found.pixels[rows],
        transOffset=axes.transData,
        cmap=style.signed_color_map(),
        norm=scale,
        linewidths=0,
        alpha=0.75,
    )
    drawn.set_array(wish[rows])
    axes.add_collection(drawn)
    shades = ScalarMappable(scale, style.signed_color_map())
    style.color_bar(figure, bar, shades, r"$\partial L\,/\,\partial$ logit", extend=limits.extend)


def _grad2d(
    figure: Figure,
    axes: Axes,
    grad2d: Array,
    threshold: float,
    bar: tuple[float, float, float, float],
) -> None:
    """The map, and the line at the threshold."""
    top = nice_limit(float(np.quantile(grad2d, 0.995)))
    extent = (0, grad2d.shape[1], grad2d.shape[0], 0)
    axes.imshow(grad2d, extent=extent, cmap=style.MAGNITUDE_MAP, norm=Normalize(0, top))
    if grad2d.min() < threshold < grad2d.max():
        across, down = (np.arange(n) + 0.5 for n in grad2d.shape[::-1])
        axes.contour(across, down, grad2d, levels=[threshold], colors="white", linewidths=0.6)
    shades = ScalarMappable(Normalize(0, top), style.MAGNITUDE_MAP)
    style.color_bar(figure, bar, shades, "positional gradient", extend="max")
