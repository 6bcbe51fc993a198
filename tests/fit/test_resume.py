"""A fit that was stopped ends with the bits of one that was not."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd._checkpoint import load_checkpoint
from photograd.capture.load import load_capture
from photograd.errors import RangeError
from photograd.fitting.loop import Fit
from photograd.fitting.model import load_snapshots

from tests.fit import scene

WALL = (0.9, 0.6, 0.3)
OPTIONS = {"resolution": 32, "steps": 40, "rays": 256}  # levels 8, 16, 32 from steps 0, 6, 16


def run(fit: Fit, folder: Path, *, until: int = 10**9) -> None:
    fit.run(folder, should_stop=lambda: fit.step_number >= until)


def assert_same(a: Path, b: Path) -> None:
    """Parameters, optimizer, history: every array of the checkpoints, bit for bit."""
    one, two = load_checkpoint(a), load_checkpoint(b)
    for part in ("params", "optimizer", "state"):
        first, second = getattr(one, part), getattr(two, part)
        assert set(first) == set(second)
        for name, array in first.items():
            assert np.array_equal(array, second[name]), f"{part} {name}"
    assert np.array_equal(one.history, two.history)
    assert {**one.meta, "capture": ""} == {**two.meta, "capture": ""}


@pytest.mark.parametrize("wall", [None, WALL], ids=["random background", "learned background"])
def test_stopped_at_each_kind_of_step(tmp_path: Path, wall: Any) -> None:
    capture = scene.capture(wall=wall)
    run(Fit.start(capture, scene.options(**OPTIONS)), tmp_path / "straight")
    # Before a refinement, at it, after it, right before the end; each stop is a new object.
    run(Fit.start(capture, scene.options(**OPTIONS)), tmp_path / "stopped", until=4)
    for until in (6, 7, 16, 25, 39, 40):
        fit = Fit.resume(capture, tmp_path / "stopped")
        run(fit, tmp_path / "stopped", until=until)
        assert fit.step_number == until
    straight = load_checkpoint(tmp_path / "straight")
    assert straight.params["values"].shape[0] == 32
    assert ("background" in straight.params) == (wall is not None)
    assert np.abs(straight.optimizer["mean/values"]).max() > 0
    assert_same(tmp_path / "straight", tmp_path / "stopped")
    for folder in ("straight", "stopped"):
        assert list(load_snapshots(tmp_path / folder)) == [0, 1, 4, 12, 40]


def test_checkpoints_on_the_way_change_nothing(tmp_path: Path) -> None:
    capture = scene.capture()
    run(Fit.start(capture, scene.options(**OPTIONS)), tmp_path / "rarely")
    often = Fit.start(capture, scene.options(**OPTIONS))
    often.run(tmp_path / "often", checkpoint_seconds=0.0)
    assert_same(tmp_path / "rarely", tmp_path / "often")


def test_a_finished_fit_stays_finished(tmp_path: Path) -> None:
    capture = scene.capture()
    run(Fit.start(capture, scene.options(steps=5)), tmp_path)
    again = Fit.resume(capture, tmp_path)
    result = again.run(tmp_path)
    assert result.finished
    assert result.step == 5
    assert result.loss == again.history[-1][1] > 0


def test_leftovers_of_a_killed_process_are_removed(tmp_path: Path) -> None:
    capture = scene.capture()
    run(Fit.start(capture, scene.options(steps=5)), tmp_path, until=2)
    leftover = tmp_path / ".model.npz.12345.tmp"
    leftover.write_bytes(b"half a checkpoint")
    (tmp_path / "notes.tmp").write_text("mine")
    Fit.resume(capture, tmp_path).save(tmp_path)
    assert not leftover.exists()
    assert (tmp_path / "notes.tmp").exists()


def test_the_checkpoint_of_another_capture_is_refused(tmp_path: Path) -> None:
    fit = Fit.start(scene.capture(), scene.options(steps=5))
    run(fit, tmp_path / "model", until=2)
    before = (tmp_path / "model" / "model.npz").read_bytes()
    fewer = load_capture(scene.write(tmp_path / "fewer", train=6))
    with pytest.raises(RangeError, match=r"Fit.resume: capture: expected the checkpoint's split"):
        Fit.resume(fewer, tmp_path / "model")
    # The same names, but other pixels: the photographs stand before a wall.
    with pytest.raises(RangeError, match=r"expected the images and cameras .* of the checkpoint"):
        Fit.resume(scene.capture(wall=WALL), tmp_path / "model")
    with pytest.raises(RangeError, match=r"images and cameras.*--downscale"):
        Fit.resume(scene.capture().downscaled(2), tmp_path / "model")
    assert (tmp_path / "model" / "model.npz").read_bytes() == before


def test_the_same_files_elsewhere_are_the_same_capture(tmp_path: Path) -> None:
    first, moved = (load_capture(scene.write(tmp_path / name)) for name in ("here", "there"))
    run(Fit.start(first, scene.options(steps=6)), tmp_path / "model", until=3)
    assert Fit.resume(moved, tmp_path / "model").step_number == 3
