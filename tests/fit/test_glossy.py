"""Color that changes with direction: what harmonics are for, and a diffuse grid cannot show."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from photograd.capture.camera import Camera
from photograd.capture.capture import Capture
from photograd.capture.view import View
from photograd.fields import SparseSh
from photograd.fields.active_voxels import ActiveVoxels
from photograd.fields.march import MarchPolicy
from photograd.fitting.evaluate import evaluate, render_camera
from photograd.fitting.loop import Fit
from photograd.fitting.model import load_model
from photograd_course.color import srgb_encode, unpremultiply

from tests.fit.scene import BOX, as_model, cameras, options


def glossy_ball() -> SparseSh:
    """A hard gray ball whose three colors shine along three axes, to degree 2."""
    shape = (32, 24, 28)
    axes = [BOX[0, k] + (np.arange(n) + 0.5) * 0.05 for k, n in enumerate(shape)]
    radius = np.linalg.norm(np.stack(np.meshgrid(*axes, indexing="ij"), -1), axis=-1)
    active = ActiveVoxels(radius < 0.48)
    i, j, k = active.voxels.T
    density = np.where(radius[i, j, k] < 0.4, 40.0, 0.0)
    coefficients = np.zeros((len(active), 9, 3))
    coefficients[:, 0] = 0.35 / 0.28209479177387814
    coefficients[:, [3, 1, 2], [0, 1, 2]] = 0.4
    coefficients[:, 8, :] = 0.15
    policy = MarchPolicy(
        (tuple(BOX[0].tolist()), tuple(BOX[1].tolist())),
        0.02,
        border="zero",
        density_activation="relu",
        color_activation="relu",
    )
    return SparseSh(active, density, coefficients, policy)


def glossy_capture() -> Capture:
    model = as_model(glossy_ball())

    def view(name: str, camera: Camera) -> View:
        color, opacity, _ = render_camera(model, camera, stop=0.0)
        straight = np.clip(srgb_encode(unpremultiply(color, opacity)), 0, 1)
        rgba = np.concatenate([straight, opacity[..., None]], axis=-1)
        return View(name, camera, rgba.astype(np.float32))

    train = [*cameras(9, elevation=40.0), *cameras(9, elevation=5.0), *cameras(6, elevation=-30.0)]
    test = cameras(5, elevation=22.0)
    return Capture(
        tuple(view(f"train_{n}", c) for n, c in enumerate(train)),
        tuple(view(f"test_{n}", c) for n, c in enumerate(test)),
        "memory",
        Path("memory"),
        "display",
        True,
        bounds=BOX,
    )


def test_harmonics_beat_a_diffuse_grid_of_the_same_size(tmp_path: Path) -> None:
    capture = glossy_capture()
    scores = {}
    for name in ("dense_grid", "sparse_sh"):
        chosen = options(resolution=32, steps=300, rays=1024, representation=name, degree=2)
        Fit.start(capture, chosen).run(tmp_path / name)
        scores[name] = evaluate(load_model(tmp_path / name), capture.test).psnr
    assert scores["dense_grid"] > 15, scores
    assert scores["sparse_sh"] >= scores["dense_grid"] + 1.5, scores
