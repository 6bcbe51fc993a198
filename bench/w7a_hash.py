"""W7a: multiresolution hash encoding (16 levels of 2, 2^19 rows) and a perceptron 32-64-64-4.

Forward is the outputs at random points; forward and backward is the derivative of the mean squared
difference from a target with respect to the tables and the weights.
"""

from __future__ import annotations

from typing import Any

import _bounds
import _common
import _inputs
import numpy as np
from numpy.typing import NDArray
from photograd._compiled import _core
from photograd.network import HashEncoding, Perceptron

Array = NDArray[Any]


class Field:
    """The workload, and arrays that are used again."""

    def __init__(self, count: int) -> None:
        self.points, self.targets = _inputs.field_points(count)
        self.encoding = HashEncoding.geometric(**_inputs.HASH)
        tables = _inputs.hash_tables()
        rows = [table[: e.rows] for table, e in zip(tables, self.encoding.levels, strict=True)]
        self.table = np.concatenate(rows)
        self.network = Perceptron(self.encoding.outputs, [64, 64, 4])
        self.parameters = np.zeros(self.network.count, np.float32)
        weights = _inputs.layer_weights([self.encoding.outputs, 64, 64, 4])
        for (W, _), given in zip(self.network.layers(self.parameters), weights, strict=True):
            W[:] = given
        self.weights = sum(w.size for w in weights)
        self.d_table = np.empty_like(self.table)
        self.d_parameters = np.empty_like(self.parameters)
        arrays = self.points, self.targets, tables, *weights
        self.inputs = _inputs.inputs_row(f"W7a points={count}", *arrays)

    def forward(self) -> None:
        self.features = self.encoding.encode(self.table, self.points)
        self.outputs = self.network.forward(self.parameters, self.features)

    def forward_backward(self) -> None:
        self.forward()
        d_outputs = (self.outputs - self.targets) * np.float32(2.0 / self.targets.size)
        self.d_table[:] = 0.0
        self.d_parameters[:] = 0.0
        _, d_features = self.network.backward(
            self.parameters, self.features, d_outputs, out=self.d_parameters
        )
        assert d_features is not None
        self.encoding.encode_backward(self.table, self.points, d_features, out=self.d_table)

    def quality(self) -> dict[str, float]:
        difference = self.outputs.astype(np.float64) - self.targets
        return {
            "loss": float(np.mean(difference**2)),
            "enc_sum": float(self.features.sum(dtype=np.float64)),
            "grad_norm_table": float(np.linalg.norm(self.d_table.astype(np.float64))),
        }


def main() -> None:
    parser = _common.options("W7a: hash encoding and a small perceptron", points=262_144)
    args = parser.parse_args()
    _core.set_thread_count(args.threads)
    field = Field(args.points)
    forward, _ = _common.measure(field.forward, args.reps, args.warmup)
    both, _ = _common.measure(field.forward_backward, args.reps, args.warmup)
    bound = _bounds.hash_bound(args.points, len(field.encoding.levels), field.weights)
    more: dict[str, Any] = {"bound": bound, "inputs": field.inputs}
    size = {"points": args.points}
    _common.report("W7a", args, size, field.quality(), forward=forward, both=both, **more)


if __name__ == "__main__":
    main()
