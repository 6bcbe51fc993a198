"""Adam [Kingma2015]: a running mean of gradients over the root of a running mean of squares.

    m <- beta_1 m + (1 - beta_1) g                    mean
    v <- beta_2 v + (1 - beta_2) g^2                  mean square
    p <- p - rate * (m / c_1) / (sqrt(v / c_2) + epsilon),   c_i = 1 - beta_i^t

Epsilon stands outside the root and after the bias correction; t counts the steps of the group
from 1. The last line is computed as p - a m / (sqrt(v) + e) with a = rate sqrt(c_2) / c_1 and
e = epsilon sqrt(c_2), which is the same number with three fewer passes over the arrays
(section 2 of the paper reorders likewise, but leaves epsilon unscaled; here it is scaled).

With (rows, values) only the named rows are updated, moments included: masked Adam. The decay of a
row then counts its own visits, while the bias correction counts the steps of the group.
"""

from __future__ import annotations

import math
from typing import ClassVar

import numpy as np

from ..checks import FloatArray, require_number
from ..portable_math import integer_power
from .optimizer import Optimizer


class Adam(Optimizer):
    """Adaptive moments; the method that recovers most scenes in this course."""

    slots: ClassVar[tuple[str, ...]] = ("mean", "mean_square")

    def __init__(
        self, *, beta_1: float = 0.9, beta_2: float = 0.999, epsilon: float = 1e-8, threads: int = 2
    ) -> None:
        super().__init__(threads=threads)
        self.beta_1 = require_number("Adam", "beta_1", beta_1, least=0.0, most=1.0 - 1e-12)
        self.beta_2 = require_number("Adam", "beta_2", beta_2, least=0.0, most=1.0 - 1e-12)
        self.epsilon = require_number("Adam", "epsilon", epsilon, least=0.0, open_ends=True)

    def _update(
        self,
        parameter: FloatArray,
        gradient: FloatArray,
        moments: tuple[FloatArray, ...],
        scratch: FloatArray,
        learning_rate: float,
        step: int,
    ) -> None:
        mean, mean_square = moments
        root = math.sqrt(1.0 - integer_power(self.beta_2, step))
        length = learning_rate * root / (1.0 - integer_power(self.beta_1, step))
        np.multiply(mean, self.beta_1, out=mean)
        np.multiply(gradient, 1.0 - self.beta_1, out=scratch)
        np.add(mean, scratch, out=mean)
        np.multiply(mean_square, self.beta_2, out=mean_square)
        np.multiply(scratch, gradient, out=scratch)
        np.multiply(scratch, (1.0 - self.beta_2) / (1.0 - self.beta_1), out=scratch)
        np.add(mean_square, scratch, out=mean_square)
        np.sqrt(mean_square, out=scratch)
        np.add(scratch, self.epsilon * root, out=scratch)
        np.divide(mean, scratch, out=scratch)
        np.multiply(scratch, length, out=scratch)
        np.subtract(parameter, scratch, out=parameter)
