"""Losses: values by hand, gradients by differences, mutants killed, bad input refused."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from photograd_course import losses
from photograd_course.errors import DtypeError, RangeError, ShapeError
from photograd_course.gradcheck import check_gradient, draw_like, taylor_slope
from photograd_course.mutants import check_mutants

PREDICTION = draw_like((6, 5, 3), seed=1, stream=0)
TARGET = draw_like((6, 5, 3), seed=1, stream=1)
DELTA = 0.4
PAIRS: dict[str, tuple[Callable[..., float], Callable[..., Any], dict[str, float]]] = {
    "l2": (losses.l2, losses.l2_backward, {}),
    "l1": (losses.l1, losses.l1_backward, {}),
    "huber": (losses.huber, losses.huber_backward, {"delta": DELTA}),
}


def test_values_by_hand() -> None:
    prediction, target = np.array([1.0, 3.0, -2.0, 0.0]), np.array([0.0, 1.0, -2.0, 0.25])
    assert losses.l2(prediction, target) == (1.0 + 4.0 + 0.0 + 0.0625) / 4.0
    assert losses.l1(prediction, target) == (1.0 + 2.0 + 0.0 + 0.25) / 4.0
    expected = (0.5 * (1.0 - 0.25) + 0.5 * (2.0 - 0.25) + 0.0 + 0.5 * 0.0625) / 4.0
    assert losses.huber(prediction, target, delta=0.5) == expected
    np.testing.assert_array_equal(losses.l2_backward(prediction, target), [0.5, 1.0, 0.0, -0.125])
    np.testing.assert_array_equal(losses.l1_backward(prediction, target), [0.25, 0.25, 0.0, -0.25])
    half = losses.huber_backward(prediction, target, 2.0, delta=0.5)
    np.testing.assert_array_equal(half, [0.25, 0.25, 0.0, -0.125])


@pytest.mark.parametrize("name", PAIRS)
def test_gradient_and_its_mutants(name: str) -> None:
    loss, loss_backward, options = PAIRS[name]
    # Kinks lie at r = 0 (l1) and |r| = delta (huber, second derivative only): stay clear of them.
    residual = np.abs(PREDICTION - TARGET)
    assert residual.min() > 1e-4
    assert np.abs(residual - DELTA).min() > 1e-4
    place = {"prediction": PREDICTION}

    def function(p: dict[str, np.ndarray]) -> float:
        return loss(p["prediction"], TARGET, **options)

    def backward(p: dict[str, np.ndarray], d_loss: float) -> dict[str, np.ndarray]:
        return {"prediction": loss_backward(p["prediction"], TARGET, d_loss, **options)}

    def check(candidate: Any) -> object:
        return check_gradient(function, candidate, place, seed=2, steps=(1e-4, 1e-5, 1e-6))

    report = check(backward)
    assert report, str(report)
    if name == "l2":  # the others have a kink within reach of a large step
        slope = taylor_slope(function, backward, place, seed=3)
        assert slope, str(slope)
    mutants = check_mutants(check, backward, place, 0.7)
    assert mutants, str(mutants)
    assert len(mutants.killed) == 4


@pytest.mark.parametrize("name", PAIRS)
def test_float32_follows_float64(name: str) -> None:
    loss, loss_backward, options = PAIRS[name]
    prediction, target = PREDICTION.astype(np.float32), TARGET.astype(np.float32)
    # Rounding of one float32 difference is 6e-8 of its size; the mean runs in float64.
    assert loss(prediction, target, **options) == pytest.approx(
        loss(PREDICTION, TARGET, **options), rel=1e-6
    )
    gradient = loss_backward(prediction, target, **options)
    assert gradient.dtype == np.float32
    exact = loss_backward(PREDICTION, TARGET, **options)
    assert np.linalg.norm(gradient - exact) <= 1e-6 * np.linalg.norm(exact)


def test_a_batch_in_two_halves_gives_the_same_mean_gradient() -> None:
    whole = losses.l2_backward(PREDICTION, TARGET)
    halves = [losses.l2_backward(PREDICTION[i : i + 3], TARGET[i : i + 3]) / 2 for i in (0, 3)]
    np.testing.assert_allclose(whole, np.concatenate(halves), rtol=1e-15)
    assert np.abs(whole).max() > 0.0


@pytest.mark.parametrize("name", PAIRS)
def test_bad_input_is_refused(name: str) -> None:
    for function in PAIRS[name][:2]:
        options = PAIRS[name][2]
        with pytest.raises(ShapeError, match="target: expected shape"):
            function(np.ones((4, 3)), np.ones((1, 3)), **options)
        with pytest.raises(DtypeError, match="target: expected float64"):
            function(np.ones(3), np.ones(3, np.float32), **options)
        with pytest.raises(DtypeError, match="prediction: expected a NumPy array"):
            function([1.0], np.ones(1), **options)
        with pytest.raises(DtypeError, match="float32 or float64"):
            function(np.ones(3, np.uint8), np.ones(3, np.uint8), **options)
        with pytest.raises(ShapeError, match="at least one element"):
            function(np.ones((0, 3)), np.ones((0, 3)), **options)
    with pytest.raises(RangeError, match="delta"):
        losses.huber(np.ones(3), np.ones(3), delta=0.0)
    with pytest.raises(RangeError, match="d_loss"):
        losses.l2_backward(np.ones(3), np.ones(3), np.nan)
