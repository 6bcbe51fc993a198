"""The options of each representation, and what a fit reports."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from photograd_course.suggest import choose_from

from photograd import _descend as descent
from photograd._fit_options import FitOptions
from photograd.errors import DtypeError, RangeError, message
from photograd.fields import fittable


def options_for(representation: str, **given: Any) -> FitOptions:
    """The options of a representation: its defaults, but for what is given and not None.

    Args:
        representation: its name.
        given: fields of `FitOptions`; None leaves the default.

    Raises:
        DtypeError: a name that is no option; names the nearest.
        RangeError: a value without meaning.
    """
    known_options = {field.name for field in fields(FitOptions)} - {"representation"}
    for name in sorted(set(given) - known_options):
        expected, remedy = "an option of FitOptions", choose_from(name, known_options)
        raise DtypeError(message("fit", name, expected, "an unknown name", remedy))
    chosen = {name: value for name, value in given.items() if value is not None}
    known = fittable().get(representation)
    defaults = {} if known is None else known.fit_defaults
    return FitOptions(**{"representation": representation, **defaults, **chosen})


def users_of(option: str) -> tuple[str, ...]:
    """The representations on which an option has an effect."""
    special = any(option in kind.fit_options for kind in fittable().values())
    return tuple(
        name for name, kind in fittable().items() if not special or option in kind.fit_options
    )


def refuse_without_effect(
    representation: str, options: Collection[str], *, prefix: str = ""
) -> None:
    """Raise RangeError for an option that has no effect on a representation.

    Args:
        representation: its name.
        options: names of those that are given.
        prefix: "--" on a command line.
    """
    for name in options:
        users = users_of(name)
        if representation not in users:
            expected = f"a fit of {' or '.join(users)}"
            remedy = "leave it out, it has no effect here"
            argument = prefix + name.replace("_", "-") if prefix else name
            raise RangeError(message("fit", argument, expected, repr(representation), remedy))


# What a fit reports: after each step, and when it ends.


@dataclass(frozen=True)
class Progress(descent.Progress):
    """What a progress display gets after a step of a fit."""

    psnr: float  # of the batch, on the values the loss is taken on, in dB
    resolution: int
    rays_per_second: float  # over the last steps, see Pace


class Pace:
    """Rays per second over at least the last `steps` steps and `seconds`, or since the start.

    A display that is refreshed by the clock asks most often after a step that took long, since that
    is when the time is up. The pace of that step alone says nothing about the others.
    """

    def __init__(self, now: float, *, steps: int = 32, seconds: float = 5.0) -> None:
        self._steps, self._seconds = steps, seconds
        self._rays = 0
        self._marks = deque([(now, 0)])  # time, and rays until then

    def after(self, rays: int, now: float) -> float:
        """The pace after a step of so many rays that ended at this time, in seconds.

        Args:
            rays: of the step.
            now: in seconds.
        """
        marks = self._marks
        self._rays += rays
        marks.append((now, self._rays))
        while len(marks) > self._steps + 1 and now - marks[1][0] >= self._seconds:
            marks.popleft()
        began, before = marks[0]
        return (self._rays - before) / max(now - began, 1e-9)


@dataclass(frozen=True)
class FitResult:
    """How a fit ended."""

    path: Path
    step: int
    finished: bool
    seconds: float
    loss: float


def summary(result: FitResult) -> dict[str, Any]:
    """A fit's result for the machine-readable last line."""
    return {
        "model": str(result.path),
        "step": result.step,
        "finished": result.finished,
        "seconds": round(result.seconds, 3),
        "loss": result.loss,
    }
