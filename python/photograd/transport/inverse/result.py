"""What a recovery reports: after each step, and when it ends."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from photograd.transport.scene import Scene
from photograd.types import Array


@dataclass(frozen=True)
class Progress:
    """What a progress display gets after a step; `loss` is the running mean of the last ones."""

    step: int
    steps: int
    loss: float


@dataclass(frozen=True, eq=False)
class RecoveryResult:
    """What was found.

    Attributes:
        params: {name: value} of the unknowns, float64.
        scene: with these values.
        history: (steps, 3): step, loss, learning rate. The loss is that of two half pictures: right
            on average, and below 0 now and then near the end.
        curves: {name: (steps + 1, k)}, the value before the first and after each step; of more than
            16 numbers the mean of each channel.
        step: how many steps were done.
        finished: whether that is all of them.
        seconds: of the last run.
    """

    params: Mapping[str, Array]
    scene: Scene
    history: Array
    curves: Mapping[str, Array]
    step: int
    finished: bool
    seconds: float
