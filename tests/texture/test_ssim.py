"""Structural similarity: the value is that of the metric, the adjoint that of the value."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd.fitting.loss import ssim, ssim_backward
from photograd_course import metrics
from photograd_course.gradcheck import check_gradient, taylor_slope

from support.bits import same_bits
from support.gradient_mutants import check_gradient_mutants


def pictures(seed: int, channels: int = 3, dtype: Any = np.float64) -> tuple[Any, Any]:
    """A noisy picture and another that resembles it, 14 x 17."""
    g = np.random.default_rng(seed)
    one = g.uniform(0.1, 0.9, (14, 17, channels))
    two = np.clip(one + 0.2 * g.normal(size=one.shape), 0, 1)
    return one.astype(dtype), two.astype(dtype)


@pytest.mark.parametrize("channels", [1, 3, 4])
def test_value_is_the_metric(channels: int) -> None:
    x, y = pictures(1, channels)
    assert ssim(x, y) == pytest.approx(metrics.ssim(x, y), abs=1e-12)  # measured: 1e-16
    assert ssim(x, x) == pytest.approx(1.0, abs=1e-12)
    few, many = (a.astype(np.float32) for a in (x, y))
    assert ssim(few, many) == pytest.approx(metrics.ssim(x, y), abs=1e-6)  # measured: 2e-8


def test_the_smallest_picture_has_one_window() -> None:
    x, y = (a[:11, :11] for a in pictures(2))
    assert ssim(x, y) == pytest.approx(metrics.ssim(x, y), abs=1e-12)


class Proof:
    def __init__(self, seed: int) -> None:
        x, self.y = pictures(seed)
        self.place = {"x": x}

    def forward(self, params: dict[str, Any]) -> dict[str, Any]:
        return {"value": np.array(ssim(params["x"], self.y))}

    def backward(self, params: dict[str, Any], d: dict[str, Any]) -> dict[str, Any]:
        return {"x": ssim_backward(params["x"], self.y, float(d["value"]))[1]}


def test_gradient_agrees_with_central_differences() -> None:
    proof = Proof(3)
    assert 0.1 < ssim(proof.place["x"], proof.y) < 0.9
    report = check_gradient(proof.forward, proof.backward, proof.place, seed=3)
    assert report, str(report)
    slope = taylor_slope(proof.forward, proof.backward, proof.place, seed=3)
    assert slope, str(slope)


def test_wrong_gradients_die() -> None:
    proof = Proof(4)
    report = check_gradient_mutants(
        proof.forward, proof.backward, proof.place, {"value": np.array(0.7)}, seed=5, directions=4
    )
    assert report, str(report)
    assert len(report.killed) >= 3


def test_backward_adds_and_returns_the_value() -> None:
    x, y = pictures(5)
    value, d_x = ssim_backward(x, y, 2.0)
    assert value == ssim(x, y)
    twice = d_x.copy()
    _core.ssim_backward(x, y, 2.0, twice)
    np.testing.assert_allclose(twice, 2 * d_x, rtol=1e-12)


@same_bits("SSIM")
def value_and_gradient() -> list[Any]:
    return list(ssim_backward(*pictures(6, dtype=np.float32)))


def test_float_agrees_with_double() -> None:
    x, y = pictures(6, dtype=np.float32)
    exact = ssim_backward(x.astype(np.float64), y.astype(np.float64))[1]
    error = np.linalg.norm(value_and_gradient()[1] - exact)
    assert error <= 1e-4 * np.linalg.norm(exact)  # measured: 1e-6


def test_what_does_not_fit_is_refused() -> None:
    x, y = pictures(7)
    with pytest.raises(RangeError, match="ssim: x: expected at least 11 x 11 pixels, got 10 x 17"):
        ssim(x[:10], y[:10])
    with pytest.raises(ShapeError, match="y: expected shape"):
        ssim(x, y[:, :12])
    with pytest.raises(DtypeError, match="y"):
        ssim(x, y.astype(np.float32))
    with pytest.raises(RangeError, match="1 to 4 channels, got 5"):
        ssim(np.zeros((12, 12, 5)), np.zeros((12, 12, 5)))
