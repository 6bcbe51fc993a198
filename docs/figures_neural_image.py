"""A photograph out of networks: `python docs/figures_neural_image.py` writes
docs/images/neural_image.png. Asks for scikit-image, which brings the photograph.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from figures_gaussians_2d import photograph
from matplotlib.axes import Axes
from numpy.typing import NDArray
from photograd.fields import ImagePolicy, NeuralImage
from photograd.fitting import FittedImage, ImageFitOptions, fit_image
from photograd.fitting.network_gradients import level_planes
from photograd.network import HashEncoding
from photograd.representation import CanvasBatch, Outputs, RenderOptions
from photograd_course.viz import save_figure, style
from photograd_course.viz.scale import nice_limit

Array = NDArray[Any]
PICTURE = Path(__file__).resolve().parent / "images" / "neural_image.png"
PANEL, SIZE = 2.6, 256
HASH = ImagePolicy(levels=12, coarsest=8, finest=256, log2_rows=12)
POLICIES = {
    "no encoding": replace(HASH, encoding="frequencies", octaves=0, depth=4),
    "frequencies": replace(HASH, encoding="frequencies", octaves=8, depth=4),
    "hash grid": HASH,
}
OPTIONS = ImageFitOptions(steps=400, points=1 << 14, learning_rate=5e-3)
EARLY = 12  # steps, after which the gradient is shown
SHOWN = (0, 6, 11)  # levels


def computed(picture: Array, options: ImageFitOptions = OPTIONS) -> dict[str, FittedImage]:
    """The fit of each of `POLICIES`, at equal steps."""
    return {name: fit_image(picture, policy, options) for name, policy in POLICIES.items()}


def gradient(field: NeuralImage, picture: Array) -> tuple[Array, list[Array]]:
    """Residual (H, W), mean over channels, and d_table on the canvas, level by level.

    Of the mean squared error over all pixels.
    """
    height, width = picture.shape[:2]
    y, x = np.meshgrid(
        (np.arange(height) + 0.5) / height, (np.arange(width) + 0.5) / width, indexing="ij"
    )
    points = np.stack([x.ravel(), y.ravel()], axis=-1)
    outputs, context = field.render(CanvasBatch(points), seed=0, step=0, options=RenderOptions())
    error = outputs.color - picture.reshape(-1, 3)
    d = field.render_backward(context, Outputs(2 * error / error.size))
    assert isinstance(field.encoding, HashEncoding)
    planes = level_planes(field.encoding, d["table"], pixels=height)
    return error.mean(axis=1).reshape(height, width), planes


def signed(axes: Axes, values: Array, title: str) -> None:
    """Values about a white zero."""
    limit = nice_limit(float(np.quantile(np.abs(values), 0.995)))
    axes.imshow(values, norm=style.symmetric_scale(limit), cmap=style.signed_color_map())
    axes.set(
        xticks=[], yticks=[], title=title, xlabel=f"\N{PLUS-MINUS SIGN} {style.power_text(limit)}"
    )


def main() -> None:
    """Write the picture."""
    truth = photograph(SIZE).astype(np.float32)
    found = computed(truth)
    early = fit_image(truth, HASH, replace(OPTIONS, steps=EARLY, final_rate=1.0)).field
    residual, planes = gradient(early, truth)
    with style.house_style():
        figure = style.new_figure(4 * (PANEL + 0.15) + 0.15, 2 * (PANEL + 0.55) + 0.95)
        panels = [
            style.place_axes(
                figure, 0.15 + k % 4 * (PANEL + 0.15), 0.35 + k // 4 * (PANEL + 0.5), PANEL, PANEL
            )
            for k in range(8)
        ]
        panels[0].imshow(truth)
        panels[0].set(xticks=[], yticks=[], title=f"{SIZE} x {SIZE} pixels")
        for axes, (name, fitted) in zip(panels[1:], found.items(), strict=False):
            axes.imshow(fitted.image)
            title = f"{name}: {fitted.psnr:.1f} dB, {fitted.size / 1000:.0f} kB"
            axes.set(xticks=[], yticks=[], title=title)
        signed(panels[4], residual, f"residual after {EARLY} steps")
        for axes, level in zip(panels[5:], SHOWN, strict=True):
            cells = early.encoding.levels[level].resolution
            signed(axes, planes[level], f"gradient, level {level}: {cells} cells")
        style.write_caption(
            figure,
            f"Above: a photograph learned by networks in {OPTIONS.steps} steps. Without an "
            "encoding a network takes low frequencies first, and stays with them. Below: what is "
            "wrong early in the fit of the hash grid, and the derivative of the loss with respect "
            "to the first feature of three levels: a coarse corner gets the sum of all errors near "
            "it, a fine one those of a few pixels. The last level has 16 corners a row of its "
            "table: corners far apart share a row, and the pattern repeats everywhere.",
            left=0.15,
            right=0.15,
        )
        save_figure(figure, PICTURE, dpi=100)


if __name__ == "__main__":
    main()
