"""Gradient descent: p <- p - rate * g. "Stochastic" when g comes from a random part of the data."""

from __future__ import annotations

import numpy as np

from ..checks import FloatArray
from .optimizer import Optimizer


class SGD(Optimizer):
    """Plain gradient descent; it has no state besides its step counts."""

    def _update(
        self,
        parameter: FloatArray,
        gradient: FloatArray,
        moments: tuple[FloatArray, ...],  # noqa: ARG002
        scratch: FloatArray,
        learning_rate: float,
        step: int,  # noqa: ARG002
    ) -> None:
        np.multiply(gradient, learning_rate, out=scratch)
        np.subtract(parameter, scratch, out=parameter)
