"""photograd.jax: the same through JAX, under jit and grad. `./run test --all` has it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import photograd
import pytest

from support.missing import need_module
from tests.bridges.renderers import CASES, adjoint, case, cotangents

pytestmark = pytest.mark.usefixtures("core")
jax: Any = need_module("jax", by_choice=True)


@pytest.fixture(autouse=True)
def _double() -> Iterator[None]:
    jax.config.update("jax_enable_x64", True)
    yield
    jax.config.update("jax_enable_x64", False)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("compiled", [False, True])
def test_gradients_are_the_adjoints(name: str, compiled: bool) -> None:
    this = case(name)
    pair = this.pair(tuple(this.inputs))
    given = {key: jax.numpy.asarray(array) for key, array in this.inputs.items()}
    wanted = cotangents(pair)

    def loss(arrays: Any) -> Any:
        outputs = this.call(photograd.jax, arrays)
        return sum((o * d).sum() for o, d in zip(outputs, wanted.values(), strict=True))

    derivative = jax.value_and_grad(loss)
    value, found = (jax.jit(derivative) if compiled else derivative)(given)
    outputs = pair.forward(this.inputs)[0]
    expected = sum(float((outputs[key] * d).sum()) for key, d in wanted.items())
    assert float(value) == pytest.approx(expected, rel=1e-12)
    for key, d in adjoint(name).items():
        assert np.array_equal(np.asarray(found[key]), d), key
        assert d.any()


def test_any_pair_can_be_applied_and_mapped() -> None:
    def forward(x: Any) -> Any:
        return (x * x,), x

    def square(x: Any) -> Any:
        return photograd.jax.apply(forward, lambda x, d: (2 * x * d,), [(3,)], x)[0]

    rows = jax.numpy.arange(6.0).reshape(2, 3)
    assert np.array_equal(jax.vmap(square)(rows), rows * rows)
    assert np.array_equal(jax.grad(lambda x: square(x).sum())(rows[1]), 2 * rows[1])
