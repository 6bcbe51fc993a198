"""Ctrl-C and exceptions of a callback, in every kind of fit: a model that loads, and no bit lost.

Resumed, it ends with the bits of a fit that nothing has interrupted.
"""

from __future__ import annotations

import signal
from pathlib import Path
from typing import Any

import photograd
import pytest
from photograd._checkpoint import load_checkpoint
from photograd.fitting.loop import Fit
from photograd_course.random import uniform

from tests.fit import scene
from tests.fit.all_fits import fits
from tests.fit.test_resume import WALL, assert_same
from tests.fit.test_whole import OPTIONS, params


def raises_at(step: int, kind: type[BaseException]) -> Any:
    """A callback that raises after a step."""

    def after(progress: Any) -> None:
        if progress.step >= step:
            raise kind("stop here")

    return after


def interrupt_in(job: Fit, step: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Send SIGINT to this process in the middle of a step."""
    drawn = job.draw

    def draw() -> Any:
        if job.step_number == step:
            signal.raise_signal(signal.SIGINT)
        return drawn()

    monkeypatch.setattr(job, "draw", draw)


def test_every_representation_goes_on_to_the_same_bits(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    capture = scene.capture(wall=WALL)
    for index, (name, begin) in enumerate(fits(capture)):
        straight, stopped = tmp_path / f"{index}", tmp_path / f"{index} stopped"
        begin().run(straight)
        job = begin()
        first = 1 + int(uniform(3, step=index) * (job.steps - 2))
        with pytest.raises(KeyboardInterrupt) as caught:
            job.run(stopped, on_step=raises_at(first, KeyboardInterrupt))
        assert caught.value.partial_result.step == first, name  # type: ignore[attr-defined]
        assert photograd.load_model(stopped).meta["step"] == first
        job = Fit.resume(capture, stopped)
        second = first + int(uniform(4, step=index) * (job.steps - first))
        interrupt_in(job, second, monkeypatch)
        with pytest.raises(KeyboardInterrupt):
            job.run(stopped)
        assert load_checkpoint(stopped).meta["step"] == second + 1, name
        Fit.resume(capture, stopped).run(stopped)
        assert_same(straight, stopped)


@pytest.mark.parametrize("kind", [KeyboardInterrupt, ValueError])
@pytest.mark.parametrize("kept", [True, False], ids=["folder", "no folder"])
def test_fit_attaches_the_model_so_far(
    kept: bool, kind: type[BaseException], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "model" if kept else None
    run = Fit.run

    def stopped(job: Fit, path: Path, **_: Any) -> Any:
        return run(job, path, on_step=raises_at(7, kind))

    monkeypatch.setattr(Fit, "run", stopped)
    with pytest.raises(kind) as caught:
        photograd.fit(scene.capture(), folder=folder, **OPTIONS)
    model = caught.value.partial_result  # type: ignore[attr-defined]
    assert model.history.shape == (7, 3)
    monkeypatch.undo()
    if folder is not None:
        assert params(photograd.load_model(folder)) == params(model)
        resumed = photograd.fit(scene.capture(), folder=folder, resume=True)
        assert params(resumed) == params(photograd.fit(scene.capture(), **OPTIONS))


def test_half_a_step_is_thrown_away(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An interrupt that no signal announces, in the middle of the optimizer."""
    capture = scene.capture()
    job = Fit.start(capture, photograd.FitOptions(**OPTIONS))
    step = job.optimizer.step

    def half(params: Any, gradients: Any, rates: Any) -> None:
        if job.step_number == 5:
            names = list(gradients)[:1]
            step(params, {name: gradients[name] for name in names}, rates)
            raise KeyboardInterrupt
        step(params, gradients, rates)

    monkeypatch.setattr(job.optimizer, "step", half)
    with pytest.raises(KeyboardInterrupt):
        job.run(tmp_path / "stopped", checkpoint_seconds=0.0)
    assert load_checkpoint(tmp_path / "stopped").meta["step"] == 5
    Fit.resume(capture, tmp_path / "stopped").run(tmp_path / "stopped")
    Fit.start(capture, photograd.FitOptions(**OPTIONS)).run(tmp_path / "straight")
    assert_same(tmp_path / "straight", tmp_path / "stopped")


def test_before_the_first_step_there_is_a_model_too(tmp_path: Path) -> None:
    job = Fit.start(scene.capture(), photograd.FitOptions(**OPTIONS))
    job.step = lambda: (_ for _ in ()).throw(KeyboardInterrupt)  # type: ignore[method-assign]
    with pytest.raises(KeyboardInterrupt):
        job.run(tmp_path)
    assert photograd.load_model(tmp_path).meta["step"] == 0
    model = photograd.fit(scene.capture(), folder=tmp_path, **OPTIONS)  # nothing is in its way
    assert model.meta["step"] == OPTIONS["steps"]
