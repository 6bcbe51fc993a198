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
from .failures import CheckFailed
from .tolerance import Tolerance
from .trial import Trial

__all__ = [
    "central_differences",
    "random_cotangent",
    "require_cheap",
    "require_gradients",
    "require_transpose",
    "require_zero_for_zero",
]

STEP = 1e-5
DIFFERENCES = Tolerance(1e-6, "central differences at 1e-5 leave 1e-10 to 2e-8 of smooth code")
ANALYTIC = Tolerance(1e-9, "two ways to write the same sum differ by some 1e-15")
TRANSPOSE = Tolerance(1e-9, "both sides are sums of the same products")
Forward = Callable[[Mapping[str, Any]], Any]
Array = np.ndarray[Any, np.dtype[np.float64]]


def random_cotangent(rng: np.random.Generator, shape: tuple[int, ...]) -> Array:
    """Uniform in [-1, 1], and never uniform across the array."""
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


def require_gradients(
    trial: Trial,
    got: Mapping[str, Any],
    forward: Forward,
    point: Mapping[str, Any],
    d_output: Array,
    tolerance: Tolerance = DIFFERENCES,
) -> None:
    """Compare each group of ``got`` with central differences of ``forward``.

    Raises:
        CheckFailed: a group is off, or its true gradient is zero (the place proves nothing).
    """
    for group, gradient in got.items():
        expected = central_differences(forward, point, group, d_output)
        if not expected.any():
            raise CheckFailed(f"d_{group}: differences of the forward function are all zero")
        trial.close(f"d_{group}", gradient, expected, tolerance)


def require_transpose(
    trial: Trial,
    forward: Callable[[Array], Array],
    backward: Callable[[Array], Array],
    shapes: tuple[tuple[int, ...], tuple[int, ...]],
    tolerance: Tolerance = TRANSPOSE,
) -> None:
    """<S x, g> = <x, S^T g> for a linear ``forward``, three times.

    Args:
        trial: of the check.
        forward, backward: the linear map and what should be its transpose.
        shapes: of x and of g.
        tolerance: of the relative difference of both sides.
    """
    for _ in range(3):
        x, g = (trial.rng.uniform(-1.0, 1.0, shape) for shape in shapes)
        left, right = float(np.vdot(forward(x), g)), float(np.vdot(x, backward(g)))
        scale = max(abs(left), abs(right))
        trial.require(scale > 0, "both sides of the dot-product test are zero")
        trial.close("<S x, g> against <x, S^T g>", right, left, tolerance)


def require_zero_for_zero(trial: Trial, gradients: Mapping[str, Any]) -> None:
    """A cotangent of zero must give gradients that are exactly zero."""
    for group, gradient in gradients.items():
        trial.require(
            not np.asarray(gradient).any(),
            f"d_{group}: not zero although the incoming derivative is zero",
        )
