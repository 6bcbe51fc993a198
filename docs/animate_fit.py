"""The animation of a fit: `python docs/animate_fit.py` writes docs/images/fit.gif.

Left the density, right what the loss asks of it, in one slice, from nearly transparent space on.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from figures_octree import BOX, IMAGES, outline_balls, photographs
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.fields import DenseGrid
from photograd.fitting.data import TrainingPixels, random_background
from photograd.fitting.loss import image_loss, image_loss_backward
from photograd.fitting.voxel_gradients import density_gradient
from photograd.representation import RenderOptions
from photograd_course.optim import Adam
from photograd_course.viz import style, write_gif

Array = NDArray[Any]
RESOLUTION, STEPS, EVERY, RAYS = 48, 120, 6, 4096
PANEL = 2.6  # inches
OPAQUE = 40.0  # 1/m: a voxel of 4 cm lets a fifth of the light through


def step(field: DenseGrid, pixels: TrainingPixels, optimizer: Adam, number: int) -> None:
    """One step of gradient descent on random rays over random backgrounds."""
    chosen = pixels.draw(RAYS, seed=0, step=number)
    outputs, context = field.render(
        pixels.rays(chosen), seed=0, step=number, options=RenderOptions(jitter=True)
    )
    behind = random_background(RAYS, seed=0, step=number)
    loss = image_loss(outputs, pixels.premultiplied[chosen], behind, display=True)
    d_outputs, _ = image_loss_backward(loss)
    rates = {name: spec.learning_rate for name, spec in field.param_groups().items()}
    optimizer.step(field.params, field.render_backward(context, d_outputs), rates)


def slices(field: DenseGrid, pixels: TrainingPixels) -> tuple[Array, Array]:
    """sigma_t and dL/dsigma_t of the middle layer, (X, Y) each."""
    middle = RESOLUTION // 2
    raw = field.density[:, :, middle].astype(np.float64)
    found = density_gradient(field, pixels, seed=1, rays=1 << 16)
    return field.policy.density_scale * np.logaddexp(0.0, raw), found.d_sigma_t[:, :, middle]


def frame(number: int, sigma_t: Array, gradient: Array) -> Figure:
    """One picture. The gradient shrinks by orders as the fit goes on: each has its own scale."""
    limit = float(np.quantile(np.abs(gradient), 0.99))
    with style.house_style():
        figure = style.new_figure(2 * PANEL + 1.75, PANEL + 0.75)
        shown = (
            (sigma_t, style.MAGNITUDE_MAP, Normalize(0.0, OPAQUE), r"$\sigma_t$  [1/m]", "max"),
            (
                gradient,
                style.signed_color_map(),
                style.symmetric_scale(limit),
                f"{style.GRADIENT} / {style.power_text(limit)}",
                "both",
            ),
        )
        for k, (values, colors, norm, label, extend) in enumerate(shown):
            left = 0.15 + k * (PANEL + 0.85)
            axes = style.place_axes(figure, left, 0.45, PANEL, PANEL)
            axes.imshow(values.T, origin="lower", extent=(-1, 1, -1, 1), cmap=colors, norm=norm)
            outline_balls(axes, 1.0 / RESOLUTION, "white" if k == 0 else style.INK, all_known=True)
            axes.set(xlim=BOX[:, 0], ylim=BOX[:, 1], xticks=[], yticks=[], aspect="equal")
            mappable = ScalarMappable(norm if k == 0 else Normalize(-1.0, 1.0), colors)
            place = (left + PANEL + 0.06, 0.45, 0.1, PANEL)
            style.color_bar(figure, place, mappable, label, extend=extend)
        style.write_title(figure, f"step {number}", left=0.15)
    return figure


def as_image(figure: Figure) -> Array:
    """(H, W, 3) in [0, 1]."""
    figure.canvas.draw()
    buffer = np.asarray(figure.canvas.buffer_rgba())  # type: ignore[attr-defined]
    image: Array = buffer[..., :3].astype(np.float32) / 255.0
    return image[::2, ::2] * 0.5 + image[1::2, 1::2] * 0.5


def main(path: Path = IMAGES / "fit.gif") -> None:
    """Fit, and draw every few steps; the same bytes every time."""
    pixels = photographs(96)
    field, optimizer = DenseGrid.empty(BOX, RESOLUTION, sigma_t=0.1), Adam()
    frames = []
    for number in range(STEPS + 1):
        if number % EVERY == 0:
            frames.append(as_image(frame(number, *slices(field, pixels))))
        step(field, pixels, optimizer, number)
    path.parent.mkdir(exist_ok=True)
    write_gif(frames + [frames[-1]] * 5, path, frames_per_second=4)


if __name__ == "__main__":
    main()
