"""Priors: direct loops as oracles, gradients by differences, accumulation, mutants."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from photograd_course import priors
from photograd_course.errors import DtypeError, RangeError, ShapeError
from photograd_course.gradcheck import check_accumulation, check_gradient, draw_like
from photograd_course.mutants import check_mutants, check_overwriting_mutants

Arrays = dict[str, np.ndarray]
GRID = draw_like((5, 4, 3, 2), seed=1, stream=0)
PAIRS: dict[str, tuple[Callable[..., float], Callable[..., Any], dict[str, float]]] = {
    "squared": (priors.total_variation_squared, priors.total_variation_squared_backward, {}),
    "smoothed": (
        priors.total_variation_smoothed,
        priors.total_variation_smoothed_backward,
        {"epsilon": 0.1},
    ),
    "cauchy": (priors.sparsity_cauchy, priors.sparsity_cauchy_backward, {"scale": 0.3}),
    "l1": (priors.sparsity_l1, priors.sparsity_l1_backward, {}),
}


def direct(name: str, grid: np.ndarray) -> float:
    """The definition of each prior, one element at a time."""
    total = 0.0
    for index in itertools.product(*(range(n) for n in grid.shape)):
        value, squares = float(grid[index]), 0.0
        for axis in range(3):
            if index[axis] + 1 < grid.shape[axis]:
                ahead = list(index)
                ahead[axis] += 1
                squares += (float(grid[tuple(ahead)]) - value) ** 2
        total += {
            "squared": squares,
            "smoothed": math.sqrt(squares + 0.01) - 0.1,
            "cauchy": math.log(1.0 + (value / 0.3) ** 2),
            "l1": abs(value),
        }[name]
    return total / grid.size


@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize("shape", [(5, 4, 3, 2), (6, 5, 4), (1, 3, 1), (3, 1, 1, 2)])
@pytest.mark.parametrize("slab", [1, 30, 65_536])
def test_value_against_the_definition(
    name: str, shape: tuple[int, ...], slab: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(priors, "_SLAB", slab)
    function, backward, options = PAIRS[name]
    grid = draw_like(shape, seed=2, stream=0)
    expected = direct(name, grid)
    assert expected > 0.0
    assert function(grid, **options) == pytest.approx(expected, rel=1e-13)
    single = function(grid.astype(np.float32), **options)
    # Differences of float32 values of size 1 are off by 6e-8 each.
    assert single == pytest.approx(expected, rel=2e-6)
    gradient = backward(grid, **options)
    follows = backward(grid.astype(np.float32), **options)
    assert follows.dtype == np.float32
    assert np.linalg.norm(follows - gradient) <= 2e-6 * np.linalg.norm(gradient)


@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize("slab", [30, 65_536])
def test_gradient_and_its_mutants(name: str, slab: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(priors, "_SLAB", slab)
    function, backward, options = PAIRS[name]
    assert np.abs(GRID).min() > 1e-3, "l1 has its kink at zero"

    def accumulate(p: Arrays, d_loss: float, d_p: Arrays) -> None:
        returned = backward(p["grid"], d_loss, d_p["grid"], **options)
        assert returned is d_p["grid"]

    def fresh(p: Arrays, d_loss: float) -> Arrays:
        return {"grid": backward(p["grid"], d_loss, **options)}

    def check(candidate: Any) -> object:
        return check_gradient(
            lambda p: function(p["grid"], **options),
            candidate,
            {"grid": GRID},
            seed=3,
            steps=(1e-4, 1e-5, 1e-6),
        )

    report = check(fresh)
    assert report, str(report)
    mutants = check_mutants(check, fresh, {"grid": GRID}, 0.7)
    assert mutants, str(mutants)
    overwriting = check_overwriting_mutants(
        lambda a: check_accumulation(a, {"grid": GRID}, 0.7), accumulate, {"grid": GRID}, 0.7
    )
    assert overwriting, str(overwriting)


def test_the_two_variations_differ_as_documented() -> None:
    grid = draw_like((6, 6, 6), seed=4, stream=0)
    gentle = 1e-4 * grid
    squared = priors.total_variation_squared(gentle)
    # sqrt(s + e^2) - e = s / (2 e) (1 - s / (4 e^2) + ...), with s / e^2 below 1e-4 here.
    smoothed = priors.total_variation_smoothed(gentle, epsilon=0.05)
    assert smoothed == pytest.approx(squared / 0.1, rel=1e-4)
    edge = np.zeros((8, 2, 2))
    edge[4:] = 1.0
    one = priors.total_variation_smoothed(edge, epsilon=1e-9)
    assert priors.total_variation_smoothed(3 * edge, epsilon=1e-9) == pytest.approx(3 * one)
    assert priors.total_variation_squared(3 * edge) == pytest.approx(
        9 * priors.total_variation_squared(edge)
    )


def test_constants_cost_nothing() -> None:
    flat = np.full((4, 4, 4), 2.5)
    assert priors.total_variation_squared(flat) == 0.0
    assert priors.total_variation_smoothed(flat, epsilon=0.1) == 0.0
    assert not priors.total_variation_smoothed_backward(flat, epsilon=0.1).any()


def test_bad_input_is_refused() -> None:
    with pytest.raises(ShapeError, match="grid"):
        priors.total_variation_squared(np.ones((3, 3)))
    with pytest.raises(DtypeError, match="grid"):
        priors.total_variation_smoothed(np.ones((3, 3, 3), np.int32), epsilon=0.1)
    with pytest.raises(RangeError, match="epsilon"):
        priors.total_variation_smoothed(GRID, epsilon=0.0)
    with pytest.raises(ShapeError, match="d_grid"):
        priors.total_variation_squared_backward(GRID, 1.0, np.zeros((5, 4, 3)))
    with pytest.raises(DtypeError, match="d_density"):
        priors.sparsity_l1_backward(GRID, 1.0, np.zeros(GRID.shape, np.float32))
    with pytest.raises(RangeError, match="scale"):
        priors.sparsity_cauchy(GRID, scale=-1.0)
    with pytest.raises(RangeError, match="d_loss"):
        priors.sparsity_cauchy_backward(GRID, math.inf, scale=1.0)
    with pytest.raises(ShapeError, match="at least one"):
        priors.sparsity_l1(np.zeros((0, 3)))
