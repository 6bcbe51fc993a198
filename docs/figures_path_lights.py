"""What a picture says about the light around it: `python docs/figures_path_lights.py`.

Writes docs/images/path_lights.png: balls under an evening sky, the same with the sun in a wrong
place, and the derivative of the difference by every texel of the sky.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.lights import EnvironmentMap
from photograd.transport import PathOptions, PathTracer, builtin_scene
from photograd.transport.builtin import SUN, evening_map, map_directions
from photograd_course.color import srgb_encode
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
IMAGES = Path(__file__).with_name("images")
SIZE, SPP, HEIGHT = 96, 192, 24
WRONG = np.array([-0.75, 0.45, 0.1])
OPTIONS = PathOptions(max_depth=8)


def display(radiance: Array) -> Array:
    """Linear radiance as a screen wants it, clipped at white."""
    return srgb_encode(np.clip(radiance, 0.0, 1.0))


def tracer_under(sun: Array, size: int) -> PathTracer:
    """The built-in evening with its sun elsewhere; a fifth of the samples go everywhere alike."""
    light = EnvironmentMap(evening_map(HEIGHT, sun), uniform_share=0.2)
    return PathTracer(replace(builtin_scene("evening", size), lights=(light,)))


def sky_gradient(size: int, spp: int) -> tuple[Array, Array, Array]:
    """Pictures under the true and the wrong sky, and dL/dtexels (H, 2 H, 3) of the wrong one.

    L is the mean of (picture - truth)^2 / (1 + truth)^2, so that highlights do not outshout the
    rest. The derivative has paths of its own.
    """
    truth, guess = tracer_under(SUN, size), tracer_under(WRONG, size)
    target = truth.render(spp=spp, seed=1, options=OPTIONS).mean
    picture = guess.render(spp=spp, seed=2, options=OPTIONS).mean
    d = 2 * (picture - target) / (1 + target) ** 2 / picture.size
    gradient = guess.render_backward(d, spp=spp, seed=3, options=OPTIONS)["lights.0.texels"]
    return target, picture, gradient


def texel_towards(direction: Array) -> tuple[int, int]:
    """Row and column of the texel whose center is closest."""
    cosines = map_directions(HEIGHT) @ (direction / np.linalg.norm(direction))
    row, column = np.unravel_index(int(cosines.argmax()), cosines.shape)
    return int(row), int(column)


def path_lights_figure() -> Figure:
    """Two pictures and two maps."""
    target, picture, gradient = sky_gradient(SIZE, SPP)
    side, gap, left, top = 2.0, 0.15, 0.15, 0.35
    with style.house_style():
        figure = style.new_figure(6 * side + 3 * gap + 2 * left, 3.0)
        for column, (title, image) in enumerate((("truth", target), ("guess", picture))):
            x = left + column * (side + gap)
            axes = style.place_axes(figure, x, top, side, side)
            axes.imshow(display(image))
            axes.set_title(title)
            axes.axis("off")
        x = left + 2 * (side + gap)
        axes = style.place_axes(figure, x, top, 2 * side, side)
        axes.imshow(display(evening_map(HEIGHT, WRONG)))
        axes.set_title("sky of the guess")
        axes.axis("off")
        axes = style.place_axes(figure, x + 2 * side + gap, top, 2 * side, side)
        summed = gradient.sum(axis=2)
        limit = float(np.quantile(np.abs(summed), 0.98))
        axes.imshow(summed, norm=style.symmetric_scale(limit), cmap=style.signed_color_map())
        for direction, marker in ((SUN, "o"), (WRONG, "x")):
            row, column = texel_towards(direction)
            axes.plot(column, row, marker, color="black", fillstyle="none", markersize=9)
        axes.set_title("derivative of the loss by its texels")
        axes.axis("off")
        style.write_caption(
            figure,
            "Balls of clay, copper and glass before an evening sky, and the same with the sun in a "
            "wrong place. Right: what the difference of the two pictures says about every texel of "
            "the sky. Where the sun should be (circle) it asks for more light (blue), where it is "
            "(cross) for less (red). What lies below the table's horizon is seen by reflections "
            "alone, and says little.",
            left=left,
            right=left,
        )
    return figure


def main() -> None:
    """Write the picture; the same bytes every time."""
    IMAGES.mkdir(exist_ok=True)
    save_figure(path_lights_figure(), IMAGES / "path_lights.png")


if __name__ == "__main__":
    main()
