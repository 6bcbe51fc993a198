"""A multilayer perceptron: layers of weights, biases and activations."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, get_args

import numpy as np
import numpy.typing as npt
from photograd_course.random import uniform

from photograd._arrays import Arguments, shortened
from photograd._checks import typed
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.errors import DtypeError, message
from photograd.types import Array

Activation = Literal["identity", "relu", "softplus", "exp", "sigmoid"]
_ACTIVATIONS = get_args(Activation)


@typed_call
class LayerValues:
    """Room for the numbers of all layers at many inputs, used again from call to call.

    `Perceptron.forward` fills it, `Perceptron.backward` then has no layer to evaluate again. An
    input takes four bytes for each of `Perceptron.inputs` and `Perceptron.widths`.

    Attributes:
        core: the numbers, in the core's blocks.
    """

    def __init__(self) -> None:
        """Start without room."""
        self.core = _core.PerceptronValues()


@typed_call
class Perceptron:
    """x_{l+1} = a_l(W_l x_l + b_l) for layers l = 0, 1, ...

    float32 runs in blocks of 128 samples through a kernel; float64 runs the same formulas sample by
    sample, for proofs. Results have the same bits for any number of threads, and float32 for any
    instruction set.

    Attributes:
        inputs: numbers that the first layer takes.
        widths: numbers that each layer gives; the last are the outputs.
        skip: the layer that takes the input again, behind what the layer before it gives
            [Park2019]; 0 for none.
        shape: the core's form of the layers.
        count: numbers of the parameters: W_0 (widths[0], inputs) row by row, b_0, W_1, ...
    """

    def __init__(
        self,
        inputs: int,
        widths: Sequence[int],
        *,
        hidden: Activation = "relu",
        output: Activation = "identity",
        skip: int = 0,
    ) -> None:
        """State the layers.

        Args:
            inputs: 1 to 1024.
            widths: 1 to 64 layers, 1 to 1024 numbers each.
            hidden: activation of all layers but the last.
            output: activation of the last.
            skip: below the number of layers.

        Raises:
            RangeError: anything else.
        """
        for name, value in {"hidden": hidden, "output": output}.items():
            typed("Perceptron", name, Activation, value)
        codes = _ACTIVATIONS.index(hidden), _ACTIVATIONS.index(output)
        self.shape = Arguments("Perceptron").run(
            _core.PerceptronShape, inputs, list(widths), *codes, skip
        )
        self.inputs, self.widths, self.skip = inputs, tuple(widths), skip
        self.hidden, self.output = hidden, output
        self.count: int = self.shape.parameters

    @property
    def outputs(self) -> int:
        """Numbers that the last layer gives."""
        return self.widths[-1]

    def layers(self, parameters: Array) -> list[tuple[Array, Array]]:
        """W_l (widths[l], numbers taken) and b_l (widths[l],) of each layer, views of `parameters`.

        Raises:
            ShapeError, DtypeError: other than (count,), float32 or float64.
        """
        flat = Arguments("Perceptron.layers").array("parameters", parameters, (self.count,))
        found, at = [], 0
        for layer, width in enumerate(self.widths):
            takes = self._takes(layer)
            found.append(
                (
                    flat[at : at + width * takes].reshape(width, takes),
                    flat[at + width * takes : at + width * (takes + 1)],
                )
            )
            at += width * (takes + 1)
        return found

    def initial(self, *, seed: int, dtype: npt.DTypeLike = np.float32) -> Array:
        """Random parameters (count,): weights uniform in +- sqrt(6 / takes) [He2015], biases zero.

        The last layer's are uniform in +- sqrt(3 / takes): no ReLU halves what it gives.

        Args:
            seed: of the random numbers.
            dtype: float32 or float64.
        """
        if dtype not in (np.float32, np.float64, "float32", "float64"):
            expected = "float32 or float64"
            raise DtypeError(message("Perceptron.initial", "dtype", expected, shortened(dtype)))
        parameters = np.zeros(self.count, np.float64)
        for layer, (W, _) in enumerate(self.layers(parameters)):
            index = np.arange(W.size)
            u = uniform(seed, step=layer, pixel=index, sample=0, dimension=0).reshape(W.shape)
            scale = 3.0 if layer + 1 == len(self.widths) else 6.0
            W[:] = (2.0 * u - 1.0) * np.sqrt(scale / W.shape[1])
        return parameters.astype(dtype)

    def forward(
        self,
        parameters: Array,
        inputs: Array,
        *,
        fused: bool = True,
        values: LayerValues | None = None,
    ) -> Array:
        """The outputs of many inputs.

        Args:
            parameters: (count,), float32 or float64.
            inputs: (N, self.inputs), of the same dtype.
            fused: by the kernel, for float32; else by the plain formulas, to the same bits.
            values: filled with the numbers of all layers, for `backward`; of the kernel alone.

        Returns:
            (N, outputs)

        Raises:
            ShapeError, DtypeError: arrays other than these.
            RangeError: numbers that are not finite, or values without the kernel.
        """
        call = Arguments("Perceptron.forward")
        parameters = call.array("parameters", parameters, (self.count,))
        inputs = call.array("inputs", inputs, ("N", self.inputs))
        outputs = np.empty((len(inputs), self.outputs), inputs.dtype)
        arrays = (parameters, inputs, outputs)
        kept = None if values is None else values.core
        call.run(_core.perceptron_forward, self.shape, *arrays, fused, kept)
        return outputs

    def backward(
        self,
        parameters: Array,
        inputs: Array,
        d_outputs: Array,
        *,
        out: Array | None = None,
        d_inputs: bool = True,
        fused: bool = True,
        values: LayerValues | None = None,
    ) -> tuple[Array, Array | None]:
        """Derivatives of a loss with respect to the parameters and the inputs.

        Evaluates the layers again, unless it gets the values that `forward` left.

        Args:
            parameters: (count,), float32 or float64.
            inputs: (N, self.inputs), of the same dtype.
            d_outputs: (N, outputs), derivatives of the loss with respect to the outputs.
            out: (count,), is added to; by default zeros.
            d_inputs: whether derivatives with respect to the inputs are wanted.
            fused: as in `forward`.
            values: as `forward` filled them, at the same parameters and inputs.

        Returns:
            d_parameters (count,), `out` where it is given, and d_inputs (N, self.inputs) or None.

        Raises:
            ShapeError, DtypeError: arrays other than these.
            RangeError: numbers that are not finite, or values of other inputs.
        """
        call = Arguments("Perceptron.backward")
        parameters = call.array("parameters", parameters, (self.count,))
        inputs = call.array("inputs", inputs, ("N", self.inputs))
        d_outputs = call.array("d_outputs", d_outputs, ("N", self.outputs))
        d_parameters = np.zeros_like(parameters) if out is None else out
        d_x = np.empty_like(inputs) if d_inputs else None
        arrays = (parameters, inputs, d_outputs, d_parameters, d_x)
        kept = None if values is None else values.core
        call.run(_core.perceptron_backward, self.shape, *arrays, fused, kept)
        return d_parameters, d_x

    def _takes(self, layer: int) -> int:
        if layer == 0:
            return self.inputs
        return self.widths[layer - 1] + (self.inputs if layer == self.skip else 0)
