"""The remainder of the first-order expansion must shrink four times when the step is halved.

R(h) = |L(x + h v) - L(x) - h g.v| = h^2 |v.H v| / 2 + O(h^3) for the right gradient g, and of first
order for a wrong one. No step has to be chosen and no tolerance on g is needed: only the slope of
log R over log h counts, read where the steps are as fine as rounding allows, since there even a
small error of g dominates.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..checks import require_integer, require_number
from .probes import (
    Backward,
    Function,
    call_backward,
    contract,
    copy_parameters,
    draw_cotangents,
    draw_like,
    group_scale,
    named_outputs,
)
from .reports import TaylorReport

_WINDOW = 4
# A slope read from remainders 400 ulps of L or larger is off by less than log2(1 + 1/40) = 0.04,
# when L itself is right to 10 ulps.
_ROUNDING = 400.0 * float(np.finfo(np.float64).eps)


def taylor_slope(
    function: Function,
    gradient: Backward,
    parameters: Mapping[str, Any],
    *,
    seed: int,
    start: float = 0.1,
    halvings: int = 24,
    tolerance: float = 0.1,
) -> TaylorReport:
    """Measure the order of the Taylor remainder along one random direction (test kind T2).

    Args:
        function, gradient, parameters, seed: as for `check_gradient`; all groups move together.
        start: largest step, in units of the root mean square of each group.
        halvings: how often the step is halved.
        tolerance: how far each of the four finest slopes may lie from 2.

    Returns:
        A report. A linear function has no remainder at any step: `linear` says so, and it passes,
        because a wrong gradient would show a remainder proportional to the step.

    Raises:
        DtypeError, ShapeError, RangeError: parameters, outputs or gradients of the wrong form.
    """
    start = require_number("taylor_slope", "start", start, least=0.0, open_ends=True)
    halvings = require_integer("taylor_slope", "halvings", halvings, least=_WINDOW)
    base = copy_parameters("taylor_slope", parameters)
    outputs = function({name: value.copy() for name, value in base.items()})
    cotangents = draw_cotangents(outputs, seed=seed)
    gradients = call_backward("taylor_slope", gradient, base, cotangents)
    directions = {
        name: group_scale(value) * draw_like(value.shape, seed=seed, stream=number)
        for number, (name, value) in enumerate(base.items())
    }
    slope = float(sum(np.sum(gradients[name] * directions[name]) for name in base))
    center = contract(outputs, cotangents)
    terms, weights = (named_outputs("taylor_slope", part) for part in (outputs, cotangents))
    size = float(sum(np.sum(np.abs(terms[name] * weights[name])) for name in terms))
    steps, remainders, sizes = [], [], []
    for halving in range(halvings + 1):
        step = start * 2.0**-halving
        moved = {name: np.asarray(base[name] + step * directions[name]) for name in base}
        change = contract(function(moved), cotangents) - center
        steps.append(step)
        remainders.append(abs(change - step * slope))
        sizes.append(size + abs(step * slope))
    empty = size == 0.0 or slope == 0.0
    return _judge(steps, remainders, sizes, tolerance, empty)


def _judge(
    steps: list[float], remainders: list[float], sizes: list[float], tolerance: float, empty: bool
) -> TaylorReport:
    floors = [_ROUNDING * size for size in sizes]
    finite = all(math.isfinite(value) for value in [*remainders, *sizes])
    linear = finite and all(r <= floor for r, floor in zip(remainders, floors, strict=True))
    slopes = []
    for k in range(len(steps) - 1):
        if not (remainders[k] > floors[k] and remainders[k + 1] > floors[k + 1]):
            break
        slopes.append(math.log2(remainders[k] / remainders[k + 1]))
    finest = slopes[-_WINDOW:]
    slope = sum(finest) / _WINDOW if len(finest) == _WINDOW else math.nan
    reason = ""
    if not finite:
        reason = "a value is not finite"
    elif empty:
        reason = "empty test: the output or the directional derivative is zero"
    elif linear:
        reason = ""
    elif len(finest) < _WINDOW:
        reason = f"only {len(finest)} halvings above rounding, {_WINDOW} needed"
    elif not all(abs(value - 2.0) <= tolerance for value in finest):
        reason = f"a slope is further than {tolerance:g} from 2"
    return TaylorReport(
        tuple(steps), tuple(remainders), tuple(slopes), slope, linear, tolerance, not reason, reason
    )
