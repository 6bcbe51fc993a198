"""The driver of every descent: when it stops, what it saves, and who may run in a folder."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from photograd._checkpoint import Checkpoint, holds_steps, save_checkpoint
from photograd._descend import Progress, Run, changing, descend, progress_bar, run_folder
from photograd.errors import Error, IoError, RangeError


class Countdown:
    """Ten steps, the fifth of which may fail."""

    def __init__(self, fails: bool = False) -> None:
        self.step_number, self.steps, self.fails = 0, 10, fails
        self.changing = False
        self.saved: list[int] = []

    def step(self) -> float:
        if self.fails and self.step_number == 5:
            raise Error("step: loss: expected a finite number, got nan")
        with changing(self):
            self.step_number += 1
        return 1.0

    def save(self, folder: Path) -> Path:
        assert folder.is_dir()
        self.saved.append(self.step_number)
        (folder / "saved").touch()
        return folder / "saved"


@pytest.fixture(autouse=True)
def _keyboard() -> Iterator[None]:
    """As in a terminal; a shell ignores it for what it runs in the background."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def same(run: Run) -> Run:
    return run


def test_it_saves_on_the_way_and_at_the_end(tmp_path: Path) -> None:
    job, times = Countdown(), []
    run = descend(job, tmp_path / "new", same, after_step=times.append, checkpoint_seconds=0.0)
    assert run.finished
    assert job.saved == [*range(11)]
    assert times == sorted(times)
    assert descend(job, None, same).finished  # nothing is left to do, nothing is written
    assert job.saved == [*range(11)]


def test_it_stops_where_it_is_told_and_goes_on() -> None:
    job = Countdown()
    assert not descend(job, None, same, should_stop=lambda: job.step_number == 3).finished
    assert job.step_number == 3
    assert descend(job, None, same).finished


def test_a_step_that_fails_replaces_no_checkpoint(tmp_path: Path) -> None:
    job = Countdown(fails=True)
    with pytest.raises(Error, match="a finite number") as caught:
        descend(job, tmp_path, same, checkpoint_seconds=1e9)
    assert job.saved == [0]
    assert not (tmp_path / "saved").exists()  # no step is worth to keep
    assert not hasattr(caught.value, "partial_result")
    job.step_number = 3
    with pytest.raises(Error, match="a finite number"):
        descend(job, tmp_path, same, checkpoint_seconds=0.0)
    assert job.saved == [0, 4, 5]
    assert (tmp_path / "saved").exists()


@pytest.mark.parametrize("kind", [KeyboardInterrupt, ValueError, Error, SystemExit])
def test_an_exception_of_a_callback_saves_and_brings_the_result(
    tmp_path: Path, kind: type[BaseException]
) -> None:
    job = Countdown()

    def raises(_: float) -> None:
        if job.step_number == 4:
            raise kind("from a callback")

    with pytest.raises(kind, match="from a callback") as caught:
        descend(job, tmp_path, lambda run: (job.step_number, run.finished), after_step=raises)
    assert caught.value.partial_result == (4, False)  # type: ignore[attr-defined]
    assert job.saved == [0, 4]


def test_a_signal_is_heard_between_two_steps(tmp_path: Path) -> None:
    job = Countdown()

    def interrupted() -> float:
        signal.raise_signal(signal.SIGINT)  # in the middle of a step
        return Countdown.step(job)

    before = signal.getsignal(signal.SIGINT)
    job.step = interrupted  # type: ignore[method-assign]
    with pytest.raises(KeyboardInterrupt) as caught:
        descend(job, tmp_path, lambda _: job.step_number)
    assert caught.value.partial_result == 1  # type: ignore[attr-defined]
    assert job.saved == [0, 1]
    assert signal.getsignal(signal.SIGINT) is before


def test_a_second_signal_acts_at_once_and_half_a_step_is_not_saved(tmp_path: Path) -> None:
    job = Countdown()

    def interrupted() -> float:
        with changing(job):
            signal.raise_signal(signal.SIGINT)
            signal.raise_signal(signal.SIGINT)
            job.step_number += 1
        return 1.0

    job.step = interrupted  # type: ignore[method-assign]
    with pytest.raises(KeyboardInterrupt):
        descend(job, tmp_path, same)
    assert job.saved == [0]
    with pytest.raises(Error, match=r"descend: job: .* between two steps, got one whose step was"):
        descend(job, tmp_path, same)


def test_a_checkpoint_of_no_step_is_nothing_to_lose(tmp_path: Path) -> None:
    for step, kept in ((0, False), (3, True)):
        save_checkpoint(
            tmp_path / "model.npz", Checkpoint({"step": step}, {}, {}, {}, np.zeros((0, 3)))
        )
        assert holds_steps(tmp_path / "model.npz") == kept
    (tmp_path / "model.npz").write_bytes(b"damaged")
    assert holds_steps(tmp_path / "model.npz")


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
