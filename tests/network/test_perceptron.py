"""Multilayer perceptrons: values, adjoints away from kinks, the kernel's bits, refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd.network import LayerValues, Perceptron
from photograd_course.gradcheck import check_gradient, dot_product_error, taylor_slope

from support.bits import same_bits
from support.gradient_mutants import check_gradient_mutants

pytestmark = pytest.mark.usefixtures("core")

FAR_FROM_KINKS = 1e-3
SHAPES = {
    "one layer": Perceptron(3, [2]),
    "relu": Perceptron(5, [7, 6, 4]),
    "softplus": Perceptron(4, [9, 3], hidden="softplus", output="sigmoid"),
    "sigmoid": Perceptron(4, [6, 5], hidden="sigmoid", output="softplus"),
    "exp": Perceptron(3, [5, 5, 2], hidden="softplus", output="exp"),
    "skip": Perceptron(3, [8, 6, 5, 2], skip=2),
    "skip at the end": Perceptron(4, [8, 3], hidden="softplus", skip=1),
}
each_shape = pytest.mark.parametrize("network", SHAPES.values(), ids=SHAPES)


def numbers(network: Perceptron, count: int, dtype: Any = np.float64) -> tuple[Any, Any, Any]:
    """Parameters with biases, inputs, cotangents."""
    random = np.random.default_rng(network.count)
    parameters = network.initial(seed=1, dtype=np.float64)
    parameters += 0.1 * random.normal(size=parameters.shape)
    x = random.normal(size=(count, network.inputs))
    d = random.normal(size=(count, network.outputs))
    return parameters.astype(dtype), x.astype(dtype), d.astype(dtype)


def in_numpy(network: Perceptron, parameters: Any, x: Any) -> tuple[Any, list[Any]]:
    """Outputs by the formulas, and the pre-activations of all layers."""
    functions = {
        "identity": lambda z: z,
        "relu": lambda z: np.maximum(z, 0),
        "softplus": lambda z: np.logaddexp(z, 0),
        "sigmoid": lambda z: 1 / (1 + np.exp(-z)),
        "exp": np.exp,
    }
    first, before = x, []
    for layer, (W, b) in enumerate(network.layers(parameters)):
        if layer and layer == network.skip:
            x = np.concatenate([x, first], 1)
        before.append(x @ W.T + b)
        last = layer + 1 == len(network.widths)
        x = functions[network.output if last else network.hidden](before[-1])
    return x, before


def away_from_kinks(network: Perceptron) -> tuple[Any, Any, Any]:
    """`numbers` whose pre-activations stay clear of 0, where ReLU has no derivative."""
    parameters, x, d = numbers(network, 40)
    _, before = in_numpy(network, parameters, x)
    good = np.min([np.abs(z).min(1) for z in before], 0) > FAR_FROM_KINKS
    assert good.sum() > 10
    return parameters, x[good], d[good]


@each_shape
def test_values_are_those_of_the_formulas(network: Perceptron) -> None:
    for dtype, rtol in ((np.float64, 1e-12), (np.float32, 2e-5)):
        parameters, x, _ = numbers(network, 300, dtype)
        expected, _ = in_numpy(network, parameters.astype(np.float64), x.astype(np.float64))
        got = network.forward(parameters, x)
        np.testing.assert_allclose(got, expected, rtol=rtol, atol=rtol)
        assert got.dtype == dtype


@each_shape
def test_derivatives_agree_with_finite_differences(network: Perceptron) -> None:
    parameters, x, d = away_from_kinks(network)

    def function(groups: Any) -> Any:
        return {"y": network.forward(groups["parameters"], groups["x"])}

    def backward(groups: Any, cotangent: Any) -> Any:
        d_parameters, d_x = network.backward(groups["parameters"], groups["x"], cotangent["y"])
        return {"parameters": d_parameters, "x": d_x}

    place, cotangent = {"parameters": parameters, "x": x}, {"y": d}
    report = check_gradient_mutants(function, backward, place, cotangent, seed=3)
    assert report, report
    assert check_gradient(function, backward, place, seed=3)
    assert taylor_slope(function, backward, place, seed=4)


@each_shape
def test_float32_derivatives_are_those_of_float64(network: Perceptron) -> None:
    parameters, x, d = away_from_kinks(network)
    expected = network.backward(parameters, x, d)
    got = network.backward(*(a.astype(np.float32) for a in (parameters, x, d)))
    for single, double in zip(got, expected, strict=True):
        assert single is not None
        assert double is not None
        assert np.abs(single - double).max() <= 2e-5 * np.abs(double).max()


WIDE = {
    "16x2": Perceptron(32, [16, 16, 3], output="sigmoid"),
    "64x2": Perceptron(32, [64, 64, 4]),
    "odd": Perceptron(63, [100, 37, 5], hidden="softplus", output="exp"),
    "256 with skip": Perceptron(63, [256, 256, 256, 4], skip=2),
}
KERNELS = ("perceptron_pack", "perceptron_forward", "perceptron_backward")


def both(network: Perceptron, count: int, *, fused: bool) -> list[Any]:
    parameters, x, d = numbers(network, count, np.float32)
    d_parameters, d_x = network.backward(parameters, x, d, fused=fused)
    return [network.forward(parameters, x, fused=fused), d_parameters, d_x]


@pytest.mark.parametrize("network", WIDE.values(), ids=WIDE)
def test_kernel_and_plain_form_agree_bit_for_bit(network: Perceptron) -> None:
    for count in (1, 31, 128, 129, 1024 + 200):
        kernel, plain = both(network, count, fused=True), both(network, count, fused=False)
        for got, expected in zip(kernel, plain, strict=True):
            np.testing.assert_array_equal(got, expected)


def test_kept_values_change_no_bit_and_belong_to_their_inputs() -> None:
    network = WIDE["256 with skip"]
    values = LayerValues()
    for count in (1500, 700):  # room is used again
        parameters, x, d = numbers(network, count, np.float32)
        y = network.forward(parameters, x, values=values)
        np.testing.assert_array_equal(y, network.forward(parameters, x))
        kept = network.backward(parameters, x, d, values=values)
        for got, expected in zip(kept, network.backward(parameters, x, d), strict=True):
            np.testing.assert_array_equal(got, expected)
    with pytest.raises(RangeError, match=r"Perceptron.backward: values.*700"):
        network.backward(parameters, x[1:], d[1:], values=values)
    with pytest.raises(RangeError, match=r"Perceptron.backward: values"):
        network.backward(parameters, x, d, values=LayerValues())
    with pytest.raises(RangeError, match=r"Perceptron.forward: values"):
        network.forward(parameters, x, fused=False, values=values)


@same_bits("perceptron", each=WIDE, kernels=KERNELS)
def many_inputs(name: str) -> list[Any]:
    return both(WIDE[name], 1500, fused=True)


def test_samples_do_not_depend_on_each_other_and_none_is_no_error() -> None:
    network = WIDE["64x2"]
    parameters, x, d = numbers(network, 700, np.float32)
    y = network.forward(parameters, x)
    np.testing.assert_array_equal(network.forward(parameters, x[333:334]), y[333:334])
    assert network.forward(parameters, x[:0]).shape == (0, 4)
    d_parameters, d_x = network.backward(parameters, x[:0], d[:0])
    assert not d_parameters.any()
    assert d_x is not None
    assert d_x.shape == (0, 32)


def test_derivatives_are_added_and_inputs_left_out_on_request() -> None:
    network = WIDE["16x2"]
    parameters, x, d = numbers(network, 200, np.float32)
    once, _ = network.backward(parameters, x, d)
    out = np.ones_like(parameters)
    got, d_x = network.backward(parameters, x, d, out=out, d_inputs=False)
    assert got is out
    assert d_x is None
    np.testing.assert_allclose(out, 1 + once, rtol=1e-6)


def test_forward_and_backward_of_a_layer_are_transposes() -> None:
    network = Perceptron(4, [3])  # W x + b is linear in the parameters and in x

    def forward(groups: Any, tangent: Any) -> Any:
        p, x = groups["parameters"], groups["x"]
        along_x = network.forward(p, tangent["x"]) - network.forward(p, 0 * x)
        return {"y": along_x + network.forward(tangent["parameters"], x)}

    def backward(groups: Any, cotangent: Any) -> Any:
        d_p, d_x = network.backward(groups["parameters"], groups["x"], cotangent["y"])
        return {"parameters": d_p, "x": d_x}

    parameters, x, _ = numbers(network, 9)
    place = {"parameters": parameters, "x": x}
    assert dot_product_error(forward, backward, place, seed=1, tolerance=1e-12)


def test_what_is_no_network_is_refused_by_name() -> None:
    for arguments in (
        {"inputs": 0, "widths": [3]},
        {"inputs": 3, "widths": []},
        {"inputs": 3, "widths": [3, 2000]},
        {"inputs": 3, "widths": [3, 3], "skip": 2},
    ):
        with pytest.raises(RangeError, match=r"Perceptron: (inputs|widths|skip)"):
            Perceptron(**arguments)  # type: ignore[arg-type]
    with pytest.raises(RangeError, match=r"Perceptron: hidden.*relu"):
        Perceptron(3, [3], hidden="tanh")  # type: ignore[arg-type]
    network = SHAPES["relu"]
    parameters, x, d = numbers(network, 4)
    with pytest.raises(ShapeError, match=r"Perceptron.forward: parameters"):
        network.forward(parameters[1:], x)
    with pytest.raises(DtypeError, match=r"Perceptron.forward: inputs"):
        network.forward(parameters, x.astype(np.float32))
    with pytest.raises(ShapeError, match=r"Perceptron.backward: d_outputs"):
        network.backward(parameters, x, d[:3])
    parameters[5] = np.nan
    with pytest.raises(RangeError, match=r"Perceptron.forward: parameters"):
        network.forward(parameters, x)
