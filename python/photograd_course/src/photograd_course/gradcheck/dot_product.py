"""Forward and backward derivative are transposes: <J v, w> = <v, J^T w> for all v and w.

Both sides are exact up to rounding, so this is the sharpest of the checks; but it needs J v from
somewhere else than the backward pass: dual numbers, or the function itself where it is linear.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ..checks import require_integer, require_number
from .probes import (
    Arrays,
    Backward,
    Outputs,
    call_backward,
    contract,
    copy_parameters,
    draw_cotangents,
    draw_like,
)
from .reports import DotProductReport

ForwardDerivative = Callable[[Arrays, Arrays], Outputs]


def dot_product_error(
    forward_derivative: ForwardDerivative,
    gradient: Backward,
    parameters: Mapping[str, Any],
    *,
    seed: int,
    tolerance: float = 1e-10,
    pairs: int = 4,
) -> DotProductReport:
    """Compare <J v, w> with <v, J^T w> for random pairs (test kind T3).

    Args:
        forward_derivative: `forward_derivative(parameters, directions)` returns J v, in the form
            of the function's output, for a direction of every group.
        gradient: `gradient(parameters, d_output)` returns {group: J^T w}.
        parameters: {group: float64 array}.
        seed: of the pairs.
        tolerance: largest relative difference; 1e-10 in general, 1e-12 for linear stages.
        pairs: number of pairs; each group is probed on its own, with zero directions elsewhere,
            so that a small group cannot hide behind a large one.

    Raises:
        DtypeError, ShapeError, RangeError: arguments of the wrong form.
    """
    tolerance = require_number("dot_product_error", "tolerance", tolerance, least=0.0)
    pairs = require_integer("dot_product_error", "pairs", pairs, least=1)
    base = copy_parameters("dot_product_error", parameters)
    worst = dict.fromkeys(base, 0.0)
    alive = dict.fromkeys(base, False)
    for pair in range(pairs):
        gradients: Arrays | None = None
        for number, name in enumerate(base):
            directions = {key: np.zeros_like(value) for key, value in base.items()}
            directions[name] = draw_like(base[name].shape, seed=seed, stream=number, lane=pair)
            copies = {key: value.copy() for key, value in base.items()}
            forward = forward_derivative(copies, directions)
            cotangents = draw_cotangents(forward, seed=seed, lane=pair)
            if gradients is None:
                gradients = call_backward("dot_product_error", gradient, base, cotangents)
            left = contract(forward, cotangents)
            right = float(np.sum(directions[name] * gradients[name]))
            size = max(abs(left), abs(right))
            error = 0.0 if size == 0.0 else abs(left - right) / size
            alive[name] = alive[name] or size != 0.0
            worst[name] = float(np.maximum(worst[name], error))  # unlike max, keeps NaN
    return _judge(worst, alive, tolerance)


def _judge(worst: dict[str, float], alive: dict[str, bool], tolerance: float) -> DotProductReport:
    error = float(np.max(list(worst.values())))
    dead = [name for name, lives in alive.items() if not lives]
    reason = ""
    if not error <= tolerance:
        reason = f"error {error:.1e} exceeds {tolerance:.0e}"
    elif dead:
        reason = f"empty test: both products are zero for {', '.join(dead)}"
    return DotProductReport(tuple(worst.items()), error, tolerance, not reason, reason)
