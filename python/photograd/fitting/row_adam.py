"""Adam for parameters of which a step touches few rows, in one pass of the core.

The formula is that of photograd_course.optim.Adam; a row whose gradient is zero throughout is left
alone, as if the gradient had been given as (rows, values) without it.
"""

from __future__ import annotations

import math

import numpy as np
from photograd_course.optim import Adam, Gradient
from photograd_course.portable_math import integer_power

from photograd._compiled import _core
from photograd.types import Array


class RowAdam(Adam):
    """Adam that updates only rows with a gradient; state and checks are those of Adam."""

    def _step_group(self, name: str, parameter: Array, gradient: Gradient, rate: float) -> None:
        if isinstance(gradient, tuple) or parameter.ndim < 1 or not parameter.flags.c_contiguous:
            super()._step_group(name, parameter, gradient, rate)
            return
        if name not in self._moments:
            self._moments[name] = {slot: np.zeros_like(parameter) for slot in self.slots}
            self._steps[name] = 0
        self._steps[name] += 1
        step = self._steps[name]
        root = math.sqrt(1.0 - integer_power(self.beta_2, step))
        length = rate * root / (1.0 - integer_power(self.beta_1, step))
        p, g, mean, mean_square = (
            a.reshape(len(a), -1)
            for a in (
                parameter,
                np.ascontiguousarray(gradient),
                *(self._moments[name][slot] for slot in self.slots),
            )
        )
        numbers = [self.beta_1, self.beta_2, length, self.epsilon * root]
        _core.sparse_adam(p, g, mean, mean_square, numbers)
