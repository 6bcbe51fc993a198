"""W10: a principled reflectance model at millions of pairs of directions, and its gradient.

The value is f times the cosine; the loss is the mean over evaluations of the sum over channels of
w f cos. `--params scalar`: one base color, metalness and roughness for all. `--params texture`:
texels^2 of each, evaluation n takes texel n mod texels^2. Forward is the values, into an array that
is used again; forward and backward is the values, the loss, and the gradient with
respect to all parameters, cleared first.
"""

from __future__ import annotations

from typing import Any

import _bounds
import _common
import _inputs
import numpy as np
from numpy.typing import NDArray
from photograd._compiled import _core
from photograd.bsdf import principled

Array = NDArray[Any]
KINDS = ("scalar", "texture")


class Evaluations:
    """The workload, and arrays that are used again."""

    def __init__(self, evals: int, kind: str, texels: int) -> None:
        self.wi, self.wo, self.weights = _inputs.bsdf_pairs(evals)
        given = _inputs.bsdf_parameters(kind, texels)
        self.parameters = principled.rows(*given)
        self.values = np.empty_like(self.wi)
        self.gradient = np.zeros_like(self.parameters)
        name = f"W10 evals={evals} {kind} {texels}"
        self.inputs = _inputs.inputs_row(name, self.wi, self.wo, self.weights, *given)

    def forward(self) -> None:
        # The workload has the cosine of `wo`; here that is the light's direction.
        principled.evaluate(self.parameters, self.wi, self.wo, cosine=True, out=self.values)

    def forward_backward(self) -> float:
        self.forward()
        loss = float(np.vdot(self.values, self.weights)) / len(self.values)
        self.gradient.fill(0)
        principled.evaluate_backward(
            self.parameters, self.wi, self.wo, self.weights, cosine=True, out=self.gradient
        )
        self.gradient *= np.float32(1 / len(self.values))
        return loss

    def quality(self) -> dict[str, float]:
        columns = np.split(self.gradient.astype(np.float64), [3, 4], axis=1)
        names = ("base_color", "metallic", "roughness")
        norms = {
            f"grad_norm_{name}": float(np.linalg.norm(column))
            for name, column in zip(names, columns, strict=True)
        }
        loss = float((self.values.astype(np.float64) * self.weights).sum()) / len(self.values)
        return {"weighted_mean": loss, "mean": float(self.values.mean(dtype=np.float64)), **norms}


def main() -> None:
    parser = _common.options("W10: a reflectance model", evals=10_000_000, texels=1024)
    parser.add_argument("--params", choices=KINDS, default="scalar")
    args = parser.parse_args()
    _core.set_thread_count(args.threads)
    work = Evaluations(args.evals, args.params, args.texels)
    forward, _ = _common.measure(work.forward, args.reps, args.warmup)
    both, _ = _common.measure(work.forward_backward, args.reps, args.warmup)
    size = {
        "evals": args.evals,
        "params": args.params,
        "texels": args.texels if args.params == "texture" else None,
    }
    more: dict[str, Any] = {"bound": _bounds.bsdf_bound(args.evals), "inputs": work.inputs}
    _common.report("W10", args, size, work.quality(), forward=forward, both=both, **more)


if __name__ == "__main__":
    main()
