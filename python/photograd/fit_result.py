"""What a fit reports: after each step, and when it ends."""

from __future__ import annotations

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
    rays_per_second: float


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
