"""The kernel of spherical harmonics: the bits of its scalar form, whatever computes them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd import sh
from photograd._compiled import _core

from support.bits import same_bits

pytestmark = pytest.mark.usefixtures("core")

DEGREES = (1, 2, 3, 4)


def inputs(degree: int, count: int) -> tuple[Any, Any, Any]:
    """Coefficients (N, K, 3), unit directions (N, 3), cotangents of the colors (N, 3)."""
    random = np.random.default_rng(degree)
    d = random.normal(size=(count, 3))
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    coefficients = random.normal(size=(count, sh.count(degree), 3))
    arrays = (coefficients, d, random.normal(size=(count, 3)))
    return tuple(np.asarray(array, np.float32) for array in arrays)


def all_results(degree: int, count: int, *, fused: bool, add: bool = False) -> list[Any]:
    """Colors, and the derivatives with respect to directions and coefficients."""
    coefficients, d, w = inputs(degree, count)
    results = [np.full_like(w, 7), np.full_like(d, 7), np.full_like(coefficients, 7)]
    _core.sh_colors(d, coefficients, results[0], fused)
    _core.sh_colors_backward(d, coefficients, w, *results[1:], add, fused)
    return results


@pytest.mark.parametrize("add", [False, True])
@pytest.mark.parametrize("degree", DEGREES)
def test_kernel_and_scalar_form_agree_bit_for_bit(degree: int, add: bool) -> None:
    for count in (1, 3, 16, 37, 4096 + 19):  # not whole blocks of 16, and more than one task
        kernel = all_results(degree, count, fused=True, add=add)
        scalar = all_results(degree, count, fused=False, add=add)
        for got, expected in zip(kernel, scalar, strict=True):
            np.testing.assert_array_equal(got, expected)
            assert (got != 7).mean() > 0.99


def test_nothing_beside_the_rows_is_written() -> None:
    coefficients, d, w = inputs(3, 21)
    colors, d_d, d_c = (np.full((25, *a.shape[1:]), 7, np.float32) for a in (w, d, coefficients))
    _core.sh_colors(d, coefficients, colors[2:23])
    _core.sh_colors_backward(d, coefficients, w, d_d[2:23], d_c[2:23], False)
    for array in (colors, d_d, d_c):
        assert (array[:2] == 7).all()
        assert (array[23:] == 7).all()


def test_out_is_overwritten_and_returned() -> None:
    coefficients, d, w = inputs(3, 20)
    out = np.full_like(w, np.nan)
    assert sh.evaluate(coefficients, d, out=out) is out
    np.testing.assert_array_equal(out, sh.evaluate(coefficients, d))
    pair = np.full_like(coefficients, np.nan), np.full_like(d, np.nan)
    assert sh.evaluate_backward(coefficients, d, w, out=pair)[0] is pair[0]
    for got, expected in zip(pair, sh.evaluate_backward(coefficients, d, w), strict=True):
        np.testing.assert_array_equal(got, expected)


def test_what_is_no_number_shows_in_its_own_row_only() -> None:
    coefficients, d, w = inputs(3, 40)
    coefficients[17, 15, 1] = np.nan
    d[33, 2] = np.inf
    colors = sh.evaluate(coefficients, d)
    d_c, d_d = sh.evaluate_backward(coefficients, d, w)
    bad = [17, 33]
    assert np.isnan(colors[17, 1])
    assert not np.isfinite(colors[33]).any()
    assert not np.isfinite(d_d[17]).all()
    assert not np.isfinite(d_c[33]).all()
    for array in (colors, d_c, d_d):
        assert np.isfinite(np.delete(array, bad, axis=0)).all()


@same_bits("sh_colors", each=map(str, DEGREES), kernels=("sh_rgb", "sh_rgb_backward"))
def many_rows(degree: str) -> list[Any]:
    return all_results(int(degree), 20_000, fused=True)
