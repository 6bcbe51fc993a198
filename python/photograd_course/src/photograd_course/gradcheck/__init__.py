"""Is this hand-written gradient right? Three questions that only the right gradient survives.

* `check_gradient`: does it agree with central differences, group by group?
* `taylor_slope`: does the remainder f(x + h v) - f(x) - h g.v shrink like h squared?
* `dot_product_error`: are the forward and the backward derivative transposes of each other?
* `check_accumulation`: does a backward pass add into its buffers instead of overwriting them?

All of them work in float64, draw their own random cotangent (never ones, which would hide a
permutation), and return a report that is true only if the check passed and prints as a table.
"""

from __future__ import annotations

from .accumulation import check_accumulation
from .differences import STEPS, check_gradient
from .dot_product import dot_product_error
from .probes import AccumulatingBackward, Arrays, Backward, Function, Outputs, contract, draw_like
from .reports import AccumulationReport, DotProductReport, GradientReport, GroupReport, TaylorReport
from .taylor import taylor_slope

__all__ = [
    "STEPS",
    "AccumulatingBackward",
    "AccumulationReport",
    "Arrays",
    "Backward",
    "DotProductReport",
    "Function",
    "GradientReport",
    "GroupReport",
    "Outputs",
    "TaylorReport",
    "check_accumulation",
    "check_gradient",
    "contract",
    "dot_product_error",
    "draw_like",
    "taylor_slope",
]
