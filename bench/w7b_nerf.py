"""W7b: the network of NeRF, 63-256x8-4 with a skip connection into its fifth layer.

Forward is the outputs at random points, whose frequency encoding counts; forward and backward is
the derivative of the mean squared difference from a target with respect to weights and biases.
"""

from __future__ import annotations

from typing import Any

import _bounds
import _common
import _inputs
import numpy as np
from photograd._compiled import _core
from photograd.network import FrequencyEncoding, LayerValues, Perceptron

SIZES = [63, *[256] * 8, 4]
SKIP = 4
PIECE = 16_384
"""Points whose numbers of all layers are kept for the backward pass at a time."""


class Network:
    """The workload, and arrays that are used again."""

    def __init__(self, count: int) -> None:
        points, self.targets = _inputs.field_points(count)
        self.points = points * 2 - 1
        self.encoding = FrequencyEncoding(10)
        self.network = Perceptron(SIZES[0], SIZES[1:], skip=SKIP)
        weights = _inputs.layer_weights(SIZES)
        weights[SKIP] = _inputs.layer_weights([SIZES[SKIP] + SIZES[0], SIZES[SKIP + 1]], 99)[0]
        self.parameters = np.zeros(self.network.count, np.float32)
        for (W, _), given in zip(self.network.layers(self.parameters), weights, strict=True):
            W[:] = given
        self.weights = sum(w.size for w in weights)
        self.d_parameters = np.empty_like(self.parameters)
        self.values = LayerValues()
        self.inputs = _inputs.inputs_row(f"W7b points={count}", points, self.targets, *weights)

    def forward(self) -> None:
        self.outputs = self.network.forward(self.parameters, self.encoding.encode(self.points))

    def forward_backward(self) -> None:
        self.d_parameters[:] = 0.0
        self.outputs = np.empty_like(self.targets)
        for first in range(0, len(self.points), PIECE):
            part = slice(first, first + PIECE)
            features = self.encoding.encode(self.points[part])
            got = self.network.forward(self.parameters, features, values=self.values)
            d_outputs = (got - self.targets[part]) * np.float32(2.0 / self.targets.size)
            self.outputs[part] = got
            self.network.backward(
                self.parameters,
                features,
                d_outputs,
                out=self.d_parameters,
                d_inputs=False,
                values=self.values,
            )

    def quality(self) -> dict[str, float]:
        difference = self.outputs.astype(np.float64) - self.targets
        W, _ = self.network.layers(self.d_parameters)[0]
        return {
            "loss": float(np.mean(difference**2)),
            "out_mean": float(self.outputs.mean(dtype=np.float64)),
            "grad_norm_w0": float(np.linalg.norm(W.astype(np.float64))),
        }


def main() -> None:
    args = _common.options("W7b: the network of NeRF", points=65_536).parse_args()
    _core.set_thread_count(args.threads)
    network = Network(args.points)
    forward, _ = _common.measure(network.forward, args.reps, args.warmup)
    both, _ = _common.measure(network.forward_backward, args.reps, args.warmup)
    bound = _bounds.layers_bound(args.points, network.weights)
    more: dict[str, Any] = {"bound": bound, "inputs": network.inputs}
    size = {"points": args.points}
    _common.report("W7b", args, size, network.quality(), forward=forward, both=both, **more)


if __name__ == "__main__":
    main()
