"""A fit that goes on while `photograd view` shows it: from inside, or from its folder.

From inside, arrays are copied between two steps and everything else happens elsewhere: the fit's
numbers do not depend on whether anybody looks.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Protocol

import numpy as np
from photograd_course.cli import note

from photograd._checkpoint import FILE_NAME
from photograd._fit_options import FitOptions
from photograd.commands.view_drawing import Shown, Viewed, refined, shown_field, viewed_file
from photograd.commands.view_server import LOOPBACK, Page, free_port
from photograd.errors import Error
from photograd.fitting.data import learned_background
from photograd.fitting.drawing import draw_field
from photograd.fitting.loop import Fit
from photograd.fitting.model import load_snapshots
from photograd.representation import Fittable

FIRST_PORT = 8080
SECONDS = 2.0
"""Between two looks at a running fit."""


class Watched(Protocol):
    """What shows a fit: a `Page`, or in tests something smaller."""

    @property
    def watched(self) -> bool:
        """Whether anybody looks, and has seen what there is."""

    def replace(self, viewed: Viewed, said: str = "") -> None:
        """Show a newer state.

        Args:
            viewed: as it is now.
            said: about it.
        """


def frozen_copy(field: Fittable, options: FitOptions) -> Callable[[], Fittable]:
    """A field as it is now, made when it is asked for: the way of a checkpoint, without a file.

    Args:
        field: of a fit that goes on.
        options: of the fit.
    """
    params = {name: np.array(values) for name, values in field.params.items()}
    state = {name: np.array(values) for name, values in field.state().items()}
    policy, kind = json.dumps(asdict(field.policy)), type(field)

    @cache
    def restored() -> Fittable:
        return kind.restored(params, state, json.loads(policy), options)

    return restored


def viewed_fit(job: Fit) -> Viewed:
    """A running fit as it is now; its arrays are copied.

    Args:
        job: between two steps.
    """
    copied = frozen_copy(job.model, job.options)
    raw = job.background
    behind = None if raw is None else learned_background(raw.astype(np.float64))
    draw = refined(lambda camera: draw_field(copied(), behind, camera))
    return Viewed(job.model.box, Shown(draw, copied, behind))


class FitView:
    """Shows a running fit on a page, every two seconds while somebody looks."""

    def __init__(self, page: Watched, seconds: float = SECONDS) -> None:
        """Begin at once.

        Args:
            page: where it is shown.
            seconds: between two looks.
        """
        self._page, self._seconds, self._next = page, seconds, 0.0

    def look(self, job: Fit) -> None:
        """Show the fit as it is now, if it is time.

        Args:
            job: between two steps.
        """
        now = time.monotonic()
        if now < self._next or not self._page.watched:
            return
        self._next = now + self._seconds
        try:
            self._page.replace(viewed_fit(job), words(job))
        except Exception as failure:  # of a page: no reason for a fit of hours to end
            note(f"warning: the page is not shown any more: {failure}", style="yellow")
            self._next = math.inf


@contextmanager
def shown_in_browser(job: Fit, out: Path, *, view: bool) -> Iterator[Callable[[Fit], None]]:
    """A page that shows a running fit until it ends; gives what is called after each step.

    Args:
        job: before its first step.
        out: its folder.
        view: whether there is a page; without one, nothing is done after a step.

    Raises:
        IoError: viser is not installed, or no port is free.
    """
    if not view:
        yield lambda _: None
        return
    port = free_port(LOOPBACK, FIRST_PORT, exact=False)
    page = Page(viewed_fit(job), job.capture, port=port)
    note(f"{page.address} shows the fit until it ends; 'photograd view {out}' goes on")
    try:
        yield FitView(page).look
    finally:
        page.close()


def words(job: Fit) -> str:
    """How far a fit is.

    Args:
        job: between two steps.
    """
    said = f"step {job.step_number} of {job.options.steps}"
    return f"{said}, loss {job.history[-1][1]:.3g}" if job.history else said


class FolderView:
    """Looks at the folder of a fit that another process runs, and shows what it has saved."""

    def __init__(self, folder: Path, seconds: float = SECONDS) -> None:
        """Remember what the folder holds.

        Args:
            folder: of the fit.
            seconds: between two looks.
        """
        self._folder, self._seconds = folder, seconds
        self._next, self._known = time.monotonic() + seconds, saved_files(folder)

    def look(self, page: Watched) -> None:
        """Show what is new, if it is time and something is.

        A file that cannot be read is left for the next look.

        Args:
            page: where it is shown.
        """
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + self._seconds
        found = saved_files(self._folder)
        if found == self._known:
            return
        try:
            viewed = viewed_folder(self._folder)
        except Error:
            return
        self._known = found
        page.replace(viewed, f"step {max(viewed.steps, default=0)} or later, as it was saved last")


def saved_files(folder: Path) -> dict[str, int]:
    """{name: time of the last change} of the checkpoint and the snapshots of a fit.

    Args:
        folder: of the fit.
    """
    found = {}
    for path in (folder / FILE_NAME, *sorted((folder / "snapshots").glob("step_*.npz"))):
        try:
            found[path.name] = path.stat().st_mtime_ns
        except OSError:  # not yet, or no longer
            continue
    return found


def viewed_folder(folder: Path) -> Viewed:
    """The folder of a fit, also before its first checkpoint, when there are snapshots alone.

    Args:
        folder: of the fit.

    Raises:
        IoError: what `load_model` raises.
    """
    if (folder / FILE_NAME).exists():
        return viewed_file(folder)
    fields = load_snapshots(folder)
    steps = {step: shown_field(field, None) for step, field in fields.items()}
    last = max(fields)
    return Viewed(fields[last].box, steps[last], steps=steps)


def is_fit(folder: Path) -> bool:
    """Whether a folder is that of a fit, finished or running.

    Args:
        folder: that may be a capture, too.
    """
    return folder.is_dir() and bool(saved_files(folder))
