"""Curves that move: docs/images/vector.png.

    pip install 'photograd[data]'  # a photograph
    python docs/figures_vector.py
    python docs/figures_vector.py photo.png  # another photograph

Above: a digit that should be bolder and elsewhere, with the gradient of the loss at each control
point; the width of its pen, recovered; the error of polylines over the number of their segments.
Below: a photograph as 200 strokes.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.images import read_image
from photograd.vector import (
    Drawing,
    FittedDrawing,
    Flattening,
    Rendering,
    Shape,
    Solid,
    Stroke,
    Subpath,
    VectorFitOptions,
    fit_curves,
    fit_drawing,
)
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
PICTURE = Path(__file__).resolve().parent / "images" / "vector.png"
PANEL, GAP, LEFT = 2.35, 0.55, 0.35  # inches
SIDE, BOLD, THIN = 64, 7.0, 3.0  # pixels
WHITE = (1.0, 1.0, 1.0, 1.0)
CURVES, STEPS = 200, 400
SEGMENTS = 2 ** np.arange(1, 8)


def digit(width: float, *, shift: tuple[float, float] = (0.0, 0.0)) -> Drawing:
    """A 2, drawn with a round pen."""
    arch = np.array([[15.0, 20], [15, 6], [46, 6], [46, 22], [46, 36], [20, 42], [16, 54]])
    paths = (Subpath(arch + shift, (3, 3)), Subpath.lines(np.array([[16.0, 54], [48, 54]]) + shift))
    return Drawing.of([Shape(paths, Solid(np.zeros(3)), stroke=Stroke(width, "round", "round"))])


def picture_of(drawing: Drawing) -> Array:
    """(64, 64, 3) over white."""
    return Rendering(drawing, (SIDE, SIDE), background=WHITE).picture[..., :3]


def digit_gradient() -> dict[str, Any]:
    """A thin digit, the bold target up to the right of it, and dL/d of points and width."""
    drawing, target = digit(THIN), picture_of(digit(BOLD, shift=(3.0, -2.0)))
    rendering = Rendering(drawing, (SIDE, SIDE), background=WHITE)
    d_picture = np.zeros((SIDE, SIDE, 4))
    d_picture[..., :3] = 2 * (rendering.picture[..., :3] - target) / target.size
    found = rendering.backward(d_picture).parameters
    return {
        "picture": rendering.picture[..., 0],
        "target": target[..., 0],
        "points": drawing.parameters.points,
        "d_points": found.points,
        "d_width": float(found.widths[0]),
    }


def recovered_widths() -> dict[float, list[float]]:
    """Width after each tenth step, from several starts; everything else is held."""
    target = picture_of(digit(BOLD))
    found = {}
    for start in (1.5, 4.0, 12.0):
        drawing, widths = digit(start), [start]
        for _ in range(12):
            options = VectorFitOptions(steps=10, width_rate=0.2, final_rate=1.0)
            drawing = fit_drawing(drawing, target, options, groups=("widths",)).drawing
            widths.append(float(drawing.parameters.widths[0]))
        found[start] = widths
    return found


def polyline_errors() -> dict[str, Array]:
    """Mean error of the coverage of a cubic curve, over the number of segments."""
    path = Subpath(np.array([[6.0, 9], [70, 1], [-11, 35], [55, 54]]), (3,))
    found = {}
    for name, stroke in (("fill", None), ("stroke", Stroke(5.0, "round", "round"))):
        drawing = Drawing.of([Shape((path,), stroke=stroke)])

        def coverage(n: int, drawing: Drawing = drawing) -> Array:
            flattening = Flattening(segments=n)
            return Rendering(drawing, (SIDE, SIDE), flattening=flattening).coverage(0)

        exact = coverage(1024)
        found[name] = np.array([np.abs(coverage(int(n)) - exact).mean() for n in SEGMENTS])
    return found


def photograph() -> Array:
    """(H, W, 3) in [0, 1], at most 256 pixels wide."""
    if len(sys.argv) > 1:
        pixels = read_image(sys.argv[1])[..., :3].astype(np.float64)
    else:
        from skimage.data import chelsea

        pixels = chelsea() / 255.0
    times = -(-pixels.shape[1] // 256)
    height, width = (n // times for n in pixels.shape[:2])
    cut = pixels[: height * times, : width * times]
    return cut.reshape(height, times, width, times, 3).mean(axis=(1, 3))


def as_strokes(target: Array) -> tuple[Array, FittedDrawing]:
    """The first strokes, and what they became."""
    start = fit_curves(target, CURVES, VectorFitOptions(steps=1, point_rate=1e-9))
    return start.image, fit_curves(target, CURVES, VectorFitOptions(steps=STEPS))


def draw_arrows(axes: Axes) -> None:
    """-dL/d of control points over the two digits."""
    found = digit_gradient()
    bold, thin = 1 - found["target"][..., None], 1 - found["picture"][..., None]
    shown = np.clip(1 - bold * [0.45, 0.25, 0.05] - thin * [0.4, 0.5, 0.6], 0, 1)
    axes.imshow(shown, extent=(0, SIDE, SIDE, 0), vmin=0, vmax=1)
    at, towards = found["points"], -found["d_points"]
    longest = np.sqrt(np.square(towards).sum(axis=1)).max()
    axes.plot(*at.T, "o", color=style.INK, markersize=3)
    axes.quiver(
        *at.T,
        *towards.T,
        color=style.ORANGE,
        angles="xy",
        scale_units="xy",
        scale=longest / 13,
        width=0.012,
        zorder=3,
    )
    axes.set(xlim=(0, SIDE), ylim=(SIDE, 0), xticks=[], yticks=[])
    axes.set_title("-dL/d of control points")


def draw_widths(axes: Axes) -> None:
    """Widths over steps."""
    axes.axhline(BOLD, color=style.GRAY, linewidth=1)
    for widths in recovered_widths().values():
        axes.plot(10 * np.arange(len(widths)), widths, color=style.BLUE)
    axes.set(xlabel="step", ylim=(0, 13))
    axes.set_title("width of the pen, pixels")
    style.plain_axes(axes)


def draw_errors(axes: Axes) -> None:
    """Errors over segments, with the slope of the square."""
    found = polyline_errors()
    for (name, errors), color in zip(found.items(), (style.BLUE, style.ORANGE), strict=True):
        axes.loglog(SEGMENTS, errors, "o-", color=color, label=name, markersize=3)
    guide = found["fill"][2] * 2 * (SEGMENTS[2] / SEGMENTS) ** 2.0
    axes.loglog(SEGMENTS, guide, color=style.GRAY, linestyle="--", label="$n^{-2}$")
    axes.set_xticks([2, 8, 32, 128], ["2", "8", "32", "128"])
    axes.set(xlabel="segments $n$ of a cubic curve")
    axes.legend(loc="lower left")
    axes.set_title("error of polylines")
    style.plain_axes(axes)


def vector_figure() -> Figure:
    """Two rows: a digit, its boldness, polylines; a photograph as strokes."""
    target = photograph()
    first, fitted = as_strokes(target)
    psnr = -10 * np.log10(fitted.loss)
    step = PANEL + GAP
    height = PANEL * target.shape[0] / target.shape[1] * step / PANEL * 0.97
    with style.house_style():
        figure = style.new_figure(LEFT + 3 * step, PANEL + height + 2.1)
        for k, draw in enumerate((draw_arrows, draw_widths, draw_errors)):
            draw(style.place_axes(figure, LEFT + k * step, 0.35, PANEL, PANEL))
        panels = [
            (target, "photograph"),
            (first, f"{CURVES} strokes, step 0"),
            (fitted.image, f"step {STEPS}: {psnr:.1f} dB"),
        ]
        wide = 0.97 * step
        for k, (image, title) in enumerate(panels):
            left = 0.12 + k * step
            axes = style.place_axes(figure, left, PANEL + 1.2, wide, height)
            axes.imshow(np.clip(image, 0, 1))
            axes.set(xticks=[], yticks=[])
            axes.set_title(title)
        style.write_caption(
            figure,
            "Above: a thin digit (dark) and the bold one that it should become, up to the right of "
            "it (blue); arrows show where lower loss would take each control point. The gradient "
            "with respect to the width of the pen recovers it from any start. Curves are drawn as "
            "polylines: the error of the covered area falls with the square of their number of "
            f"segments. Below: {CURVES} random strokes, and after {STEPS} steps of descent on all "
            f"control points, widths and colors, in {fitted.seconds:.0f} s.",
            left=LEFT,
            right=0.2,
        )
    return figure


if __name__ == "__main__":
    PICTURE.parent.mkdir(exist_ok=True)
    save_figure(vector_figure(), PICTURE)
