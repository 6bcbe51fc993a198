"""The gate for adjoints lets the right one through and no other."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from photograd_course.grading import CheckFailed, GraderFault, Number, Tolerance, Trial, check
from photograd_course.grading.adjoint_gate import (
    agrees_with_finite_differences,
    central_differences,
    is_the_transpose,
    matrix_of,
    random_cotangent,
    require_cheap,
    require_zero_for_zero,
)
from photograd_course.grading.local import LocalStudent

CODE = """
def fast(x):
    return float((x * x).sum())

def slow(x):
    return [float((x * x).sum()) for _ in range(2000)][0]
"""


@pytest.fixture
def trial() -> Trial:
    made = check("1.x", points=1, calls=(), tolerance=Tolerance(1e-9, "tests"))(_body)
    return Trial(made, LocalStudent({"m": CODE}), seed=(1,), module="m")


def _body(t: Trial) -> None:
    """Something holds."""


POINT = {"a": np.array([0.3, -1.2, 2.0]), "b": np.array(0.7)}
COTANGENT = np.array([0.2, -0.9, 0.5])


def forward(p: Any) -> np.ndarray:
    return np.sin(p["a"]) * np.exp(p["b"])


def gradients() -> dict[str, np.ndarray]:
    a, b = POINT["a"], POINT["b"]
    return {
        "a": COTANGENT * np.cos(a) * np.exp(b),
        "b": np.asarray((COTANGENT * np.sin(a)).sum() * np.exp(b)),
    }


def test_differences_agree_with_the_derivative_to_1e_9() -> None:
    for group, right in gradients().items():
        found = central_differences(forward, POINT, group, COTANGENT)
        assert np.linalg.norm(found - right) < 1e-9 * np.linalg.norm(right)


def test_the_right_gradient_passes(trial: Trial) -> None:
    agrees_with_finite_differences(trial, gradients(), forward, POINT, COTANGENT)
    assert max(trial.margins) < 1e-2


@pytest.mark.parametrize("group", ["a", "b"])
@pytest.mark.parametrize("change", [0.0, -1.0, 2.0, 1.00001])
def test_a_wrong_group_is_caught(trial: Trial, group: str, change: float) -> None:
    wrong = gradients()
    wrong[group] = wrong[group] * change
    with pytest.raises(CheckFailed, match=f"d_{group}"):
        agrees_with_finite_differences(trial, wrong, forward, POINT, COTANGENT)


def test_a_place_without_gradient_proves_nothing(trial: Trial) -> None:
    with pytest.raises(CheckFailed, match="all zero"):
        agrees_with_finite_differences(
            trial, {"a": np.zeros(3)}, lambda p: 0 * p["a"], POINT, COTANGENT
        )


def test_a_transpose_passes_and_another_matrix_does_not(trial: Trial) -> None:
    rng = np.random.default_rng(3)
    matrix, x, g = rng.normal(size=(4, 3)), rng.normal(size=3), rng.normal(size=4)
    is_the_transpose(trial, "<x, S* g>", x, matrix @ x, g, matrix.T @ g)
    with pytest.raises(CheckFailed, match="<x, S"):
        is_the_transpose(trial, "<x, S* g>", x, matrix @ x, g, 1.001 * matrix.T @ g)
    with pytest.raises(CheckFailed):
        is_the_transpose(trial, "<x, S* g>", x, matrix @ x, g, np.full(3, np.nan))


def test_a_transpose_with_several_inputs(trial: Trial) -> None:
    rng = np.random.default_rng(4)
    a, b, g = rng.normal(size=(2, 3)), rng.normal(size=5), rng.normal(size=(2, 3))
    forth = 2.0 * a + b.sum()
    back = (2.0 * g, np.full(5, g.sum()))
    is_the_transpose(trial, "both", (a, b), forth, g, back)
    with pytest.raises(CheckFailed):
        is_the_transpose(trial, "both", (a, b), forth, g, (back[0], 0.9 * back[1]))


def test_orthogonal_sides_are_compared_with_the_size_of_their_factors(trial: Trial) -> None:
    x, g = np.array([1.0, 0.0]), np.array([0.0, 1.0])
    is_the_transpose(trial, "<x, g>", x, x, g, g + 1e-12)
    with pytest.raises(CheckFailed):
        is_the_transpose(trial, "<x, g>", x, x, g, g + 1e-6)


def test_a_transpose_without_a_tolerance_is_the_graders_fault(trial: Trial) -> None:
    trial.check = dataclasses.replace(trial.check, tolerance=None)
    with pytest.raises(GraderFault):
        is_the_transpose(trial, "x", np.ones(1), np.ones(1), np.ones(1), np.ones(1))


def test_the_matrix_of_a_linear_function(trial: Trial, monkeypatch: pytest.MonkeyPatch) -> None:
    matrix = np.random.default_rng(5).normal(size=(4, 6))

    def call(function, values, places, *, returns):
        got = matrix[: len(places)] @ values.reshape(6, -1)
        returns.require(got, function)
        return got

    monkeypatch.setattr(trial, "call", call)
    np.testing.assert_array_equal(matrix_of(trial, "f", (2, 3), np.zeros((4, 2))), matrix)


def test_zero_in_zero_out(trial: Trial) -> None:
    require_zero_for_zero(trial, {"a": np.zeros(3), "b": -0.0})
    with pytest.raises(CheckFailed, match="d_a"):
        require_zero_for_zero(trial, {"a": np.array([0.0, 1e-300])})


def test_cotangents_are_never_uniform() -> None:
    g = random_cotangent(np.random.default_rng(1), (200,))
    assert np.abs(g).max() <= 1
    assert np.unique(g).size == 200


def test_what_costs_like_differences_is_caught(trial: Trial) -> None:
    x = np.linspace(0, 1, 2000)
    require_cheap(trial, ("fast", (x,), Number()), ("fast", (x,), Number()))
    with pytest.raises(CheckFailed, match="forward calls"):
        require_cheap(trial, ("fast", (x,), Number()), ("slow", (x,), Number()))
