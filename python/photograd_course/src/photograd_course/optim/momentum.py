"""Heavy ball [Polyak1964]: velocity <- decay * velocity + g, then p <- p - rate * velocity.

The velocity is a sum, not a mean: under a constant gradient it grows to g / (1 - decay), so a rate
that suits plain descent must be multiplied by about (1 - decay).
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from ..checks import FloatArray, require_number
from .optimizer import Optimizer


class Momentum(Optimizer):
    """Gradient descent with a velocity; rows without a gradient keep theirs and do not move."""

    slots: ClassVar[tuple[str, ...]] = ("velocity",)

    def __init__(self, *, decay: float = 0.9, threads: int = 2) -> None:
        super().__init__(threads=threads)
        self.decay = require_number("Momentum", "decay", decay, least=0.0, most=1.0)

    def _update(
        self,
        parameter: FloatArray,
        gradient: FloatArray,
        moments: tuple[FloatArray, ...],
        scratch: FloatArray,
        learning_rate: float,
        step: int,  # noqa: ARG002
    ) -> None:
        (velocity,) = moments
        np.multiply(velocity, self.decay, out=velocity)
        np.add(velocity, gradient, out=velocity)
        np.multiply(velocity, learning_rate, out=scratch)
        np.subtract(parameter, scratch, out=parameter)
