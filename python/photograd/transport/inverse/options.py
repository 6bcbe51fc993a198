"""What a recovery can be told, and what it reports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, get_args

from photograd._checks import require_bounds, require_choices
from photograd._typed import typed_call
from photograd.transport.path_options import PathOptions
from photograd.transport.scene import Scene
from photograd.types import Array

Loss = Literal["relative", "squared"]
LOSSES: tuple[Loss, ...] = get_args(Loss)


@typed_call
@dataclass(frozen=True)
class RecoveryOptions:
    """How parameters are found.

    Attributes:
        steps: of gradient descent.
        spp: samples a pixel of each of the two halves of a step (`dual_buffer_loss`); powers of two
            are spread most evenly.
        learning_rate: of Adam, in units of logits and logarithms: about what a step changes at
            first.
        final_rate: the part of it that is left at the last step; in between it falls evenly, by a
            factor a step. What noise moves the result about is in proportion to it.
        loss: "squared" difference of radiance, or "relative": divided by the target plus its
            channel's mean.
        views: pictures that a step looks at, drawn at random; 0 looks at all.
        resample_every: steps after which the tracer is built again where a light is a parameter, so
            that lights and texels are asked as often as their brightness now warrants.
        path: options of the path tracer.
        seed: of all random numbers, 0 to 2^64 - 1.

    Raises:
        RangeError: counts below 1, rates that are not positive, an unknown loss.
    """

    steps: int = 200
    spp: int = 8
    learning_rate: float = 0.2
    final_rate: float = 0.02
    loss: Loss = "relative"
    views: int = 0
    resample_every: int = 50
    path: PathOptions = field(default_factory=lambda: PathOptions(max_depth=8))
    seed: int = 0

    def __post_init__(self) -> None:
        require_choices(self)
        require_bounds(self, "steps", "spp", "resample_every", low=1)
        require_bounds(self, "views", low=0)
        require_bounds(self, "learning_rate", above=0)
        require_bounds(self, "final_rate", above=0, high=1)
        require_bounds(self, "seed", low=0, high=2**64 - 1)


# What is reported at the end.


@typed_call
@dataclass(frozen=True, eq=False)
class RecoveryResult:
    """What was found.

    Attributes:
        params: {name: value} of what was found, float64.
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
