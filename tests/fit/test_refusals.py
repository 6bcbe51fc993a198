"""What a fit refuses, in one sentence, before or while it runs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd._checkpoint import load_checkpoint
from photograd.errors import Error, RangeError, SceneError
from photograd.fitting import FitOptions
from photograd.fitting.data import TrainingPixels
from photograd.fitting.evaluate import evaluate
from photograd.fitting.loop import Fit

from tests.fit import scene


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("dense_gird", r"a capture can start: .*, got 'dense_gird' .*mean 'dense_grid'"),
        ("zebra", r"'textured_mesh' or 'textured_surface', got 'zebra'$"),
        ("gaussian", r"got 'gaussian' \(did you mean 'gaussians'\?\)$"),
        ("texture_2d", r"got 'texture_2d' \(it lives on a 2D canvas\)"),
        (
            "tiny_network",
            "one that a capture can start: "
            "'dense_grid' or 'dense_sh' or 'gaussian_codes' or 'gaussians' or 'hash_grid' or "
            "'leaf_codes' or 'leaf_mlps' or 'mesh' or 'nerf' or 'octree_sh' or 'plenoctree' or "
            "'sparse_sh' or 'textured_mesh' or 'textured_surface', "
            "got 'tiny_network'",
        ),
    ],
)
def test_representations_that_cannot_be_fitted_to_a_capture(name: str, words: str) -> None:
    with pytest.raises(RangeError, match=words):
        Fit.start(scene.capture(), scene.options(representation=name))


def one_turned_away() -> Any:
    capture = scene.capture()
    view = capture.train[3]
    pose = view.camera.world_from_camera.copy()
    pose[:3, [0, 2]] *= -1  # about its own vertical axis: it looks the other way
    turned = replace(view, camera=replace(view.camera, world_from_camera=pose))
    return replace(capture, train=(*capture.train[:3], turned, *capture.train[4:]))


def test_cameras_that_do_not_see_the_box_are_named() -> None:
    with pytest.raises(SceneError, match=r"cameras that see the box .*got 1 of 12 .*: train_3"):
        Fit.start(one_turned_away(), scene.options())
    assert Fit.start(one_turned_away(), scene.options(), allow_blind=True).step() > 0


def test_a_box_that_no_camera_sees_is_refused_whatever_is_allowed() -> None:
    far = replace(scene.capture(), bounds=scene.BOX + 50.0)
    for allow in (False, True):
        with pytest.raises(SceneError, match="16 of 16 that do not: train_0, train_1"):
            Fit.start(far, scene.options(), allow_blind=allow)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"steps": 0}, "FitOptions: steps: expected a whole number in .*, got 0"),
        ({"learning_rate": float("nan")}, "rate: expected a finite number above 0, got nan"),
        ({"degree": 4}, "FitOptions: degree: expected a whole number in .*, got 4"),
        ({"prune": -0.1}, "FitOptions: prune: expected a finite number of at least 0, got -0.1"),
        ({"total_variation": -1.0}, "total_variation: expected a finite number of at least 0"),
        ({"background": "gray"}, r"background: expected one of .*, got 'gray'"),
        ({"refine_at": (0.5, 0.2)}, "refine_at: expected two rising fractions below 1"),
    ],
)
def test_bad_options_are_named(change: dict[str, Any], words: str) -> None:
    with pytest.raises(RangeError, match=words):
        FitOptions(**change)


def test_a_fit_that_diverges_stops_and_keeps_its_last_checkpoint(tmp_path: Path) -> None:
    fit = Fit.start(scene.capture(), scene.options(resolution=8, steps=20))
    fit.run(tmp_path, should_stop=lambda: fit.step_number >= 3)
    before = (tmp_path / "model.npz").read_bytes()
    fit.model.params["values"][3, 3, 3, 3] = np.nan
    with pytest.raises(Error, match="march: parameters: expected finite values"):
        fit.run(tmp_path)
    assert (tmp_path / "model.npz").read_bytes() == before
    assert load_checkpoint(tmp_path).meta["step"] == 3


def test_a_loss_that_is_not_finite_is_reported_with_its_step(tmp_path: Path) -> None:
    fit = Fit.start(scene.capture(), scene.options(resolution=8, steps=20, rays=64))
    fit.step()
    fit.data.premultiplied[:] = np.nan
    values = fit.model.params["values"].copy()
    with pytest.raises(Error, match=r"Fit.step: loss: expected a finite number, got nan at step 1"):
        fit.run(tmp_path)
    assert np.array_equal(fit.model.params["values"], values)


def test_a_gradient_that_is_not_finite_moves_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    fit = Fit.start(scene.capture(), scene.options(resolution=8, steps=20, rays=64))
    fit.step()
    values, state = fit.model.params["values"].copy(), fit.optimizer.state()
    loss, gradients = fit.loss_and_gradients(fit.data.draw(64, seed=1, step=1))
    gradients["values"][1, 2, 3, 0] = np.inf
    monkeypatch.setattr(fit, "loss_and_gradients", lambda _: (loss, gradients))
    with pytest.raises(RangeError, match=r"gradients\['values'\]: expected finite .* got 1 of"):
        fit.step()
    assert np.array_equal(fit.model.params["values"], values)
    assert all(np.array_equal(fit.optimizer.state()[key], array) for key, array in state.items())


def test_a_grid_that_does_not_fit_into_memory_is_refused_before_it_is_made(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fit = Fit.start(scene.capture(), scene.options(resolution=32, steps=10, refine_at=(0.2, 0.5)))
    coarse = fit.model.resolution
    fit.step()
    fit.step()
    monkeypatch.setattr("photograd._memory.available_memory", lambda: 100_000)
    with pytest.raises(RangeError, match=rf"room for a grid of 16 .*with --resolution {coarse}"):
        fit.step()
    monkeypatch.undo()
    fit.step()
    assert fit.model.resolution == 16


def test_nothing_to_learn_from_and_nothing_to_score() -> None:
    with pytest.raises(RangeError, match="TrainingPixels: views: expected at least one view"):
        TrainingPixels([], "display")
    with pytest.raises(RangeError, match="evaluate: views: expected at least one held-out view"):
        evaluate(scene.as_model(scene.truth()), [])
