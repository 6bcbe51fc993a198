"""Bloom moves light and adds none; its blurs are separable; its adjoint is the transpose."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.frame import bloom, bloom_backward
from photograd_course.gradcheck import check_gradient

from support.gradient_mutants import check_gradient_mutants

pytestmark = pytest.mark.usefixtures("core")
WEIGHTS = np.array([0.2, 0.3, 0.1])


def functions() -> tuple[Any, Any, dict[str, Any]]:
    color = np.random.default_rng(3).uniform(0, 2, (7, 10, 3))
    color[np.abs(color - 0.5) < 1e-3] = 0.6  # no kink within the steps of differences

    def forward(p: dict[str, Any]) -> Any:
        return bloom(p["color"], p["weights"], float(p["threshold"][0]))

    def backward(p: dict[str, Any], d: Any) -> dict[str, Any]:
        found = bloom_backward(p["color"], p["weights"], d, float(p["threshold"][0]))
        return {"color": found[0], "weights": found[1], "threshold": np.array([found[2]])}

    return forward, backward, {"color": color, "weights": WEIGHTS, "threshold": np.array([0.5])}


def test_everything_agrees_with_central_differences() -> None:
    report = check_gradient(*functions(), seed=1)
    assert report, str(report)


def test_wrong_gradients_are_noticed() -> None:
    forward, backward, place = functions()
    cotangent = np.random.default_rng(2).uniform(-1, 1, place["color"].shape)
    report = check_gradient_mutants(forward, backward, place, cotangent, seed=1, coordinates=8)
    assert report, str(report)


def line(n: int, m: int, taps: list[tuple[int, float]], step: int, top: int) -> Any:
    """(m, n): row i has the weights `taps` around `step` i."""
    matrix = np.zeros((m, n))
    for i in range(m):
        for offset, weight in taps:
            j = (step * i) // top + offset
            j = -1 - j if j < 0 else 2 * n - 1 - j if j >= n else j
            matrix[i, j] += weight
    return matrix


def test_two_passes_are_the_whole_blur_in_two_dimensions() -> None:
    color = np.random.default_rng(4).uniform(0, 1, (8, 12, 3))
    taps = [(-1, 0.125), (0, 0.375), (1, 0.375), (2, 0.125)]
    down = [line(8, 4, taps, 2, 1), line(12, 6, taps, 2, 1)]

    def up(n: int) -> Any:
        matrix = np.zeros((2 * n, n))
        for i in range(2 * n):
            matrix[i, i // 2] += 0.75
            matrix[i, np.clip(i // 2 + (1 if i % 2 else -1), 0, n - 1)] += 0.25
        return matrix

    whole = [up(4) @ down[0], up(6) @ down[1]]
    kernel = np.einsum("ai,bj->abij", *whole)  # one weight for each pair of pixels
    blurred = np.einsum("abij,ijc->abc", kernel, color)
    np.testing.assert_allclose(bloom(color, [1.0]), blurred, atol=1e-12)


def test_light_is_moved_and_not_added() -> None:
    constant = np.full((9, 14, 3), 0.7)
    np.testing.assert_allclose(bloom(constant, WEIGHTS), constant, rtol=1e-14)
    point = np.zeros((64, 64, 3))
    point[30, 33] = [1e4, 10.0, 1.0]  # no clamp on the way
    spread = bloom(point, WEIGHTS)
    np.testing.assert_allclose(spread.sum(axis=(0, 1)), point.sum(axis=(0, 1)), rtol=1e-12)
    assert spread[30, 33, 0] > 4e3
    assert (spread >= 0).all()


def test_nothing_happens_without_weights_or_brights() -> None:
    color = np.random.default_rng(5).uniform(0, 1, (6, 5, 3))
    np.testing.assert_array_equal(bloom(color, np.zeros(4)), color)
    np.testing.assert_array_equal(bloom(color, WEIGHTS, 1.0), color)


def test_what_would_add_light_is_refused() -> None:
    with pytest.raises(RangeError, match=r"bloom: weights.sum\(\)"):
        bloom(np.zeros((4, 4, 3)), [0.6, 0.6])
    with pytest.raises(RangeError, match="bloom: weights: expected 1 to 16 levels"):
        bloom(np.zeros((4, 4, 3)), np.zeros(17))
