"""W6a: colors of many points from spherical harmonics of degree 3, and both derivatives.

Each point has a direction of its own and 16 coefficients of three channels. Forward is the colors;
forward and backward is the colors, then the derivatives of sum(w color) by the coefficients and
by the directions, as the polynomials have it, before any normalization. Gradients are overwritten
in arrays that are used again, so none has to be cleared.
"""

from __future__ import annotations

from typing import Any

import _bounds
import _common
import _inputs
import numpy as np
from numpy.typing import NDArray
from photograd import sh
from photograd._compiled import _core

Array = NDArray[Any]
DEGREE = 3


class Points:
    """The workload, and arrays that are used again."""

    def __init__(self, count: int) -> None:
        self.directions, self.coefficients, self.weights = _inputs.sh_points(count)
        self.colors = np.empty_like(self.weights)
        self.gradients = np.empty_like(self.coefficients), np.empty_like(self.directions)
        arrays = self.directions, self.coefficients, self.weights
        self.inputs = _inputs.inputs_row(f"W6a points={count}", *arrays)

    def forward(self) -> None:
        sh.evaluate(self.coefficients, self.directions, out=self.colors)

    def forward_backward(self) -> None:
        self.forward()
        sh.evaluate_backward(self.coefficients, self.directions, self.weights, out=self.gradients)

    def quality(self) -> dict[str, float]:
        by_coefficients, by_directions = (g.astype(np.float64) for g in self.gradients)
        return {
            "sum": float(self.colors.sum(dtype=np.float64)),
            "grad_norm_coeff": float(np.linalg.norm(by_coefficients)),
            "grad_norm_dir": float(np.linalg.norm(by_directions)),
        }


def main() -> None:
    parser = _common.options("W6a: spherical harmonics of degree 3", points=2_000_000)
    args = parser.parse_args()
    _core.set_thread_count(args.threads)
    points = Points(args.points)
    forward, _ = _common.measure(points.forward, args.reps, args.warmup)
    both, _ = _common.measure(points.forward_backward, args.reps, args.warmup)
    more: dict[str, Any] = {"bound": _bounds.sh_bound(args.points), "inputs": points.inputs}
    size = {"points": args.points, "degree": DEGREE}
    _common.report("W6a", args, size, points.quality(), forward=forward, both=both, **more)


if __name__ == "__main__":
    main()
