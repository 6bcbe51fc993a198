"""The driver of every gradient descent: steps, checkpoints, progress, one run in a folder.

    with run_folder("fit", folder, "model.npz", resume=resume):  # locked
        with progress_bar("fit", job, COLUMNS) as on_step:
            return descend(job, folder, result_of, after_step=show(on_step))

What a step does, and what a checkpoint holds, is the job's. A job whose random numbers are a
function of its seed and the step, and whose checkpoint holds everything else that a step depends
on, ends with the same bits whether it was interrupted or not.

Whatever ends a descent early, Ctrl-C, a notebook's interrupt or an exception of a callback, what it
has found is saved, and the exception has it as `partial_result`:

    try:
        model = photograd.fit(capture, folder="model")
    except KeyboardInterrupt as stopped:
        model = stopped.partial_result
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, TypeVar

from photograd_course.cli import Column
from photograd_course.cli import Progress as Bar

from photograd._checkpoint import holds_steps, make_folder
from photograd._run_lock import one_run_in
from photograd._signals import stop_on_signals
from photograd.errors import Error, IoError, RangeError, message

LOSS_COLUMN = Column("loss", "{:.2e}".format)
R = TypeVar("R")


@dataclass(frozen=True)
class Progress:
    """What a progress display gets after a step."""

    step: int
    steps: int
    loss: float


class Job(Protocol):
    """What `descend` drives: a descent that knows how to do a step and how to be saved.

    Attributes:
        step_number: how many steps were done.
        changing: whether a step has begun to change parameters and has not yet ended: what an
            exception leaves then is between two steps, and no state to go on from.
    """

    step_number: int
    changing: bool

    @property
    def steps(self) -> int:
        """Steps of the whole descent."""

    def step(self) -> float:
        """Do one step; returns the loss before it."""

    def save(self, folder: Path) -> Path:
        """Write the checkpoint atomically; returns its file."""


@dataclass(frozen=True)
class Run:
    """How a call of `descend` ended."""

    finished: bool
    seconds: float


def descend(
    job: Job,
    folder: Path | None,
    result: Callable[[Run], R],
    *,
    after_step: Callable[[float], None] = lambda _: None,
    should_stop: Callable[[], bool] = lambda: False,
    checkpoint_seconds: float = 30.0,
) -> R:
    """Step until the end or until `should_stop`; the folder then holds the checkpoint.

    A signal that would end the program is heard after the step that it arrives in, and acts once
    the checkpoint is written: Ctrl-C raises KeyboardInterrupt.

    Args:
        job: goes on where it stands.
        folder: for checkpoints, made if need be; None keeps nothing on disk.
        result: what the call returns. Also of a run that an exception has ended: it is the
            exception's `partial_result`, unless the exception is an `Error` of a step, which says
            that the numbers have gone wrong.
        after_step: called after each step with the time.perf_counter() at its end.
        should_stop: asked before each step.
        checkpoint_seconds: time between checkpoints; one lies there before the first step, too.

    Raises:
        IoError: the checkpoint cannot be written.
        Error: what the job's step raises; the last checkpoint then stays as it was.
        BaseException: what a callback raises, and KeyboardInterrupt, after the steps that were done
            are saved; of a step that it cut short, what the last checkpoint holds is kept.
    """
    _require_whole(job)
    began = saved = time.perf_counter()
    saved_step, stepping = -1, False
    file: Path | None = None

    def save() -> None:
        nonlocal file, saved, saved_step
        if folder is not None and saved_step != job.step_number:
            file = job.save(folder)
            saved, saved_step = time.perf_counter(), job.step_number

    def found() -> R:
        return result(Run(job.step_number >= job.steps, time.perf_counter() - began))

    def kept() -> bool:
        """Whether what was found is worth keeping; it is saved, if that can be done."""
        try:
            if not job.changing:
                save()
        except IoError:
            return True  # the last checkpoint stays as it was
        except Error:
            return False
        return True

    try:
        if folder is not None:
            make_folder(folder)
        with stop_on_signals() as stopping:
            if job.step_number == 0:
                save()
            while job.step_number < job.steps and not (stopping() or should_stop()):
                stepping = True
                job.step()
                stepping = False
                now = time.perf_counter()
                after_step(now)
                if now - saved > checkpoint_seconds:
                    save()
            save()
        stopping.deliver()
    except BaseException as failure:
        if not (stepping and isinstance(failure, Error)) and kept():
            with suppress(Exception):  # a second failure would hide the first
                attach(failure, found())
        elif file is not None and saved_step == 0:
            file.unlink(missing_ok=True)
        raise
    return found()


def _require_whole(job: Job) -> None:
    if job.changing:
        got, remedy = "one whose step was cut short", "resume its checkpoint"
        raise Error(message("descend", "job", "a descent between two steps", got, remedy))


@contextmanager
def changing(job: Job) -> Iterator[None]:
    """Around what a step does to the job's state, the number of the step included."""
    job.changing = True
    yield
    job.changing = False


def attach(failure: BaseException, partial_result: object) -> None:
    """Give an exception what had been found when it ended a descent.

    Args:
        failure: to be raised again.
        partial_result: what the function would have returned, so far.
    """
    vars(failure)["partial_result"] = partial_result


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
        RangeError: a checkpoint of a step is there without `resume`, or no folder with it.
        IoError: another run holds the folder, or it cannot be made.
    """
    if folder is None:
        if resume:
            raise RangeError(message(command, "resume", "a folder to resume from", "none"))
        yield
        return
    with one_run_in(command, folder, file_name, argument=argument):
        if not resume and holds_steps(folder / file_name):
            expected, got = f"a folder without {file_name}", f"{folder}, which holds one"
            way = "add --resume to continue it" if argument.startswith("--") else "resume it"
            remedy = f"{way}, or choose another folder"
            raise RangeError(message(command, argument, expected, got, remedy))
        yield
