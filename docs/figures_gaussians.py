"""The pictures of a fit of Gaussians: `python docs/figures_gaussians.py` writes both.

gaussians.png: what the loss asks of each at three steps. gaussians.gif: the Gaussians as blobs of
half their size, the scene they make, and where the loss pulls their means, from start to end.
"""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd.capture.camera import Camera
from photograd.capture.capture import Capture
from photograd.capture.load import load_capture
from photograd.commands.capture import make_capture
from photograd.fitting.data import TrainingViews
from photograd.fitting.gradient_drawings import draw_arrows, draw_gaussian_gradients, draw_picture
from photograd.fitting.loop import Fit
from photograd.fitting.options import options_for
from photograd.fitting.view_gradients import ViewGradients, grad2d_picture, view_gradients
from photograd.splats.clone_split_prune import CloneSplitPrune
from photograd.splats.model import GaussianScene
from photograd.splats.splatting import Gaussians, render
from photograd_course.viz import save_figure, style, write_gif

Array = NDArray[Any]
IMAGES = Path(__file__).resolve().parent / "images"
SCENE, SIZE, VIEW = "toy_table", 96, 4
STEPS, COUNT = 800, 3000
SHOWN = (0, 60, 800)
FRAMES = (0, 2, 4, 8, 12, 18, 25, 35, 50, 70, 90, 120, 160, 200, 250, 320, 400, 500, 650, 800)
PANEL = 2.1  # inches


def photographs(size: int = SIZE, views: int = 30) -> Capture:
    """Pictures of the built-in scene, from a folder that is gone afterwards."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / SCENE
        make_capture(SCENE, place, views=views, test_views=2, size=size, spp=16, seed=0)
        capture = load_capture(place)
        train = tuple(replace(view, image=view.rgba()) for view in capture.train)
        return replace(capture, train=train, test=())


def blobs(gaussians: Gaussians, camera: Camera) -> Array:
    """(H, W, 3) the Gaussians at half their size and nearly opaque, over white."""
    shown = gaussians.arrays() | {
        "log_scales": gaussians.log_scales - np.float32(np.log(2.0)),
        "opacity_logits": np.full_like(gaussians.opacity_logits, 3.0),
    }
    picture, _ = render(Gaussians(**shown), camera, background=(1.0, 1.0, 1.0))
    return np.clip(picture.color, 0, 1)


def frame(step: int, found: ViewGradients, small: Array) -> Array:
    """(H, W, 3) one frame of the animation."""
    with style.house_style():
        figure = style.new_figure(3 * PANEL + 0.5, PANEL + 0.75)
        panels = (("blobs of half the size", small), ("the scene", found.picture), ("pull", None))
        for k, (name, picture) in enumerate(panels):
            axes = style.place_axes(figure, 0.15 + k * (PANEL + 0.1), 0.62, PANEL, PANEL)
            draw_picture(axes, found.picture if picture is None else picture, pale=picture is None)
            axes.set_title(name)
        draw_arrows(axes, found)
        axes.set(xlim=(0, found.picture.shape[1]), ylim=(found.picture.shape[0], 0))
        style.write_title(figure, f"step {step}", left=0.15)
    figure.canvas.draw()
    buffer = np.asarray(figure.canvas.buffer_rgba())  # type: ignore[attr-defined]
    image: Array = buffer[..., :3].astype(np.float32) / 255.0
    return image[::2, ::2] * 0.5 + image[1::2, 1::2] * 0.5


def main(folder: Path = IMAGES) -> None:
    """Fit, and draw; the same bytes every time."""
    fit = Fit.start(photographs(), options_for("gaussians", steps=STEPS, gaussians=COUNT))
    rows: dict[int, tuple[ViewGradients, Array]] = {}
    frames = []
    while True:
        scene, views = fit.model, fit.data
        assert isinstance(scene, GaussianScene)
        assert isinstance(views, TrainingViews)
        camera = views.views[VIEW].camera
        if fit.step_number in {*SHOWN, *FRAMES}:
            found = view_gradients(scene, views, VIEW)
            if fit.step_number in SHOWN:
                rows[fit.step_number] = (
                    found,
                    grad2d_picture(scene.gaussians, found.grad2d, camera),
                )
            frames.append(frame(fit.step_number, found, blobs(scene.gaussians, camera)))
        if fit.step_number == STEPS:
            break
        fit.step()
    folder.mkdir(exist_ok=True)
    figure = draw_gaussian_gradients(
        rows, threshold=CloneSplitPrune.threshold, title="What the loss asks of each Gaussian"
    )
    save_figure(figure, folder / "gaussians.png")
    write_gif(frames + [frames[-1]] * 6, folder / "gaussians.gif", frames_per_second=4)


if __name__ == "__main__":
    main()
