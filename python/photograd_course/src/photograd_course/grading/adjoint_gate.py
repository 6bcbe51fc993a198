"""The gate for a hand-written adjoint: what only the right one passes.

In float64, with a random cotangent that is never uniform, each parameter group alone: central
differences of a trusted or of the student's own forward function, the transpose (dot product), a
cotangent of zero, and the cost. Measured for emission-absorption rays, wrong formulas are off by
5 % and more while rounding leaves 1e-10 to 2e-8, so 1e-6 separates them by four orders each way.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from .cost import require_cheap
from .failures import CheckFailed, GraderFault
from .specs import Array as ArraySpec
from .tolerance import Tolerance
from .trial import Trial

__all__ = [
    "agrees_with_finite_differences",
    "central_differences",
    "is_the_transpose",
    "matrix_of",
    "random_cotangent",
    "require_cheap",
    "require_zero_for_zero",
]

STEP = 1e-5
DIFFERENCES = Tolerance(1e-6, "central differences at 1e-5 leave 1e-10 to 2e-8 of smooth code")
Forward = Callable[[Mapping[str, Any]], Any]
Array = np.ndarray[Any, np.dtype[np.float64]]
Operand = Array | tuple[Array, ...]


def random_cotangent(rng: np.random.Generator, shape: tuple[int, ...]) -> Array:
    """Uniform in [-1, 1], and never uniform across the array.

    Args:
        rng: random numbers.
        shape: of the output.
    """
    return rng.uniform(-1.0, 1.0, shape)


def central_differences(
    forward: Forward, point: Mapping[str, Any], group: str, d_output: Array
) -> Array:
    """d<forward(point), d_output>/d point[group] by central differences, step 1e-5 max(1, |x|)."""
    x = np.array(point[group], np.float64)
    gradient = np.zeros_like(x)
    for index in np.ndindex(x.shape):
        step = STEP * max(1.0, abs(float(x[index])))
        values = []
        for sign in (1, -1):
            moved = x.copy()
            moved[index] += sign * step
            values.append(float(np.vdot(np.asarray(forward({**point, group: moved})), d_output)))
        gradient[index] = (values[0] - values[1]) / (2 * step)
    return gradient


def agrees_with_finite_differences(
    trial: Trial,
    got: Mapping[str, Any],
    forward: Forward,
    point: Mapping[str, Any],
    d_output: Array,
    tolerance: Tolerance = DIFFERENCES,
) -> None:
    """Compare each group of ``got`` with central differences of ``forward``.

    Args:
        trial: of the check.
        got: {group: gradient} that the student returned.
        forward: the function, of {group: array}.
        point: {group: array}, where it is differentiated.
        d_output: cotangent of its output.
        tolerance: of the comparison.

    Raises:
        CheckFailed: a group is off, or its true gradient is zero (the place proves nothing).
    """
    for group, gradient in got.items():
        expected = central_differences(forward, point, group, d_output)
        if not expected.any():
            raise CheckFailed(f"d_{group}: differences of the forward function are all zero")
        trial.close(f"d_{group}", gradient, expected, tolerance)


def is_the_transpose(
    trial: Trial, what: str, x: Operand, forward: Operand, cotangent: Operand, backward: Operand
) -> None:
    """The dot-product test of a linear map S: <S x, g> = <x, S* g>, within the check's tolerance.

    Args:
        trial: of the check.
        what: names the right-hand side, such as "<x, S* g>".
        x: input of the map, an array or several.
        forward: S x.
        cotangent: g, of the shapes of ``forward``.
        backward: S* g, of the shapes of ``x``.

    Raises:
        CheckFailed: the difference is not small against |S x| |g|.
        GraderFault: the check has no tolerance.
    """
    bound = trial.check.tolerance
    if bound is None:
        raise GraderFault(f"{trial.check.id}: compares without a tolerance")
    left, right = _flat(forward), _flat(cotangent)
    size = float(np.linalg.norm(left) * np.linalg.norm(right))
    trial.close(
        what,
        np.vdot(_flat(x), _flat(backward)),
        np.vdot(left, right),
        Tolerance(bound.relative, bound.evidence, floor=size),
    )


def matrix_of(trial: Trial, function: str, shape: tuple[int, ...], places: Array) -> Array:
    """The matrix (N, cells) of a linear function of a grid that is sampled at N places.

    Args:
        trial: of the check.
        function: of the submission: of values (*shape, C) and places (N, ...), it gives (N, C).
        shape: of the grid.
        places: what the function takes besides the values.
    """
    cells = int(np.prod(shape))
    unit = np.eye(cells).reshape(*shape, cells)
    matrix: Array = trial.call(function, unit, places, returns=ArraySpec((len(places), cells)))
    return matrix


def require_zero_for_zero(trial: Trial, gradients: Mapping[str, Any]) -> None:
    """A cotangent of zero must give gradients that are exactly zero."""
    for group, gradient in gradients.items():
        trial.require(
            not np.asarray(gradient).any(),
            f"d_{group}: not zero although the incoming derivative is zero",
        )


def _flat(operand: Operand) -> Array:
    parts = operand if isinstance(operand, tuple) else (operand,)
    return np.concatenate([np.ravel(part) for part in parts])
