"""A photograph out of ellipses: `python docs/figures_gaussians_2d.py` writes
docs/images/gaussians_2d.png. Asks for scikit-image, which brings the photograph.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from numpy.typing import NDArray
from photograd.fields import Gaussians2D
from photograd.fields.gaussians_2d import opacity_of
from photograd.representation import CanvasBatch, Outputs, RenderOptions
from photograd_course.metrics import psnr
from photograd_course.optim import Adam
from photograd_course.random import uniform
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
PICTURE = Path(__file__).resolve().parent / "images" / "gaussians_2d.png"
PANEL = 2.75  # inches
COUNT, STEPS, BATCH = 300, 800, 1024
EARLY = 100  # steps, after which the pull on the means is shown


def photograph(size: int = 128) -> Array:
    """An astronaut's face, (size, size, 3) display values in [0, 1]."""
    from skimage.data import astronaut

    whole = astronaut()[:256, 96:352].astype(np.float64) / 255
    side = 256 // size
    return np.asarray(whole.reshape(size, side, size, side, 3).mean(axis=(1, 3)))


def drawing(size: int = 32) -> Array:
    """A pale disc on dark blue with an orange stripe across the canvas, (size, size, 3)."""
    x, y = np.meshgrid(*2 * [(np.arange(size) + 0.5) / size])
    picture = np.tile(np.array([0.1, 0.15, 0.4]), (size, size, 1))
    picture[(x - 0.38) ** 2 + (y - 0.6) ** 2 < 0.2**2] = [0.9, 0.9, 0.8]
    picture[np.abs(0.6 * x - 0.8 * y + 0.04) < 0.05] = [0.9, 0.5, 0.1]
    return picture


def canvas(size: int) -> CanvasBatch:
    """The middles of a picture's pixels, row by row."""
    center = (np.arange(size) + 0.5) / size
    return CanvasBatch(np.stack(np.meshgrid(center, center), axis=-1).reshape(-1, 2))


def draw(field: Gaussians2D, size: int) -> Array:
    """The whole picture over black, held to [0, 1]."""
    outputs, _ = field.render(canvas(size), seed=0, step=0, options=RenderOptions())
    return np.asarray(np.clip(outputs.color, 0, 1).reshape(size, size, 3))


def fit(picture: Array, *, count: int, steps: int, batch: int, round_ones: bool = False) -> Any:
    """Recover a picture from random pixels of it, mean squared error, Adam.

    `round_ones` keeps both scales of a Gaussian equal, for comparison.
    """
    field = Gaussians2D.scattered(count, seed=1)
    rates = {name: spec.learning_rate for name, spec in field.param_groups().items()}
    adam = Adam()
    points, colors = canvas(len(picture)).points, picture.reshape(-1, 3)
    for step in range(steps):
        u = uniform(2, step=step, pixel=np.arange(batch), dimension=0)
        chosen = (u * len(points)).astype(np.int64)
        outputs, context = field.render(
            CanvasBatch(points[chosen]), seed=0, step=step, options=RenderOptions()
        )
        error = outputs.color - colors[chosen]
        gradients = field.render_backward(context, Outputs(2 * error / error.size))
        if round_ones:
            gradients["log_scale"] = np.repeat(gradients["log_scale"].sum(1, keepdims=True), 2, 1)
        decay = 0.1 ** (step / steps)  # steps ten times shorter in the end
        adam.step(field.params, gradients, {name: rate * decay for name, rate in rates.items()})
    return field


def pull(field: Gaussians2D, picture: Array) -> Array:
    """Where the mean squared error over a whole picture asks each mean to go, -dL/dm (N, 2)."""
    outputs, context = field.render(canvas(len(picture)), seed=0, step=0, options=RenderOptions())
    error = outputs.color - picture.reshape(-1, 3)
    gradients = field.render_backward(context, Outputs(2 * error / error.size))
    return np.asarray(-gradients["mean"])


def computed(
    picture: Array, *, count: int = COUNT, steps: int = STEPS, batch: int = BATCH
) -> dict[str, Any]:
    """What the figure shows.

    Returns:
        "early": the fit after a few steps, "free": in the end, "round": with round Gaussians in the
        end; each with its "field", "picture" (H, W, 3) and "psnr" in dB.
    """
    found: dict[str, Any] = {}
    for name, duration in (("early", min(EARLY, steps)), ("free", steps), ("round", steps)):
        field = fit(picture, count=count, steps=duration, batch=batch, round_ones=name == "round")
        image = draw(field, len(picture))
        found[name] = {
            "field": field,
            "picture": image,
            "psnr": psnr(image, picture.astype(image.dtype)),
        }
    return found


def outline(axes: Axes, field: Gaussians2D) -> None:
    """An ellipse of one standard deviation for each Gaussian that can be seen, in its color."""
    seen = opacity_of(field.params) > 0.1
    scale, angle = np.exp(field.params["log_scale"][seen]), field.params["angle"][seen]
    color = np.clip(field.params["color"][seen], 0, 1)
    axes.set(xlim=(0, 1), ylim=(1, 0), aspect="equal", facecolor="black")
    ellipses = EllipseCollection(
        2 * scale[:, 0],
        2 * scale[:, 1],
        np.degrees(angle),
        units="xy",
        offsets=field.params["mean"][seen],
        offset_transform=axes.transData,
        facecolors="none",
        edgecolors=color,
        linewidths=0.6,
    )
    axes.add_collection(ellipses)


def arrows(axes: Axes, field: Gaussians2D, picture: Array) -> None:
    """The pull on each mean over its outline; the longest arrows are a tenth of the canvas."""
    outline(axes, field)
    towards, mean = pull(field, picture), field.params["mean"]
    towards = 0.1 * towards / np.quantile(np.linalg.norm(towards, axis=1), 0.98)
    axes.quiver(
        *mean.T, *towards.T, color=style.ORANGE, angles="xy", scale_units="xy", scale=1, width=0.005
    )


def main() -> None:
    """Write the picture."""
    truth = photograph()
    found = computed(truth)
    with style.house_style():
        figure = style.new_figure(4 * PANEL + 0.75, PANEL + 1.3)
        panels = [
            style.place_axes(figure, 0.15 + k * (PANEL + 0.15), 0.35, PANEL, PANEL)
            for k in range(4)
        ]
        panels[0].imshow(truth, interpolation="nearest")
        arrows(panels[1], found["early"]["field"], truth)
        panels[2].imshow(found["free"]["picture"], interpolation="nearest")
        outline(panels[3], found["free"]["field"])
        titles = (
            f"{truth.shape[1]} x {truth.shape[0]} pixels",
            f"step {EARLY}: where the loss pulls the means",
            f"{COUNT} Gaussians: {found['free']['psnr']:.1f} dB",
            "the same, one standard deviation each",
        )
        for axes, title in zip(panels, titles, strict=True):
            axes.set(xticks=[], yticks=[], title=title)
        style.write_caption(
            figure,
            "A photograph fitted by Gaussians that lie on a canvas and are blended from the top "
            "one down, by gradient descent from a gray, round, random start. They stretch and lie "
            f"down along edges; as many that must stay round reach {found['round']['psnr']:.1f} "
            "dB. In three dimensions the formula is the same; a camera makes the ellipses, and "
            "depth the order.",
            left=0.15,
            right=0.15,
        )
        save_figure(figure, PICTURE)


if __name__ == "__main__":
    main()
