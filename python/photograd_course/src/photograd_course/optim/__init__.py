"""Optimizers over a dictionary of arrays, one method a file.

All share `Optimizer.step(params, gradients, learning_rates)`, which changes the arrays in place:
views with strides, float32 or float64, a learning rate for each group, gradients dense or as
(rows, values). State is a dictionary of arrays, and follows a `RowMap` or a resampling.
"""

from __future__ import annotations

from ..row_map import FRESH, RowMap
from .adam import Adam
from .gradients import Gradient, merge_rows
from .momentum import Momentum
from .optimizer import Optimizer
from .rmsprop import RMSProp
from .sgd import SGD

__all__ = [
    "FRESH",
    "SGD",
    "Adam",
    "Gradient",
    "Momentum",
    "Optimizer",
    "RMSProp",
    "RowMap",
    "merge_rows",
]
