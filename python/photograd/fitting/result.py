"""What a fit reports: after each step, and when it ends."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Progress:
    """What a progress display gets after a step."""

    step: int
    steps: int
    loss: float
    psnr: float  # of the batch, on the values the loss is taken on
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
        """The pace after a step of so many rays that ended at this time, in seconds."""
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
        "model": str(result.path), "step": result.step, "finished": result.finished,
        "seconds": round(result.seconds, 3), "loss": result.loss,
    }  # fmt: skip
