"""Workers in the best isolation mode that this machine has and the assignment accepts."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from ..assignment.manifest import MODES
from ..errors import RangeError, message
from .workers import PlainWorkers, Workers


class NoMode(Exception):
    """No mode is good enough; the text is for staff."""


@contextlib.contextmanager
def open_workers(minimum: str, only: str | None, jobs: int) -> Iterator[Workers]:
    """Workers for as long as the context lasts.

    Args:
        minimum: the weakest mode whose verdicts may count.
        only: this mode and no other.
        jobs: how many workers run at the same time.

    Raises:
        RangeError: `only` is no mode.
        NoMode: none is good enough.
    """
    del jobs
    if only is not None and only not in MODES:
        raise RangeError(message("grade", "--mode", f"one of {MODES}", repr(only)))
    mode = only or "E"
    if mode > minimum or mode != "E":
        raise NoMode(f"this assignment asks for isolation mode {minimum} or better, here is E")
    with PlainWorkers() as workers:
        yield workers
