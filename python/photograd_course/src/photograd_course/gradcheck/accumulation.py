"""Backward functions that take buffers must add into them: a parameter may be used many times."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..checks import require_number
from .probes import AccumulatingBackward, Outputs, copy_outputs, copy_parameters
from .reports import AccumulationReport


def check_accumulation(
    accumulate: AccumulatingBackward,
    parameters: Mapping[str, Any],
    d_outputs: Outputs,
    *,
    tolerance: float = 1e-12,
) -> AccumulationReport:
    """Call an accumulating backward once, then twice more into other buffers, and expect twice.

    Args:
        accumulate: `accumulate(parameters, d_outputs, d_parameters)` adds into the buffers.
        parameters: {group: float64 array}.
        d_outputs: the cotangent, in the form of the function's output.
        tolerance: largest norm-relative difference; 1e-12 leaves room for another order of the
            same additions and is far below any missing term.

    Returns:
        A report; it fails as an empty test when the first call leaves a buffer at zero.
    """
    tolerance = require_number("check_accumulation", "tolerance", tolerance, least=0.0)
    base = copy_parameters("check_accumulation", parameters)
    totals = []
    for calls in (1, 2):
        buffers = {name: np.zeros_like(value) for name, value in base.items()}
        for _ in range(calls):
            copies = {name: value.copy() for name, value in base.items()}
            accumulate(copies, copy_outputs(d_outputs), buffers)
        totals.append(buffers)
    errors, empty = [], []
    for name in base:
        doubled = 2.0 * totals[0][name]
        size = float(np.linalg.norm(doubled))
        gap = float(np.linalg.norm(totals[1][name] - doubled))
        if size == 0.0:
            empty.append(name)
        errors.append((name, gap if size == 0.0 else gap / size))
    wrong = [name for name, error in errors if not error <= tolerance]
    reason = ""
    if wrong:
        reason = f"the second call did not add as much as the first for {', '.join(wrong)}"
    elif empty:
        reason = f"empty test: the gradient is zero for {', '.join(empty)}"
    return AccumulationReport(tuple(errors), tolerance, not reason, reason)
