"""The animation of the front page: `python docs/animate_recovery.py CAPTURE`.

A volume recovered from the photographs of a capture, seen from a held-out camera, and beside it the
gradient of the loss with respect to the extinction, summed along each ray. Both at moments that lie
closer at the start, where much happens. Writes docs/images/recovery.gif, 960 pixels wide.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd.capture.camera import Camera
from photograd.capture.load import load_capture
from photograd.fields import DenseGrid
from photograd.fitting import density_gradient
from photograd.fitting.data import TrainingPixels
from photograd.fitting.evaluate import display_image
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model
from photograd.fitting.options import options_for
from photograd.fitting.steps import training_data
from photograd_course.viz import style, write_gif

Array = NDArray[Any]
PICTURE = Path(__file__).resolve().parent / "images" / "recovery.gif"
SIDE, STEPS, RESOLUTION, FRAMES, SAMPLES = 480, 1500, 128, 25, 192
RAYS = 1 << 17
"""Pixels whose loss is differentiated for one frame."""
QUANTILE = 0.99
"""Of the absolute sums in a frame: full color. One voxel does not set the scale."""


def moments() -> list[int]:
    """Steps of the frames: squares of equal distances, each once."""
    t = np.linspace(0.0, 1.0, FRAMES)
    return sorted({round(float(x * x * STEPS)) for x in t})


def enlarged(camera: Camera) -> Camera:
    """The same view with SIDE pixels along its longer edge."""
    k = SIDE / max(camera.width, camera.height)
    size = {"width": round(k * camera.width), "height": round(k * camera.height)}
    numbers = {name: k * getattr(camera, name) for name in ("fx", "fy", "cx", "cy")}
    return replace(camera, **size, **numbers)


def ray_sums(values: Array, box: Array, camera: Camera) -> Array:
    """(H, W) integrals of voxel values (X, Y, Z) along the rays of pixels, in meters."""
    origins, d = camera.rays()
    distance = np.linalg.norm(box.mean(axis=0) - camera.position)
    radius = 0.5 * np.linalg.norm(box[1] - box[0])
    total = np.zeros(d.shape[:-1])
    spacing = 2 * radius / SAMPLES
    count = np.array(values.shape)
    for k in range(SAMPLES):
        p = origins + (distance - radius + (k + 0.5) * spacing) * d
        index = np.floor((p - box[0]) / (box[1] - box[0]) * count).astype(np.int64)
        inside = ((index >= 0) & (index < count)).all(axis=-1)
        cell = tuple(np.moveaxis(np.where(inside[..., None], index, 0), -1, 0))
        total += np.where(inside, values[cell], 0.0)
    return total.reshape(camera.height, camera.width) * spacing


def signed(sums: Array) -> Array:
    """(H, W, 3) colors: red where less matter lowers the loss, blue where more does.

    Square roots, so that what is small beside the largest sums is seen, too.
    """
    limit = float(np.quantile(np.abs(sums[sums != 0]), QUANTILE)) if sums.any() else 1.0
    roots = np.sign(sums) * np.sqrt(np.abs(sums) / limit)
    normed = np.clip(0.5 + 0.5 * roots, 0.0, 1.0)
    colors: Array = style.signed_color_map()(normed)[..., :3].astype(np.float32)
    return colors


def frame(fit: Fit, pixels: TrainingPixels, camera: Camera) -> Array:
    """Picture and gradient beside each other."""
    field = fit.model
    assert isinstance(field, DenseGrid)
    picture = np.clip(display_image(Model.of(field), camera), 0, 1).astype(np.float32)
    found = density_gradient(field, pixels, seed=1, rays=RAYS)
    beside = signed(ray_sums(found.d_sigma_t, field.box, camera))
    return np.concatenate([picture, beside], axis=1)


def main() -> None:
    """Fit and draw; the same bytes every time."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("capture", type=Path)
    parser.add_argument("--view", type=int, default=27, help="number of the held-out view")
    given = parser.parse_args()
    capture = load_capture(given.capture)
    camera = enlarged(capture.test[given.view].camera)
    fit = Fit.start(capture, options_for("dense_grid", resolution=RESOLUTION, steps=STEPS))
    pixels = training_data(capture, fit.model)
    frames = []
    for moment in moments():
        while fit.step_number < moment:
            fit.step()
        frames.append(frame(fit, pixels, camera))
    write_gif(frames + [frames[-1]] * 8, PICTURE, frames_per_second=6)


if __name__ == "__main__":
    main()
