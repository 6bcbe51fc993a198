"""The gate for adjoints lets the right one through and no other."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd_course.grading import CheckFailed, Number, Tolerance, Trial, check
from photograd_course.grading.adjoint_gate import (
    central_differences,
    random_cotangent,
    require_cheap,
    require_gradients,
    require_transpose,
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
    require_gradients(trial, gradients(), forward, POINT, COTANGENT)
    assert max(trial.margins) < 1e-2


@pytest.mark.parametrize("group", ["a", "b"])
@pytest.mark.parametrize("change", [0.0, -1.0, 2.0, 1.00001])
def test_a_wrong_group_is_caught(trial: Trial, group: str, change: float) -> None:
    wrong = gradients()
    wrong[group] = wrong[group] * change
    with pytest.raises(CheckFailed, match=f"d_{group}"):
        require_gradients(trial, wrong, forward, POINT, COTANGENT)


def test_a_place_without_gradient_proves_nothing(trial: Trial) -> None:
    with pytest.raises(CheckFailed, match="all zero"):
        require_gradients(trial, {"a": np.zeros(3)}, lambda p: 0 * p["a"], POINT, COTANGENT)


def test_a_transpose_passes_and_another_matrix_does_not(trial: Trial) -> None:
    matrix = np.random.default_rng(3).normal(size=(4, 3))
    shapes = ((3,), (4,))
    require_transpose(trial, lambda x: matrix @ x, lambda g: matrix.T @ g, shapes)
    with pytest.raises(CheckFailed):
        require_transpose(trial, lambda x: matrix @ x, lambda g: 1.001 * matrix.T @ g, shapes)
    with pytest.raises(CheckFailed, match="zero"):
        require_transpose(trial, lambda x: 0 * matrix @ x, lambda g: 0 * matrix.T @ g, shapes)


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
