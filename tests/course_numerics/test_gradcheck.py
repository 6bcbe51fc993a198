"""The gradient checks accept right gradients and reject wrong, empty and non-finite ones."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd_course import gradcheck
from photograd_course.errors import DtypeError, RangeError, ShapeError
from photograd_course.gradcheck import (
    check_accumulation,
    check_gradient,
    dot_product_error,
    draw_like,
    taylor_slope,
)

Arrays = dict[str, np.ndarray]


def place() -> Arrays:
    return {
        "a": 1.5 + draw_like((4, 3), seed=1, stream=0),
        "b": draw_like((3,), seed=2, stream=0) * 1e-3,
        "c": np.array(0.7),
    }


def value(p: Arrays) -> np.ndarray:
    return np.sin(p["a"]) * np.exp(p["b"]) + p["c"] * p["a"] ** 2


def backward(p: Arrays, d_out: np.ndarray) -> Arrays:
    return {
        "a": d_out * (np.cos(p["a"]) * np.exp(p["b"]) + 2.0 * p["c"] * p["a"]),
        "b": (d_out * np.sin(p["a"]) * np.exp(p["b"])).sum(axis=0),
        "c": np.array((d_out * p["a"] ** 2).sum()),
    }


def scaled(group: str, factor: float) -> Any:
    def wrong(p: Arrays, d_out: np.ndarray) -> Arrays:
        gradients = backward(p, d_out)
        gradients[group] = gradients[group] * factor
        return gradients

    return wrong


def test_the_right_gradient_passes() -> None:
    report = check_gradient(value, backward, place(), seed=3)
    assert report.passed, str(report)
    assert report
    assert [group.name for group in report.groups] == ["a", "b", "c"]
    # Central differences of a smooth float64 function agree at a step in the middle.
    assert all(0.0 < group.error < 1e-7 for group in report.groups)
    assert all(len(group.curve) == 1 for group in report.groups)
    assert "passed" in str(report)


@pytest.mark.parametrize("group", ["a", "b", "c"])
@pytest.mark.parametrize("factor", [0.0, -1.0, 2.0, 1.0 + 1e-5])
def test_a_wrong_group_is_named(group: str, factor: float) -> None:
    report = check_gradient(value, scaled(group, factor), place(), seed=3)
    assert not report
    (failed,) = (g for g in report.groups if not g.passed)
    assert failed.name == group
    assert [step for step, _ in failed.curve] == list(gradcheck.STEPS)
    assert "FAILED" in str(report)


def test_nan_fails_everywhere() -> None:
    wrong = scaled("a", np.nan)
    assert not check_gradient(value, wrong, place(), seed=3)
    assert not taylor_slope(value, wrong, place(), seed=3)
    assert not dot_product_error(jvp, wrong, place(), seed=3)
    only_late = {"a": np.array([0.5])}
    nan_value = lambda p: p["a"] * np.nan  # noqa: E731
    assert not check_gradient(nan_value, lambda _, d: {"a": d}, only_late, seed=3)
    assert not check_gradient(value, backward, place(), seed=3, tolerance=0.0)


def test_an_empty_test_fails() -> None:
    p = {"a": np.array([1.0, 2.0])}
    silent = check_gradient(lambda p: 0.0 * p["a"], lambda _, d: {"a": 0.0 * d}, p, seed=1)
    assert not silent
    assert "empty test" in str(silent)
    constant = check_gradient(lambda _: np.ones(2), lambda _, d: {"a": 0.0 * d}, p, seed=1)
    assert not constant
    assert "empty test: gradient and differences" in str(constant)
    allowed = check_gradient(
        lambda _: np.ones(2), lambda _, d: {"a": 0.0 * d}, p, seed=1, may_be_zero=("a",)
    )
    assert allowed
    assert "empty" in str(taylor_slope(lambda _: np.ones(2), lambda _, d: {"a": 0 * d}, p, seed=1))
    lazy = check_gradient(
        lambda p: p["a"], lambda _, d: {"a": 0.0 * d}, p, seed=1, may_be_zero=("a",)
    )
    assert not lazy, "a zero gradient is only excused where the differences are zero too"


def test_sparse_gradient_is_probed_where_it_lives() -> None:
    p = {"grid": draw_like((30, 30, 30), seed=4, stream=1)}
    start, probed = p["grid"].copy(), set()

    def pick(p: Arrays) -> float:
        moved = np.flatnonzero(p["grid"] != start)
        if moved.size == 1:
            probed.add(np.unravel_index(moved[0], start.shape))
        return float(np.sin(p["grid"][3, 4, 5]) + p["grid"][20, 1, 2] ** 2)

    def pick_backward(p: Arrays, d_out: float) -> Arrays:
        d_grid = np.zeros_like(p["grid"])
        d_grid[3, 4, 5] = d_out * np.cos(p["grid"][3, 4, 5])
        d_grid[20, 1, 2] = d_out * 2.0 * p["grid"][20, 1, 2]
        return {"grid": d_grid}

    report = check_gradient(pick, pick_backward, p, seed=5)
    assert report, str(report)
    assert {(3, 4, 5), (20, 1, 2)} <= probed
    assert len(probed) == 32


def test_named_outputs_and_parameters_stay_untouched() -> None:
    p = place()
    before = {name: array.copy() for name, array in p.items()}

    def two(p: Arrays) -> Arrays:
        p["a"] *= 2.0  # a rude function; it only sees copies
        return {"color": p["a"] * p["c"], "depth": p["a"].sum(axis=1)}

    def two_backward(p: Arrays, d: Arrays) -> Arrays:
        d_a = 2.0 * (d["color"] * p["c"] + d["depth"][:, None])
        return {"a": d_a, "b": np.zeros(3), "c": np.array((d["color"] * 2.0 * p["a"]).sum())}

    assert check_gradient(two, two_backward, p, seed=6, may_be_zero=("b",))
    for name, array in before.items():
        np.testing.assert_array_equal(p[name], array)


def test_taylor_slope() -> None:
    report = taylor_slope(value, backward, place(), seed=7)
    assert report, str(report)
    assert abs(report.slope - 2.0) < 0.1
    assert not report.linear
    assert len(report.slopes) >= 4
    for group in ("a", "b", "c"):
        wrong = taylor_slope(value, scaled(group, 1.01), place(), seed=7)
        assert not wrong, str(wrong)
    assert not taylor_slope(value, scaled("a", 1.0 + 1e-4), place(), seed=7)


def test_taylor_slope_of_a_linear_function() -> None:
    p = {"a": draw_like((50,), seed=8, stream=0)}
    matrix = draw_like((20, 50), seed=9, stream=0)
    report = taylor_slope(lambda p: matrix @ p["a"], lambda _, d: {"a": matrix.T @ d}, p, seed=10)
    assert report.linear
    assert report.passed
    assert "linear" in str(report)
    wrong = taylor_slope(
        lambda p: matrix @ p["a"], lambda _, d: {"a": (1 + 1e-8) * matrix.T @ d}, p, seed=10
    )
    assert not wrong
    assert not wrong.linear


def jvp(p: Arrays, v: Arrays) -> np.ndarray:
    d_a = np.cos(p["a"]) * np.exp(p["b"]) + 2.0 * p["c"] * p["a"]
    return d_a * v["a"] + np.sin(p["a"]) * np.exp(p["b"]) * v["b"] + p["a"] ** 2 * v["c"]


def test_dot_product() -> None:
    report = dot_product_error(jvp, backward, place(), seed=11)
    assert report, str(report)
    assert report.error < 1e-13
    for group in ("a", "b", "c"):
        assert not dot_product_error(jvp, scaled(group, 1.0 + 1e-9), place(), seed=11)
    zero = lambda p, _: {k: np.zeros_like(v) for k, v in p.items()}  # noqa: E731
    empty = dot_product_error(lambda *_: np.zeros((4, 3)), zero, place(), seed=11)
    assert not empty
    assert "empty" in str(empty)


def test_accumulation() -> None:
    p = place()
    d_out = draw_like((4, 3), seed=12, stream=0)

    def accumulate(p: Arrays, d_out: np.ndarray, d_p: Arrays) -> None:
        for name, gradient in backward(p, d_out).items():
            d_p[name] += gradient

    def overwrite(p: Arrays, d_out: np.ndarray, d_p: Arrays) -> None:
        for name, gradient in backward(p, d_out).items():
            d_p[name][...] = gradient

    assert check_accumulation(accumulate, p, d_out)
    assert not check_accumulation(overwrite, p, d_out)
    empty = check_accumulation(accumulate, p, 0.0 * d_out)
    assert not empty
    assert "empty" in str(empty)


def test_bad_input_is_refused() -> None:
    p = place()
    with pytest.raises(DtypeError, match="float64"):
        check_gradient(value, backward, {"a": np.ones(3, np.float32)}, seed=1)
    with pytest.raises(ShapeError, match="at least one group"):
        check_gradient(value, backward, {}, seed=1)
    with pytest.raises(RangeError, match="finite"):
        check_gradient(value, backward, {**p, "c": np.array(np.inf)}, seed=1)
    with pytest.raises(ShapeError, match="a gradient for each of"):
        check_gradient(value, lambda p, _: {"a": p["a"]}, p, seed=1)
    with pytest.raises(ShapeError, match="gradient of 'a'"):
        check_gradient(value, lambda p, d: {**backward(p, d), "a": np.ones(1)}, p, seed=1)
    with pytest.raises(DtypeError, match="outputs"):
        check_gradient(lambda p: p["a"].astype(np.float32), backward, p, seed=1)
