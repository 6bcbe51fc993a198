"""The gradient against central differences, group by group, at the best of several steps.

For a direction v the difference quotient is D = (L(x + h v) - L(x - h v)) / (2 h), and the gradient
g must give g.v. Large h costs truncation (h squared), small h costs rounding (1 / h); nobody knows
the best h beforehand, so six decades are swept, from the middle outwards, until one agrees.

The error is relative to the norm of the whole probe vector. A cosine would hide wrong factors, an
absolute tolerance would pass zeros, and `error <= tolerance` fails for NaN as it should.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..checks import require_integer, require_number
from ..errors import RangeError, message
from ..random import choice
from .probes import (
    Arrays,
    Backward,
    Float64,
    Function,
    Outputs,
    call_backward,
    contract,
    copy_parameters,
    draw_cotangents,
    draw_like,
    group_scale,
    named_outputs,
)
from .reports import GradientReport, GroupReport

Probe = tuple[NDArray[np.int64] | None, Float64]  # (flat index, or None for a dense one; direction)

STEPS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)
"""The default sweep, in units of the root mean square of each group."""


def check_gradient(
    function: Function,
    gradient: Backward,
    parameters: Mapping[str, Any],
    *,
    seed: int,
    tolerance: float = 1e-6,
    directions: int = 8,
    coordinates: int = 32,
    steps: tuple[float, ...] = STEPS,
    may_be_zero: Collection[str] = (),
) -> GradientReport:
    """Compare a hand-written gradient with central differences (test kind T1).

    Args:
        function: maps the parameters to a float, a float64 array, or a mapping of float64 arrays.
        gradient: `gradient(parameters, d_output)` returns {group: dL/dgroup} for a cotangent of
            the same form as the output; the check draws a random one.
        parameters: {group: float64 array}; copied, never changed. Keep them away from kinks.
        seed: of cotangent, directions and coordinates.
        tolerance: largest norm-relative error; 1e-6 suits smooth functions in float64.
        directions, coordinates: probes per group; half of the coordinates are drawn where the
            gradient is not zero, so that a sparse gradient is not tested on its zeros alone.
        steps: the sweep, relative to the root mean square of each group. The middle ones are tried
            first, and a group is done with the first that agrees.
        may_be_zero: groups whose gradient is rightly zero here; both sides must then be zero.

    Returns:
        A report for each group. A test in which nothing happens fails as an empty test: the
        output is all zeros, or gradient and differences are both zero.

    Raises:
        DtypeError, ShapeError, RangeError: parameters, outputs or gradients of the wrong form.
    """
    tolerance = require_number("check_gradient", "tolerance", tolerance, least=0.0)
    require_integer("check_gradient", "directions", directions, least=1)
    require_integer("check_gradient", "coordinates", coordinates, least=1)
    if not steps or not all(step > 0.0 for step in steps):
        raise RangeError(message("check_gradient", "steps", "positive numbers", steps))
    copies = copy_parameters("check_gradient", parameters)
    outputs = function({name: value.copy() for name, value in copies.items()})
    cotangents = draw_cotangents(outputs, seed=seed)
    gradients = call_backward("check_gradient", gradient, copies, cotangents)
    dead = _dead_output(outputs)
    groups = []
    for number, (name, slope) in enumerate(gradients.items()):
        probes = _draw_probes(slope, seed, number, directions, coordinates)
        measure = partial(_differences, function, cotangents, copies, name, probes)
        differences = _sweep(measure, slope, probes, steps, tolerance)
        groups.append(_judge(name, slope, differences, tolerance, dead, name in may_be_zero))
    return GradientReport(tuple(groups), tolerance, seed)


def _dead_output(outputs: Outputs) -> str:
    """Why the outputs make the test empty, or an empty string."""
    arrays = named_outputs("check_gradient", outputs)
    for name, array in arrays.items():
        if not np.isfinite(array).all():
            return f"the {name} is not finite"
        if not array.any():
            return f"empty test: the {name} is all zeros"
    return "" if arrays else "empty test: there is no output"


def _draw_probes(
    slope: Float64, seed: int, number: int, directions: int, coordinates: int
) -> list[Probe]:
    """Probe vectors: (None, dense direction) and (flat index, ones) for single coordinates."""
    probes: list[Probe] = [
        (None, draw_like(slope.shape, seed=seed, stream=number, lane=lane))
        for lane in range(directions)
    ]
    support = np.flatnonzero(slope)
    half = choice(seed, support.size, min(support.size, coordinates // 2), step=number, dimension=1)
    rest = choice(seed, slope.size, min(slope.size, coordinates), step=number, dimension=3)
    picked = np.concatenate([support[half], np.setdiff1d(rest, support[half], assume_unique=True)])
    probes += [(np.array([index]), np.ones(1)) for index in picked[:coordinates]]
    return probes


def _differences(
    function: Function,
    cotangents: Outputs,
    parameters: Arrays,
    name: str,
    probes: list[Probe],
    step: float,
) -> Float64:
    """The central difference quotient along every probe, for one group and one step."""
    width = step * group_scale(parameters[name])
    quotients = []
    for index, direction in probes:
        ends = []
        for side in (width, -width):
            moved = {key: value.copy() for key, value in parameters.items()}
            if index is None:
                moved[name] += side * direction
            else:
                moved[name].reshape(-1)[index] += side
            ends.append(contract(function(moved), cotangents))
        quotients.append((ends[0] - ends[1]) / (2.0 * width))
    return np.array(quotients)


def _sweep(
    measure: Callable[[float], Float64],
    slope: Float64,
    probes: Sequence[Probe],
    steps: Sequence[float],
    tolerance: float,
) -> dict[float, tuple[Float64, float]]:
    """Differences and their error by step, from the coarsest on, of the steps that were tried."""
    flat = slope.reshape(-1)
    expected = np.array(
        [np.sum(slope * v) if index is None else flat[index[0]] for index, v in probes]
    )
    dense = np.array([index is None for index, _ in probes])
    middle = (len(steps) - 1) / 2
    tried = {}
    for number in sorted(range(len(steps)), key=lambda number: abs(number - middle)):
        found = measure(steps[number])
        tried[number] = (found, max_error(found, expected, dense))
        if tried[number][1] <= tolerance:
            break
    return {steps[number]: tried[number] for number in sorted(tried)}


def _judge(
    name: str,
    slope: Float64,
    differences: Mapping[float, tuple[Float64, float]],
    tolerance: float,
    dead: str,
    may_be_zero: bool,
) -> GroupReport:
    flat = slope.reshape(-1)
    curve = tuple((step, error) for step, (_, error) in differences.items())
    best_step, error = curve[0][0], np.inf
    for step, candidate in curve:
        if candidate < error:  # False for NaN, so that NaN never becomes the best
            best_step, error = step, candidate
    norm = float(np.linalg.norm(flat))
    zero = not slope.any() and any(not found.any() for found, _ in differences.values())
    reason = dead
    if not reason and not np.isfinite(slope).all():
        reason = "the gradient is not finite"
    if not reason and zero and not may_be_zero:
        reason = "empty test: gradient and differences are both zero"
    if not reason and not error <= tolerance:
        reason = f"error {error:.1e} exceeds {tolerance:.0e}"
    return GroupReport(name, float(error), best_step, curve, norm, not reason, reason)


def max_error(found: Float64, expected: Float64, dense: NDArray[np.bool_]) -> float:
    """The larger norm-relative error of the two kinds of probe; NaN if either is."""
    errors = []
    for part in (dense, ~dense):
        size = max(np.linalg.norm(found[part]), np.linalg.norm(expected[part]))
        gap = np.linalg.norm(found[part] - expected[part])
        errors.append(0.0 if size == 0.0 else float(gap / size))
    return float(np.max(errors))
