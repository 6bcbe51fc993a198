"""Fits that cannot fit into memory are refused with numbers, before anything is allocated."""

from __future__ import annotations

import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from photograd.capture import load_capture
from photograd.errors import RangeError
from photograd.fitting.checks import require_room_to_start
from photograd.fitting.data import TrainingPixels, TrainingViews
from photograd.fitting.loop import Fit
from photograd.fitting.options import options_for
from photograd.representation import COPIES
from PIL import Image

from support import capture_files as files
from tests.fit import scene

GRIDS = ("dense_grid", "sparse_sh", "dense_sh")


@pytest.mark.parametrize(
    ("representation", "option", "value", "words"),
    [
        *((name, "resolution", 100_000, "--resolution") for name in GRIDS),
        *((name, "rays", 2 * 10**9, "take fewer with --rays") for name in GRIDS),
        ("gaussians", "gaussians", 2 * 10**9, "--gaussians"),
    ],
)
def test_a_size_beyond_memory_names_the_option_and_what_it_takes(
    representation: str, option: str, value: int, words: str
) -> None:
    options = options_for(representation, **{option: value})
    capture = scene.capture()
    tracemalloc.start()
    try:
        with pytest.raises(RangeError, match=rf"^Fit.start: {option}: .* [GT]iB\), got .*{words}"):
            Fit.start(capture, options)
        assert tracemalloc.get_traced_memory()[1] < 1 << 20
    finally:
        tracemalloc.stop()


def test_the_estimate_of_a_grid_is_what_it_holds(monkeypatch: pytest.MonkeyPatch) -> None:
    """And the room that the photographs and rays take is no longer there for it."""
    options = scene.options(resolution=32, rays=10, refine_at=(0.0, 0.0))
    fit = Fit.start(scene.capture(), options)
    for _ in range(2):
        fit.step()
    held = COPIES * sum(array.nbytes for array in fit.model.params.values())
    assert held == COPIES * 16 * 32 * 24 * 28  # the box is 1.6 x 1.2 x 1.4 m
    pixels = 48 * 24 * 24 * len(scene.capture().train)
    for room, enough in ((held + pixels + 4800, True), (held + pixels + 4799, False)):
        monkeypatch.setattr("photograd.fitting.checks.available_memory", lambda room=room: room)
        if enough:
            require_room_to_start(scene.capture(), scene.BOX, options)
        else:
            with pytest.raises(RangeError, match=r"rays: expected room .*4,800 bytes.*4,799 bytes"):
                require_room_to_start(scene.capture(), scene.BOX, options)


def test_photographs_beyond_memory_are_to_be_reduced(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("photograd.fitting.checks.available_memory", lambda: 100_000)
    for name in ("dense_grid", "gaussians"):
        options = options_for(name, resolution=8, rays=1, gaussians=1)
        with pytest.raises(RangeError, match=r"capture: .*pixels to learn from.*--downscale"):
            require_room_to_start(scene.capture(), scene.BOX, options)


def test_the_advice_can_be_followed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("photograd.fitting.checks.available_memory", lambda: 8 << 20)
    with pytest.raises(RangeError, match=r"\(--resolution (\d+) takes half") as caught:
        require_room_to_start(scene.capture(), scene.BOX, scene.options(resolution=128, rays=9))
    less = int(str(caught.value).split("--resolution ")[1].split()[0])
    require_room_to_start(scene.capture(), scene.BOX, scene.options(resolution=less, rays=9))
    assert 32 < less < 64


def test_views_without_a_valid_pixel_are_refused(tmp_path: Path) -> None:
    black = tmp_path / "black.png"
    files.write_nerfstudio(tmp_path, files.orbit(9))
    Image.fromarray(np.zeros((20, 24), np.uint8)).save(black)
    views = [replace(view, mask_file=black) for view in load_capture(tmp_path).train]
    words = r"views: expected a valid pixel in the training views, got none in \d+ .*masks are"
    for training_set in (lambda: TrainingPixels(views, "display"), lambda: TrainingViews(views)):
        with pytest.raises(RangeError, match=words):
            training_set()
    views[3] = replace(views[3], mask_file=None)
    assert len(TrainingPixels(views, "display")) == 20 * 24
