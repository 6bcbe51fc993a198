"""The picture of path tracing: `python docs/figures_transport.py` writes docs/images/cornell.png.

A Cornell box, the light that a number of bounces adds, how far three ways of finding light have
come after as many samples, and what the red wall's color does to the picture.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.transport import PathOptions, PathTracer, builtin_scene
from photograd_course.color import srgb_encode
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
IMAGES = Path(__file__).with_name("images")
SIZE, SPP, FEW = 160, 64, 8
STEP = 0.02


def display(radiance: Array) -> Array:
    """Linear radiance as a screen wants it, clipped at white."""
    return srgb_encode(np.clip(radiance, 0.0, 1.0))


def picture(name: str, spp: int, **options: Any) -> Array:
    """A built-in scene, linear."""
    tracer = PathTracer(builtin_scene(name, SIZE))
    return tracer.render(spp=spp, seed=1, options=PathOptions(**options)).mean


def by_red_wall() -> Array:
    """d(sum of channels)/d(red of the left wall), by a difference on the same paths."""
    tracer = PathTracer(builtin_scene("cornell-box", SIZE))
    start = tracer.params["materials.red.albedo"].copy()
    found = []
    for step in (-STEP, STEP):
        tracer.params["materials.red.albedo"] = start + np.array([step, 0, 0], start.dtype)
        found.append(tracer.render(spp=SPP, seed=1, options=PathOptions(roulette_from=None)).mean)
    slope: Array = (found[1] - found[0]).sum(axis=2) / (2 * STEP)
    return slope


def transport_figure() -> Figure:
    """Two scenes and the bounces above; strategies and the derivative below."""
    side, gap, left = 2.0, 0.15, 0.15
    width = 4 * side + 3 * gap + 2 * left
    above = (
        ("all bounces", picture("cornell-box", SPP)),
        ("direct light", picture("cornell-box", SPP, max_depth=2)),
        (
            "added by bounces, doubled",
            2 * (picture("cornell-box", SPP) - picture("cornell-box", SPP, max_depth=2)),
        ),
        ("copper and glass", picture("cornell-spheres", 4 * SPP)),
    )
    below = tuple(
        (title, picture("cornell-spheres", FEW, strategy=strategy))
        for title, strategy in (
            (f"{FEW} samples: light sampling", "light"),
            (f"{FEW} samples: BSDF sampling", "bsdf"),
            (f"{FEW} samples: both", "mis"),
        )
    )
    with style.house_style():
        figure = style.new_figure(width, 5.6)
        for row, images in ((0.35, above), (0.35 + side + 0.4, below)):
            for column, (title, image) in enumerate(images):
                axes = style.place_axes(figure, left + column * (side + gap), row, side, side)
                axes.imshow(display(image))
                axes.set_title(title)
                axes.axis("off")
        slope = by_red_wall()
        limit = float(np.quantile(np.abs(slope), 0.99))
        axes = style.place_axes(figure, left + 3 * (side + gap), 0.35 + side + 0.4, side, side)
        scale, colors = style.symmetric_scale(limit), style.signed_color_map()
        axes.imshow(slope, norm=scale, cmap=colors)
        axes.set_title("derivative with respect to the wall's red")
        axes.axis("off")
        style.write_caption(
            figure,
            "Above: a room with one light; what one bounce alone shows; what all others add (the "
            "ceiling, and color that walls lend to boxes); a room with balls of copper and glass. "
            "Below: the same few samples spent in three ways. BSDF sampling alone does well "
            "in the copper ball's highlight alone; what only a path through glass can find (the "
            "bright patch under the ball) is noisy for all. Right: a redder wall brightens itself "
            "most, and through its light all that faces it.",
            left=left,
            right=left,
        )
    return figure


def main() -> None:
    """Write the picture; the same bytes every time."""
    IMAGES.mkdir(exist_ok=True)
    save_figure(transport_figure(), IMAGES / "cornell.png")


if __name__ == "__main__":
    main()
