"""A fit as one row of gradients: `python docs/figures_steps.py`.

Writes docs/images/gradient_steps.png: the fit of docs/animate_fit.py, its middle layer. Few voxels
have many times the gradient of all others; colors therefore end at the quantile SHOWN of the
magnitudes of each step, and what is beyond has the color of the end.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from animate_fit import Adam, slices, step
from figures_octree import BOX, IMAGES, outline_balls, photographs
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.fields import DenseGrid
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
RESOLUTION, PIXELS = 48, 96
DRAWN = (0, 4, 12, 30, 60, 120)
SHOWN = 0.99
PANEL, GAP = 1.42, 0.1  # inches


def limit_of(gradient: Array) -> float:
    """The magnitude at which colors end: most voxels are below, and no single one decides it."""
    return float(np.quantile(np.abs(gradient[gradient != 0]), SHOWN))


def gradients(steps: tuple[int, ...] = DRAWN) -> dict[int, Array]:
    """{step: dL/dsigma_t (X, Y) of the middle layer}."""
    pixels = photographs(PIXELS)
    field, optimizer = DenseGrid.empty(BOX, RESOLUTION, sigma_t=0.1), Adam()
    found = {}
    for number in range(max(steps) + 1):
        if number in steps:
            found[number] = slices(field, pixels)[1]
        step(field, pixels, optimizer, number)
    return found


def steps_figure(found: dict[int, Array]) -> Figure:
    """The row."""
    left = 0.15
    with style.house_style():
        figure = style.new_figure(len(found) * (PANEL + GAP) + 1.0, PANEL + 1.15)
        for column, (number, gradient) in enumerate(found.items()):
            limit = limit_of(gradient)
            axes = style.place_axes(figure, left + column * (PANEL + GAP), 0.5, PANEL, PANEL)
            axes.imshow(
                gradient.T / limit,
                origin="lower",
                extent=(-1, 1, -1, 1),
                cmap=style.signed_color_map(),
                norm=style.symmetric_scale(1.0),
            )
            outline_balls(axes, 1.0 / RESOLUTION, style.INK, all_known=True)
            axes.set(xlim=BOX[:, 0], ylim=BOX[:, 1], xticks=[], yticks=[], aspect="equal")
            axes.set_title(f"step {number}\n\u00b1 {style.power_text(limit)}", fontsize=8)
        place = (left + len(found) * (PANEL + GAP), 0.5, 0.09, PANEL)
        mappable = ScalarMappable(Normalize(-1.0, 1.0), style.signed_color_map())
        style.color_bar(figure, place, mappable, style.GRADIENT, extend="both")
        style.write_caption(
            figure,
            f"Each step has its own scale, below its number: {100 * SHOWN:.0f} % of all voxels lie "
            "within it. Blue asks for matter, red for less. At first the circles, where the truth "
            "is, ask for matter; once they are opaque, their inside has next to none, and what is "
            "left sits at their rims.",
            left=left,
            right=left,
        )
    return figure


def main(path: Path = IMAGES / "gradient_steps.png") -> None:
    """Fit and draw; the same bytes every time."""
    save_figure(steps_figure(gradients()), path)


if __name__ == "__main__":
    main()
