"""The picture of path tracing: `python docs/figures_transport.py` writes docs/images/cornell.png.

A Cornell box, its direct and indirect light, three sampling strategies with equally many samples,
and the derivative of the picture with respect to the red of the left wall.
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
SIZE, SPP, FEW = 200, 128, 8
STEP = 0.02
EXPOSURE = 1.6


def display(radiance: Array) -> Array:
    """Linear radiance, brighter by EXPOSURE and clipped at white, as sRGB."""
    return srgb_encode(np.clip(EXPOSURE * radiance, 0.0, 1.0))


def picture(name: str, spp: int, **options: Any) -> Array:
    """A built-in scene, linear."""
    tracer = PathTracer(builtin_scene(name, SIZE))
    return tracer.render(spp=spp, seed=1, options=PathOptions(**options)).mean


def by_red_wall() -> Array:
    """d(sum of channels)/d(red of the left wall), by central differences on the same paths."""
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
    whole, direct = picture("cornell-box", SPP), picture("cornell-box", SPP, max_depth=2)
    above = (
        ("global illumination", whole),
        ("direct light", direct),
        ("indirect light, doubled", 2 * (whole - direct)),
        ("copper and glass", picture("cornell-spheres", 2 * SPP)),
    )
    below = tuple(
        (title, picture("cornell-spheres", FEW, strategy=strategy))
        for title, strategy in (
            (f"light sampling, {FEW} samples", "light"),
            (f"BSDF sampling, {FEW} samples", "bsdf"),
            (f"MIS of both, {FEW} samples", "mis"),
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
        axes.set_title("d picture / d red albedo")
        axes.axis("off")
        style.write_caption(
            figure,
            "Above: a Cornell box with one area light; direct light; indirect light, which reaches "
            "the ceiling and carries the walls' colors; balls of copper and glass. Below: light "
            "sampling, BSDF sampling and multiple importance sampling with 8 samples per pixel. "
            "BSDF sampling suits the copper ball's highlight; the caustic under the glass is noisy "
            "with all three. Right: the derivative with respect to the red of the left wall's "
            "albedo, positive on the wall and on all that it illuminates.",
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
