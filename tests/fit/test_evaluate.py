"""Scores count the pixels that a photograph has: no border of a lens, nothing under a mask."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.capture.undistort import Distortion
from photograd.capture.view import View
from photograd.errors import RangeError
from photograd.fields import DenseGrid
from photograd.fitting import evaluate as module
from photograd.fitting.evaluate import Evaluation, display_image, evaluate, truth_image
from photograd.fitting.model import Model
from photograd_course.metrics import psnr, round_to_8_bits, ssim
from PIL import Image

from tests.fit import scene

MODEL = scene.as_model(scene.truth())
Render = Callable[[Any], Any]


def opaque(size: int = 48) -> View:
    """One photograph of the scene before a wall, without alpha: every pixel of it is truth."""
    camera = scene.cameras(1, elevation=15.0, size=size)[0]
    return View("front", camera, scene.over_wall(scene.photograph(camera), (0.3, 0.5, 0.2)))


def distorted(_folder: Path) -> View:
    """A pincushion lens, whose removal leaves a border."""
    return replace(opaque(), distortion=Distortion(k1=0.15))


def masked(folder: Path, size: int = 48) -> View:
    """A block and a strip at an edge are masked."""
    mask = np.full((size, size), 255, np.uint8)
    mask[size // 3 : size // 2, : size // 3] = mask[:, 5 * size // 6 :] = 0
    Image.fromarray(mask).save(folder / "mask.png")
    return replace(opaque(size), mask_file=folder / "mask.png")


def reduced(folder: Path) -> View:
    """Both, and half the size."""
    return replace(masked(folder, size=96), distortion=Distortion(k1=0.15)).downscaled(2)


def scores(monkeypatch: pytest.MonkeyPatch, views: list[View], render: Render) -> Evaluation:
    """The evaluation of a model whose pictures are what `render` makes of each view."""
    pictures = {id(view.camera): render(view) for view in views}

    def drawn(_model: Model, camera: Any) -> Any:
        return pictures[id(camera)]

    monkeypatch.setattr(module, "display_image", drawn)
    return evaluate(MODEL, views)


def with_noise(view: View, *, inside: float, outside: float) -> Any:
    """The photograph, with so much noise in its valid pixels and in the others."""
    truth, valid = truth_image(view), view.valid_mask()
    noise = np.random.default_rng(1).uniform(-1, 1, truth.shape)
    changed = truth + np.where(valid[..., None], inside, outside) * noise
    return round_to_8_bits(np.clip(changed, 0, 1))


@pytest.mark.parametrize("make", [distorted, masked, reduced])
def test_the_photograph_itself_has_no_error(
    make: Callable[[Path], View], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    view = make(tmp_path)
    assert 0.4 < view.valid_mask().mean() < 0.98
    found = scores(monkeypatch, [view], lambda view: with_noise(view, inside=0.0, outside=1.0))
    assert found.psnr == float("inf")
    assert found.ssim == 1.0
    assert found.views[0].valid_share == view.valid_mask().mean()
    share = 100 * view.valid_mask().mean()
    assert f"over valid pixels, {share:.1f} % of all" in found.protocol
    assert module.as_result(found)["views"][0]["valid_share"] == view.valid_mask().mean()


@pytest.mark.parametrize("make", [distorted, masked, reduced])
def test_what_is_not_valid_changes_no_score(
    make: Callable[[Path], View], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    view = make(tmp_path)
    one, two = (
        scores(monkeypatch, [view], lambda view, far=far: with_noise(view, inside=0.1, outside=far))
        for far in (0.0, 1.0)
    )
    assert not np.array_equal(one.views[0].render, two.views[0].render)
    assert (one.psnr, one.ssim) == (two.psnr, two.ssim)
    assert 15 < one.psnr < 40
    assert 0.3 < one.ssim < 0.99
    # The border, white in the truth, would have dominated.
    everything = psnr(two.views[0].render, two.views[0].truth)
    assert everything < one.psnr - 3


def test_captures_without_masks_keep_their_scores_to_the_bit() -> None:
    views = scene.capture().test
    model = scene.as_model(DenseGrid(0.7 * scene.truth().params["values"], scene.truth().policy))
    found = evaluate(model, views)
    for view, score in zip(views, found.views, strict=True):
        render, truth = display_image(model, view.camera), truth_image(view)
        assert score.psnr == psnr(render, truth)
        assert score.ssim == ssim(render, truth)
        assert score.valid_share == 1
        assert 15 < score.psnr < 40
    assert "valid" not in found.protocol


def test_a_view_without_a_whole_window_is_named_and_left_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    striped = np.full((48, 48), 255, np.uint8)
    striped[::10] = 0  # nine rows between masked ones: valid pixels, but no window
    Image.fromarray(striped).save(tmp_path / "striped.png")
    whole = opaque()
    hidden = replace(opaque(), name="striped", mask_file=tmp_path / "striped.png")
    assert hidden.valid_mask().mean() > 0.8
    found = scores(
        monkeypatch, [hidden, whole], lambda view: with_noise(view, inside=0.1, outside=0.1)
    )
    assert [view.name for view in found.views] == ["front"]
    assert found.left_out == ("striped",)
    assert found.protocol.startswith("1 held-out views at 48x48")
    assert found.protocol.endswith("left out, without a window of valid pixels: striped")
    assert module.as_result(found)["left_out"] == ["striped"]
    with pytest.raises(
        RangeError,
        match="evaluate: views: expected a view with an 11x11 window of "
        "valid pixels, got none in striped",
    ):
        evaluate(MODEL, [hidden])
    with pytest.raises(RangeError, match="an 11x11 window of valid pixels, got none in front"):
        evaluate(MODEL, [opaque(size=10)])
