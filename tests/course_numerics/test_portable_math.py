"""Portable functions against those of NumPy: a few units in the last place apart, at most."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from photograd_course import portable_math as pm

WIDE = np.linspace(-700.0, 700.0, 100_001)
SIZES = np.logspace(-300.0, 300.0, 100_001)
NEAR_ONE = 1.0 + np.linspace(-0.5, 0.5, 100_000)
NEAR_ZERO = np.concatenate([-np.logspace(-300.0, -0.001, 5001), np.logspace(-300.0, 300.0, 5001)])
CASES = [
    (pm.exp, np.exp, WIDE),
    (pm.expm1, np.expm1, np.concatenate([NEAR_ZERO[:5001], WIDE[WIDE != 0]])),
    (pm.log, np.log, SIZES[SIZES != 1.0]),
    (pm.log, np.log, NEAR_ONE),
    (pm.log1p, np.log1p, NEAR_ZERO),
    (pm.softplus, lambda x: np.logaddexp(0.0, x), WIDE),
    (pm.sigmoid, lambda x: 1.0 / (1.0 + np.exp(-x)), WIDE),
]


@pytest.mark.parametrize(("function", "expected", "x"), CASES)
def test_relative_errors_in_float64(
    function: Callable[[Any], Any], expected: Callable[[Any], Any], x: Any
) -> None:
    # NumPy's own results are up to 1 unit (2.2e-16) off; measured: at most 4.5e-16 apart.
    np.testing.assert_allclose(function(x), expected(x), rtol=7e-16, atol=0)


def test_softplus_in_float32() -> None:
    x = np.linspace(-80.0, 80.0, 100_001, dtype=np.float32)
    expected = np.logaddexp(0.0, x.astype(np.float64))
    np.testing.assert_allclose(pm.softplus(x), expected, rtol=2.4e-7)


@pytest.mark.parametrize("function", ["exp", "expm1", "log1p", "sin", "cos"])
def test_relative_errors_in_float32(function: str) -> None:
    x = np.linspace(1e-3, 1.5, 100_001, dtype=np.float32)
    found = getattr(pm, function)(x)
    assert found.dtype == np.float32
    # Two units of 1.2e-7; measured: at most one, and 2.1e-7 for softplus.
    np.testing.assert_allclose(found, getattr(np, function)(x.astype(np.float64)), rtol=2.4e-7)


def test_sine_and_cosine_have_small_absolute_errors_up_to_a_million() -> None:
    x = np.concatenate([np.linspace(-1e6, 1e6, 100_001), np.linspace(-7.0, 7.0, 10_001)])
    for found, expected in ((pm.sin(x), np.sin(x)), (pm.cos(x), np.cos(x))):
        np.testing.assert_allclose(found, expected, rtol=0, atol=3e-16)  # measured: 1.1e-16


@pytest.mark.parametrize("degree", [2, 3, 4, 5])
def test_roots_taken_to_their_power_are_what_was_there(degree: int) -> None:
    # A relative error e of the root is degree e of its power, which rounds degree - 1 times.
    found = pm.root(SIZES, degree) ** degree
    np.testing.assert_allclose(found, SIZES, rtol=1.2e-15, atol=0)  # measured: 8.9e-16


def test_powers() -> None:
    x = np.linspace(1e-3, 20.0, 10_001)
    np.testing.assert_allclose(pm.power(x, 2.4), x**2.4, rtol=3e-15)  # measured: 1.9e-15
    assert pm.integer_power(0.5, 3) == 0.125
    assert pm.integer_power(0.999, 0) == 1.0
    assert pm.integer_power(0.999, 4000) == pytest.approx(0.999**4000, rel=1e-12)


def test_ends_and_nan() -> None:
    nan, inf = np.nan, np.inf
    x = np.array([-inf, -1.0, 0.0, inf, nan])
    np.testing.assert_array_equal(pm.log(x), [nan, nan, -inf, inf, nan])
    np.testing.assert_array_equal(pm.log1p(x[1:]), [-inf, 0.0, inf, nan])
    np.testing.assert_array_equal(pm.root(x, 3), [nan, nan, 0.0, inf, nan])
    low, high, none = pm.exp(x[[0, 3, 4]])
    assert 0 < low < 1e-300
    assert 1e300 < high < inf  # saturates
    assert np.isnan(none)
    assert pm.log(5e-324) == pytest.approx(np.log(5e-324), rel=1e-15)


def test_shapes_are_kept_and_products_are_those_of_numpy() -> None:
    g = np.random.default_rng(1)
    assert pm.exp(0.0).shape == ()
    assert pm.exp(np.zeros((3, 0, 2))).shape == (3, 0, 2)
    big = g.normal(size=(3, 7000))  # several blocks
    np.testing.assert_array_equal(pm.exp(big)[2, 5:9], pm.exp(big[2, 5:9]))
    a, b, v = g.normal(size=(5, 4, 3)), g.normal(size=(3, 6)), g.normal(size=3)
    np.testing.assert_allclose(pm.matmul(a, b), a @ b, rtol=0, atol=1e-14)
    np.testing.assert_allclose(pm.matmul(a, v), a @ v, rtol=0, atol=1e-14)
    assert pm.norm(v) == pytest.approx(np.linalg.norm(v), rel=1e-15)
