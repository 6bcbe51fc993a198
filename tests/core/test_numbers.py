"""Portable exp, expm1 and log1p against NumPy's; random numbers against Python's."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd_course import portable_math
from photograd_course.random import philox4x32, uniform

# Bounds: the polynomials' remainders (5e-9, 4e-18) plus two to four roundings of each type.
PRECISIONS = [(np.float32, 2e-7), (np.float64, 5e-16)]


def worst(found: Any, expected: Any) -> float:
    return float(np.abs(found.astype(np.float64) / expected - 1).max())


@pytest.mark.parametrize(("dtype", "bound"), PRECISIONS)
def test_exp(dtype: Any, bound: float) -> None:
    x = np.linspace(-86, 87, 200001).astype(dtype)
    assert worst(_core.exp(x), np.exp(x.astype(np.float64))) <= bound


@pytest.mark.parametrize(("dtype", "bound"), PRECISIONS)
def test_expm1_keeps_its_digits_near_zero(dtype: Any, bound: float) -> None:
    x = -np.logspace(-12, 1.5, 50001).astype(dtype)
    assert worst(_core.expm1(x), np.expm1(x.astype(np.float64))) <= bound


@pytest.mark.parametrize(("dtype", "bound"), PRECISIONS)
def test_log1p_keeps_its_digits_near_zero(dtype: Any, bound: float) -> None:
    x = np.logspace(-12, 0, 50001).astype(dtype)
    assert worst(_core.log1p_unit(x), np.log1p(x.astype(np.float64))) <= bound


def test_exp_saturates_instead_of_overflowing() -> None:
    x = np.array([-1e30, 1e30], np.float32)
    low, high = _core.exp(x)
    assert 0 < low < 1e-37
    assert np.isfinite(high)
    assert high > 1e38


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("name", ["exp", "expm1"])
def test_both_languages_have_the_same_exponentials(name: str, dtype: Any) -> None:
    x = np.linspace(-800, 800, 200001).astype(dtype)
    assert np.array_equal(getattr(_core, name)(x), getattr(portable_math, name)(x))


def test_philox_is_the_same_in_both_languages() -> None:
    g = np.random.default_rng(5)
    counter = g.integers(0, 2**32, (500, 4), dtype=np.uint32)
    key = g.integers(0, 2**32, (500, 2), dtype=np.uint32)
    assert np.array_equal(_core.philox4x32(counter, key), philox4x32(counter, key))


def test_uniform_is_the_same_in_both_languages() -> None:
    pixel = np.arange(1000)
    seed, step = (7 << 32) + 3, 11
    for dimension in (0, 1, 5, 1023):
        mine = _core.uniform(seed, step, pixel.astype(np.uint32), 2, dimension)
        python = uniform(seed, step=step, pixel=pixel, sample=2, dimension=dimension)
        assert np.array_equal(mine, python)
    assert abs(mine.mean() - 0.5) < 0.03  # three standard errors of 1000 numbers
