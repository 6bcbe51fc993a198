"""RMSProp [Tieleman2012]: each element is scaled by the root of its running mean square.

    s <- decay * s + (1 - decay) * g^2
    p <- p - rate * g / (sqrt(s) + epsilon)

Epsilon stands outside the root. There is no bias correction: s starts at 0, and the first step is
1 / sqrt(1 - decay) rates long.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from ..checks import FloatArray, require_number
from .optimizer import Optimizer


class RMSProp(Optimizer):
    """Gradient descent with a step length of its own for each element."""

    slots: ClassVar[tuple[str, ...]] = ("mean_square",)

    def __init__(self, *, decay: float = 0.99, epsilon: float = 1e-8, threads: int = 2) -> None:
        super().__init__(threads=threads)
        self.decay = require_number("RMSProp", "decay", decay, least=0.0, most=1.0)
        self.epsilon = require_number("RMSProp", "epsilon", epsilon, least=0.0, open_ends=True)

    def _update(
        self,
        parameter: FloatArray,
        gradient: FloatArray,
        moments: tuple[FloatArray, ...],
        scratch: FloatArray,
        learning_rate: float,
        step: int,  # noqa: ARG002
    ) -> None:
        (mean_square,) = moments
        np.multiply(gradient, gradient, out=scratch)
        np.multiply(scratch, 1.0 - self.decay, out=scratch)
        np.multiply(mean_square, self.decay, out=mean_square)
        np.add(mean_square, scratch, out=mean_square)
        np.sqrt(mean_square, out=scratch)
        np.add(scratch, self.epsilon, out=scratch)
        np.divide(gradient, scratch, out=scratch)
        np.multiply(scratch, learning_rate, out=scratch)
        np.subtract(parameter, scratch, out=parameter)
