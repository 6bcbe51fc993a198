"""The driver of every descent: when it stops, what it saves, and who may run in a folder."""

from __future__ import annotations

from pathlib import Path

import pytest
from photograd._descend import Progress, descend, progress_bar, run_folder
from photograd.errors import Error, IoError, RangeError


class Countdown:
    """Ten steps, the fifth of which may fail."""

    def __init__(self, fails: bool = False) -> None:
        self.step_number, self.steps, self.fails = 0, 10, fails
        self.saved: list[int] = []

    def step(self) -> float:
        if self.fails and self.step_number == 5:
            raise Error("step: loss: expected a finite number, got nan")
        self.step_number += 1
        return 1.0

    def save(self, folder: Path) -> None:
        assert folder.is_dir()
        self.saved.append(self.step_number)


def test_it_saves_on_the_way_and_at_the_end(tmp_path: Path) -> None:
    job, times = Countdown(), []
    run = descend(job, tmp_path / "new", after_step=times.append, checkpoint_seconds=0.0)
    assert run.finished
    assert job.saved == [*range(1, 11), 10]
    assert times == sorted(times)
    assert descend(job, None).finished  # nothing is left to do, nothing is written
    assert job.saved[-2:] == [10, 10]


def test_it_stops_where_it_is_told_and_goes_on() -> None:
    job = Countdown()
    assert not descend(job, None, should_stop=lambda: job.step_number == 3).finished
    assert job.step_number == 3
    assert descend(job, None).finished


def test_a_step_that_fails_replaces_no_checkpoint(tmp_path: Path) -> None:
    job = Countdown(fails=True)
    with pytest.raises(Error, match="a finite number"):
        descend(job, tmp_path, checkpoint_seconds=1e9)
    assert job.saved == []


def test_a_folder_is_held_and_not_overwritten(tmp_path: Path) -> None:
    with run_folder("fit", tmp_path, "model.npz", resume=False):
        with (
            pytest.raises(IoError, match="without another run in it"),
            run_folder("fit", tmp_path, "model.npz", resume=False),
        ):
            pass
        (tmp_path / "model.npz").touch()
    with (
        pytest.raises(RangeError, match=r"fit: --out: .* without model\.npz.*add --resume"),
        run_folder("fit", tmp_path, "model.npz", resume=False, argument="--out"),
    ):
        pass
    with run_folder("fit", tmp_path, "model.npz", resume=True):
        pass
    with (
        pytest.raises(RangeError, match="fit: resume: expected a folder to resume from"),
        run_folder("fit", None, "model.npz", resume=True),
    ):
        pass


def test_a_bar_shows_the_progress_that_it_is_given(capsys: pytest.CaptureFixture[str]) -> None:
    job = Countdown()
    with progress_bar("count", job) as on_step:
        assert on_step is not None
        on_step(Progress(10, 10, 0.25))
    assert "2.50e-01" in capsys.readouterr().err
    with progress_bar("count", job, shown=False) as on_step:
        assert on_step is None
