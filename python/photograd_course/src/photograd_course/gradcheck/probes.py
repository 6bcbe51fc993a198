"""What every gradient check shares: checked parameters, random cotangents, one number per call.

A function under test maps named parameters to a number, an array, or named arrays. A random
cotangent w of the same shape turns it into one number L = sum(w * output), whose gradient is what
the backward function returns when it is given w.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import DtypeError, RangeError, ShapeError, message
from ..random import uniform

Float64 = NDArray[np.float64]
Arrays = dict[str, Float64]
Outputs = Any
"""A float, a float64 array, or a mapping of names to float64 arrays."""
Function = Callable[[Arrays], Outputs]
Backward = Callable[[Arrays, Outputs], Mapping[str, Any]]
AccumulatingBackward = Callable[[Arrays, Outputs, Arrays], None]

_ALONE = "output"


def copy_parameters(caller: str, parameters: Mapping[str, Any]) -> Arrays:
    """Fresh copies of the parameters, so that no check can change the caller's arrays.

    Raises:
        DtypeError: not float64; differences in float32 are too noisy to decide anything.
        ShapeError: no group, or a group without elements.
        RangeError: a value is not finite.
    """
    if not parameters:
        raise ShapeError(message(caller, "parameters", "at least one group", "none"))
    copies: Arrays = {}
    for name, value in parameters.items():
        argument = f"parameters[{name!r}]"
        if not isinstance(value, np.ndarray) or value.dtype != np.float64:
            got = getattr(value, "dtype", type(value).__name__)
            raise DtypeError(
                message(caller, argument, "a float64 array", got, "use .astype(np.float64)")
            )
        if value.size == 0:
            raise ShapeError(message(caller, argument, "at least one element", value.shape))
        if not np.isfinite(value).all():
            raise RangeError(message(caller, argument, "finite values", "some that are not"))
        copies[name] = value.copy()
    return copies


def named_outputs(caller: str, outputs: Outputs) -> Arrays:
    """The outputs of a function as named float64 arrays, whatever form they came in."""
    parts = outputs if isinstance(outputs, Mapping) else {_ALONE: outputs}
    named: Arrays = {}
    for name, value in parts.items():
        array = np.asarray(value)
        if array.dtype != np.float64:
            remedy = "compute the function in float64 for this check"
            raise DtypeError(message(caller, str(name), "float64 outputs", array.dtype, remedy))
        named[str(name)] = array
    return named


def draw_like(shape: tuple[int, ...], *, seed: int, stream: int, lane: int = 0) -> Float64:
    """Random numbers in [-1, 1) of a shape; `stream` and `lane` keep the draws apart."""
    pixel = np.arange(int(np.prod(shape, dtype=np.int64)), dtype=np.int64)
    return (2.0 * uniform(seed, step=stream, pixel=pixel, sample=lane) - 1.0).reshape(shape)


def draw_cotangents(outputs: Outputs, *, seed: int, lane: int = 0) -> Outputs:
    """A random cotangent of the same form as the outputs: float, array, or named arrays."""
    if isinstance(outputs, Mapping):
        return {
            name: draw_like(np.shape(value), seed=seed, stream=2**31 + k, lane=lane)
            for k, (name, value) in enumerate(outputs.items())
        }
    drawn = draw_like(np.shape(outputs), seed=seed, stream=2**31, lane=lane)
    return drawn if isinstance(outputs, np.ndarray) else float(drawn)


def contract(outputs: Outputs, cotangents: Outputs) -> float:
    """The one number sum(w * output) over all outputs.

    Raises:
        ShapeError: the outputs have other names or shapes than the cotangents.
    """
    values, weights = named_outputs("contract", outputs), named_outputs("contract", cotangents)
    shapes = {name: value.shape for name, value in values.items()}
    expected = {name: weight.shape for name, weight in weights.items()}
    if shapes != expected:
        raise ShapeError(message("contract", "outputs", f"shapes {expected}", shapes))
    return float(sum(np.sum(values[name] * weights[name]) for name in values))


def call_backward(
    caller: str, backward: Backward, parameters: Arrays, cotangents: Outputs
) -> Arrays:
    """Call a backward function on copies and check the form (not the values) of what comes back.

    Raises:
        ShapeError: a group is missing, superfluous, or has another shape than its parameter.
        DtypeError: a gradient is not float64.
    """
    copies = {name: value.copy() for name, value in parameters.items()}
    gradients = backward(copies, copy_outputs(cotangents))
    if not isinstance(gradients, Mapping) or set(gradients) != set(parameters):
        named = isinstance(gradients, Mapping)
        got: object = sorted(gradients) if named else type(gradients).__name__
        expected = f"a gradient for each of {sorted(parameters)}"
        raise ShapeError(message(caller, "backward", expected, got))
    for name, parameter in parameters.items():
        gradient, argument = gradients[name], f"gradient of {name!r}"
        if not isinstance(gradient, (np.ndarray, np.floating)) or gradient.dtype != np.float64:
            got = getattr(gradient, "dtype", type(gradient).__name__)
            raise DtypeError(message(caller, argument, "a float64 array", got))
        if gradient.shape != parameter.shape:
            expected = f"shape {parameter.shape} as the parameter has"
            raise ShapeError(message(caller, argument, expected, gradient.shape))
    return {name: np.array(gradients[name]) for name in parameters}


def copy_outputs(outputs: Outputs) -> Outputs:
    """A copy that a backward function may overwrite without spoiling the check."""
    if isinstance(outputs, Mapping):
        return {name: np.array(value) for name, value in outputs.items()}
    return outputs.copy() if isinstance(outputs, np.ndarray) else outputs


def group_scale(parameter: Float64) -> float:
    """The root mean square of a group, the natural unit of its steps; 1 for a group of zeros."""
    scale = float(np.sqrt(np.mean(parameter * parameter)))
    return scale if scale > 0.0 else 1.0
