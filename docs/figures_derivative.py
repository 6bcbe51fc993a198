"""Derivatives of a picture by one number each: writes docs/images/derivative.png.

`python docs/figures_derivative.py`. A room with balls of copper and glass, and how each of its
pixels changes with the red of a wall, the tint of the glass and the roughness of the copper.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.transport import PathTracer, builtin_scene, derivative_image
from photograd_course.color import srgb_encode
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
IMAGES = Path(__file__).with_name("images")
SIZE, SPP = 128, 96
WALL, TINT, ROUGHNESS = (
    "materials.red.albedo[0]",
    "materials.glass.tint",
    "materials.copper.roughness",
)


def derivatives(size: int = SIZE, spp: int = SPP) -> tuple[Array, dict[str, Array]]:
    """The picture (H, W, 3) linear, and {parameter: its derivative, channels summed (H, W)}."""
    tracer = PathTracer(builtin_scene("cornell-spheres", size))
    picture = np.zeros(0)
    found: dict[str, Array] = {}
    for parameter in (WALL, TINT, ROUGHNESS):
        sums, derivative = derivative_image(tracer, parameter, spp=spp, seed=1)
        picture, found[parameter] = sums.mean, derivative.mean.sum(axis=2)
    return picture, found


def derivative_figure() -> Figure:
    """The picture and three derivatives, each on a scale of its own."""
    side, gap, left = 2.0, 0.15, 0.15
    picture, found = derivatives()
    with style.house_style():
        figure = style.new_figure(4 * side + 3 * gap + 2 * left, 3.3)
        axes = style.place_axes(figure, left, 0.35, side, side)
        axes.imshow(srgb_encode(np.clip(picture, 0.0, 1.0)))
        axes.set_title("the picture")
        axes.axis("off")
        titles = ("by the wall's red", "by the glass's tint", "by the copper's roughness")
        for column, (title, slope) in enumerate(zip(titles, found.values(), strict=True)):
            axes = style.place_axes(figure, left + (column + 1) * (side + gap), 0.35, side, side)
            limit = float(np.quantile(np.abs(slope), 0.99))
            axes.imshow(slope, norm=style.symmetric_scale(limit), cmap=style.signed_color_map())
            axes.set_title(title)
            axes.axis("off")
        style.write_caption(
            figure,
            "Each derivative is made in the pass of the picture, from the same paths; red pixels "
            "grow with the parameter, blue ones fall. More red on the wall or a clearer glass "
            "darkens nothing; glass counts where it is seen through, in its shadow and its bright "
            "patch. Rougher copper takes light from the middle of its highlights and gives it to "
            "their surroundings.",
            left=left,
            right=left,
        )
    return figure


def main() -> None:
    """Write the picture; the same bytes every time."""
    IMAGES.mkdir(exist_ok=True)
    save_figure(derivative_figure(), IMAGES / "derivative.png")


if __name__ == "__main__":
    main()
