"""Many small perceptrons: each is a `Perceptron` at its own inputs, forward and backward."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.network import Perceptron, Perceptrons

from support.bits import same_bits

pytestmark = pytest.mark.usefixtures("core")

COUNTS = (0, 300, 1, 0, 1500, 128)
EACH = Perceptron(5, [9, 4], hidden="softplus")


def problem(dtype: Any) -> tuple[Any, ...]:
    """Parameters, offset, inputs and cotangents of six networks, two of them without inputs."""
    random = np.random.default_rng(1)
    parameters = Perceptrons(EACH).initial(len(COUNTS), seed=3, dtype=dtype)
    parameters += (0.1 * random.normal(size=parameters.shape)).astype(dtype)
    x = random.normal(size=(sum(COUNTS), 5)).astype(dtype)
    d = random.normal(size=(sum(COUNTS), 4)).astype(dtype)
    return parameters, np.concatenate([[0], np.cumsum(COUNTS)]), x, d


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_each_network_is_a_perceptron_at_its_own_inputs(dtype: Any) -> None:
    parameters, offset, x, d = problem(dtype)
    networks = Perceptrons(EACH)
    found = networks.forward(parameters, offset, x)
    d_parameters, d_x = networks.backward(parameters, offset, x, d)
    for n in range(len(COUNTS)):
        own = slice(offset[n], offset[n + 1])
        np.testing.assert_array_equal(found[own], EACH.forward(parameters[n], x[own]))
        d_own, d_x_own = EACH.backward(parameters[n], x[own], d[own])
        np.testing.assert_array_equal(d_x[own], d_x_own)
        np.testing.assert_allclose(d_parameters[n], d_own, rtol=1e-6, atol=1e-6)
    assert not d_parameters[[0, 3]].any()


@same_bits("perceptrons", kernels=("perceptron_forward", "perceptron_backward"))
def six_networks() -> list[Any]:
    parameters, offset, x, d = problem(np.float32)
    networks = Perceptrons(EACH)
    return [networks.forward(parameters, offset, x), *networks.backward(parameters, offset, x, d)]


def test_rows_have_other_weights_and_bad_arrays_are_refused() -> None:
    parameters, offset, x, _ = problem(np.float64)
    networks = Perceptrons(EACH)
    assert len(np.unique(networks.initial(4, seed=1)[:, 0])) == 4
    with pytest.raises(RangeError, match="offset"):
        networks.forward(parameters, offset[::-1].copy(), x)
    with pytest.raises(ShapeError, match="parameters"):
        networks.forward(parameters[:-1], offset, x)
