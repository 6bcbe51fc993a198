"""A two-layer network as a field: the smallest one whose parameters every sample touches."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from photograd_course.random import uniform

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd.fields.march import MarchContext, MarchPolicy, march, march_backward
from photograd.representation import (
    Outputs,
    ParamSpec,
    RayBatch,
    RenderOptions,
    Representation,
    register,
)
from photograd.types import Array

HIDDEN = 16


@register
class TinyNetwork(Representation):
    """h = softplus(W1 p + b1), (r, g, b, density) = W2 h + b2; p in world meters.

    params["weights"] is flat: W1 (16, 3), b1 (16), W2 (4, 16), b2 (4), row by row.
    """

    name: ClassVar[str] = "tiny_network"
    capabilities: ClassVar[frozenset[str]] = frozenset({"rays"})
    teaching_example: ClassVar[str] = "start it from Python, with parameters of your own"

    def __init__(self, weights: Array, policy: MarchPolicy) -> None:
        """Raises DtypeError or ShapeError unless weights is a flat array of the network's size.

        Args:
            weights: of all layers, flat.
            policy: box, step and activations.
        """
        shape = (_core.tiny_network_parameters,)
        weights = Arguments("TinyNetwork").array("weights", weights, shape, finite=False)
        self.params = {"weights": weights}
        self.policy = policy

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> TinyNetwork:
        """Random weights in [-1, 1) over a box that is no cube."""
        index = np.arange(_core.tiny_network_parameters)
        weights = 2 * uniform(seed, step=0, pixel=index, sample=0, dimension=0) - 1
        return cls(weights.astype(dtype), MarchPolicy(((-1.0, -0.8, -1.2), (1.0, 0.8, 1.2)), 0.11))

    def example_batch(self, *, seed: int) -> RayBatch:
        """The same rays as the dense grid's example."""
        from photograd.fields.dense_grid import DenseGrid

        return DenseGrid.example(seed=seed).example_batch(seed=seed)

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """One group, all weights."""
        shape = self.params["weights"].shape
        return {"weights": ParamSpec(shape, "1", (-10.0, 10.0), 0.01, "none")}

    def render(
        self, batch: RayBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, MarchContext]:
        """As `DenseGrid.render`."""
        return march(
            "tiny_network",
            self.params["weights"],
            self.policy,
            batch,
            options,
            seed=seed,
            step=step,
        )

    def render_backward(self, context: MarchContext, d_outputs: Outputs) -> dict[str, Array]:
        """{"weights": (P,)}, and "origins", "directions" (R, 3) if the options asked."""
        gradients = march_backward(context, d_outputs)
        gradients["weights"] = gradients.pop("parameters")
        return gradients
