"""The picture on the front page: `python docs/figures.py DEMO`, DEMO from `photograd demo`."""

from __future__ import annotations

import argparse
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from photograd.capture import load_capture
from photograd.fields import DenseGrid
from photograd.fitting.data import TrainingPixels
from photograd.fitting.evaluate import display_image, truth_image
from photograd.fitting.model import load_model
from photograd.fitting.voxel_gradients import density_gradient
from photograd_course.viz import signed_projection

PICTURE = Path(__file__).resolve().parent / "images" / "demo.png"
VIEW = 2


def main() -> None:
    """Draw a photograph, the model from there, and the gradient of the start in a wider box."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("demo", type=Path)
    demo = parser.parse_args().demo
    capture, model = load_capture(demo / "capture"), load_model(demo / "model")
    view = capture.test[VIEW]
    middle, half = model.field.box.mean(axis=0), np.ptp(model.field.box, axis=0) / 2
    start = DenseGrid.empty(np.array([middle - 1.5 * half, middle + 1.5 * half]), 64)
    pixels = TrainingPixels(capture.train[::5], capture.color_space)
    gradient = density_gradient(start, pixels, seed=0, rays=1 << 19).d_sigma_t
    flat = signed_projection(gradient, 2).T[::-1]
    limit = np.quantile(np.abs(flat), 0.995)
    figure, axes = plt.subplots(1, 3, figsize=(9, 3.3), dpi=110)
    axes[0].imshow(truth_image(view))
    axes[1].imshow(display_image(model, view.camera))
    axes[2].imshow(flat, cmap="RdBu_r", vmin=-limit, vmax=limit)
    titles = ("held-out photograph", "recovered volume", "where the loss wants matter (blue)")
    for panel, title in zip(axes, titles, strict=True):
        panel.set_title(title, fontsize=10)
        panel.axis("off")
    figure.tight_layout()
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, metadata={"Software": None})


if __name__ == "__main__":
    main()
