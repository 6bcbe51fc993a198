"""The driver of every gradient descent: steps, checkpoints, progress, one run in a folder.

    with run_folder("fit", folder, "model.npz", resume=resume):  # locked
        with progress_bar("fit", job, COLUMNS) as on_step:
            descend(job, folder, after_step=show(on_step), should_stop=stopping)

What a step does, and what a checkpoint holds, is the job's. A job whose random numbers are a
function of its seed and the step, and whose checkpoint holds everything else that a step depends
on, ends with the same bits whether it was interrupted or not.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from photograd_course.cli import Column
from photograd_course.cli import Progress as Bar

from photograd._checkpoint import make_folder
from photograd._run_lock import one_run_in
from photograd.errors import RangeError, message

LOSS_COLUMN = Column("loss", "{:.2e}".format)


@dataclass(frozen=True)
class Progress:
    """What a progress display gets after a step."""

    step: int
    steps: int
    loss: float


class Job(Protocol):
    """What `descend` drives: a descent that knows how to do a step and how to be saved."""

    step_number: int

    @property
    def steps(self) -> int:
        """Steps of the whole descent."""

    def step(self) -> float:
        """Do one step; returns the loss before it."""

    def save(self, folder: Path) -> None:
        """Write the checkpoint atomically."""


@dataclass(frozen=True)
class Run:
    """How a call of `descend` ended."""

    finished: bool
    seconds: float


def descend(
    job: Job,
    folder: Path | None,
    *,
    after_step: Callable[[float], None] = lambda _: None,
    should_stop: Callable[[], bool] = lambda: False,
    checkpoint_seconds: float = 30.0,
) -> Run:
    """Step until the end or until `should_stop`; the folder then holds the checkpoint.

    Args:
        job: goes on where it stands.
        folder: for checkpoints, made if need be; None keeps nothing on disk.
        after_step: called after each step with the time.perf_counter() at its end.
        should_stop: asked before each step.
        checkpoint_seconds: time between checkpoints.

    Raises:
        IoError: the checkpoint cannot be written.
        Error: what the job's step raises; the last checkpoint then stays as it was.
    """
    if folder is not None:
        make_folder(folder)
    began = saved = time.perf_counter()
    while job.step_number < job.steps and not should_stop():
        job.step()
        now = time.perf_counter()
        after_step(now)
        if folder is not None and now - saved > checkpoint_seconds:
            job.save(folder)
            saved = time.perf_counter()
    if folder is not None:
        job.save(folder)
    return Run(job.step_number >= job.steps, time.perf_counter() - began)


@contextmanager
def progress_bar(
    title: str, job: Job, columns: Sequence[Column] = (LOSS_COLUMN,), *, shown: bool = True
) -> Iterator[Callable[[Any], None] | None]:
    """A live bar on stderr, and the function that takes a job's progress; None if not `shown`.

    Each column shows the field of the progress that has its name.
    """
    if not shown:
        yield None
        return
    with Bar(title, job.steps, list(columns), start=job.step_number) as bar:
        names = [column.name for column in columns]
        yield lambda now: bar.update(now.step, **{name: getattr(now, name) for name in names})


@contextmanager
def run_folder(
    command: str, folder: Path | None, file_name: str, *, resume: bool, argument: str = "folder"
) -> Iterator[None]:
    """Hold `folder` for one run, which starts anew or resumes the checkpoint `file_name` there.

    Args:
        command: on whose behalf errors speak.
        folder: where the run writes; None where it writes nothing.
        file_name: of the checkpoint.
        resume: whether the run goes on from it.
        argument: what the caller calls the folder.

    Raises:
        RangeError: a checkpoint is there without `resume`, or no folder with it.
        IoError: another run holds the folder, or it cannot be made.
    """
    if folder is None:
        if resume:
            raise RangeError(message(command, "resume", "a folder to resume from", "none"))
        yield
        return
    with one_run_in(command, folder):
        if not resume and (folder / file_name).exists():
            expected, got = f"a folder without {file_name}", f"{folder}, which holds one"
            way = "add --resume to continue it" if argument.startswith("--") else "resume it"
            remedy = f"{way}, or choose another folder"
            raise RangeError(message(command, argument, expected, got, remedy))
        yield
