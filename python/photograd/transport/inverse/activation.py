"""From numbers that may be anything to parameters within bounds, and back.

    logit    p = lo + (hi - lo) / (1 + exp(-x))      dp/dx = (p - lo) (hi - p) / (hi - lo)
    log      p = lo + exp(x)                         dp/dx = p - lo

A step of gradient descent changes x, and p cannot leave its bounds. A logit suits what has two ends
(colours, roughness), a log what is positive and of any size (radiance): there a step is a factor.
Held constant: lo and hi.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from photograd_course.portable_math import exp, log, log1p, sigmoid

from photograd.types import Array

KINDS = ("logit", "log")
MARGIN = 1e-3
"""How far inside of its range a start is kept; at an end, dp/dx is 0 and nothing would move."""
LARGEST = 60.0
"""Of |x|: beyond it, exp would leave the range of what float32 parameters can be."""


@dataclass(frozen=True)
class Activation:
    """One of `KINDS` with its bounds; `hi` means nothing to a log."""

    kind: str
    lo: float
    hi: float

    def value(self, x: Array) -> Array:
        """Parameters, shape and dtype of `x`."""
        x = np.clip(x, -LARGEST, LARGEST)
        if self.kind == "log":
            return np.asarray(self.lo + exp(x))
        return np.asarray(self.lo + (self.hi - self.lo) * sigmoid(x))

    def value_backward(self, x: Array, d_value: Array) -> Array:
        """dL/dx of d_value = dL/dp, shape of `x`."""
        value = self.value(x)
        if self.kind == "log":
            return np.asarray(d_value * (value - self.lo))
        return np.asarray(d_value * (value - self.lo) * (self.hi - value) / (self.hi - self.lo))

    def inverse(self, value: Array) -> Array:
        """What gives these parameters; those on a bound are first moved inside by `MARGIN`."""
        value = np.asarray(value, np.float64)
        if self.kind == "log":
            return np.asarray(log(np.maximum(value - self.lo, MARGIN)))
        part = np.clip((value - self.lo) / (self.hi - self.lo), MARGIN, 1.0 - MARGIN)
        return np.asarray(log(part) - log1p(-part))
