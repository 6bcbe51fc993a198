"""Many small perceptrons of one shape, each with parameters and inputs of its own [Reiser2021]."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numpy.typing import NDArray

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.network.perceptron import Perceptron
from photograd.types import Array


@typed_call
class Perceptrons:
    """N perceptrons of one shape; inputs are sorted by network.

    Network n takes the rows offset[n] to offset[n + 1] of the inputs and runs on one thread, many
    networks side by side: results have the same bits for any number of threads. Outputs are those
    of `Perceptron` with the network's row of the parameters, bit for bit.

    Attributes:
        each: the shape that they share.
    """

    def __init__(self, each: Perceptron) -> None:
        """State the shape.

        Args:
            each: one of them.
        """
        self.each = each

    def initial(self, count: int, *, seed: int, dtype: npt.DTypeLike = np.float32) -> Array:
        """Random parameters (count, P), as `Perceptron.initial`, other ones in each row.

        Args:
            count: of networks.
            seed: of the random numbers.
            dtype: float32 or float64.
        """
        found = np.empty((count, self.each.count), dtype)
        for row, values in enumerate(found):
            values[:] = self.each.initial(seed=seed + row, dtype=dtype)
        return found

    def forward(self, parameters: Array, offset: NDArray[np.int64], inputs: Array) -> Array:
        """The outputs (M, outputs) of many inputs.

        Args:
            parameters: (N, P), float32 or float64.
            offset: (N + 1,) where the inputs of each network begin; rises from 0 to M.
            inputs: (M, inputs), of the same dtype.

        Raises:
            ShapeError, DtypeError: arrays other than these.
            RangeError: numbers that are not finite, or another offset.
        """
        call = Arguments("Perceptrons.forward")
        parameters = call.array("parameters", parameters, ("N", self.each.count))
        inputs = call.array("inputs", inputs, ("M", self.each.inputs))
        outputs = np.empty((len(inputs), self.each.outputs), inputs.dtype)
        arrays = parameters, offset, inputs, outputs
        call.run(_core.perceptrons_forward, self.each.shape, *arrays)
        return outputs

    def backward(
        self, parameters: Array, offset: NDArray[np.int64], inputs: Array, d_outputs: Array
    ) -> tuple[Array, Array]:
        """Derivatives of a loss with respect to the parameters (N, P) and the inputs (M, inputs).

        Evaluates the layers again.

        Args:
            parameters: (N, P), float32 or float64.
            offset: (N + 1,), as for `forward`.
            inputs: (M, inputs), of the same dtype.
            d_outputs: (M, outputs), derivatives of the loss with respect to the outputs.

        Raises:
            ShapeError, DtypeError: arrays other than these.
            RangeError: numbers that are not finite, or another offset.
        """
        call = Arguments("Perceptrons.backward")
        parameters = call.array("parameters", parameters, ("N", self.each.count))
        inputs = call.array("inputs", inputs, ("M", self.each.inputs))
        d_outputs = call.array("d_outputs", d_outputs, ("M", self.each.outputs))
        d_parameters, d_inputs = np.zeros_like(parameters), np.empty_like(inputs)
        arrays = parameters, offset, inputs, d_outputs, d_parameters, d_inputs
        call.run(_core.perceptrons_backward, self.each.shape, *arrays)
        return d_parameters, d_inputs
