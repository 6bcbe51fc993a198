"""Optimizers: golden traces, strides, sparse rows, threads, resumption, and refusals."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np
import pytest
from photograd_course.errors import DtypeError, RangeError, ShapeError
from photograd_course.gradcheck import draw_like
from photograd_course.optim import SGD, Adam, Momentum, Optimizer, RMSProp, RowMap, merge_rows

METHODS: dict[str, Callable[..., Optimizer]] = {
    "sgd": SGD,
    "momentum": Momentum,
    "rmsprop": RMSProp,
    "adam": Adam,
}
SLOPES = [0.5, -1.25, 2.0, 0.0, 1e-3, -0.75, 3.0, 3.0, -2.5, 0.125]


def trace(method: str, rate: float) -> Iterator[float]:
    """Ten steps from 1.0 in plain Python floats, by the textbook formula of each method."""
    p, m, v = 1.0, 0.0, 0.0
    for t, g in enumerate(SLOPES, start=1):
        if method == "sgd":
            p -= rate * g
        elif method == "momentum":
            m = 0.9 * m + g
            p -= rate * m
        elif method == "rmsprop":
            v = 0.99 * v + 0.01 * g**2
            p -= rate * g / (math.sqrt(v) + 1e-8)
        else:
            m = 0.9 * m + 0.1 * g
            v = 0.999 * v + 0.001 * g**2
            p -= rate * (m / (1 - 0.9**t)) / (math.sqrt(v / (1 - 0.999**t)) + 1e-8)
        yield p


@pytest.mark.parametrize("method", METHODS)
def test_golden_trace_of_ten_steps(method: str) -> None:
    rate = 0.05
    params = {"x": np.array([1.0, 1.0])}
    optimizer = METHODS[method]()
    for expected, g in zip(trace(method, rate), SLOPES, strict=True):
        optimizer.step(params, {"x": np.array([g, g])}, rate)
        # Positions are of size 1 and may pass near 0, so the bound is absolute: ten steps of about
        # ten roundings of 1.1e-16 each. Observed: at most 7e-16.
        np.testing.assert_allclose(params["x"], expected, rtol=0, atol=1e-14)
    assert params["x"][0] != 1.0


def test_published_first_steps() -> None:
    # With any gradient Adam's first step has the length of the rate [Kingma2015], section 2.1.
    for g in (1e-6, 3.0, -40.0):
        params = {"x": np.array([2.0])}
        Adam(epsilon=1e-30).step(params, {"x": np.array([g])}, 0.25)
        assert params["x"][0] == pytest.approx(2.0 - math.copysign(0.25, g), rel=1e-14)
    # Epsilon outside the root and after the correction: at g = epsilon the step is halved.
    params = {"x": np.array([0.0])}
    Adam(epsilon=1e-3).step(params, {"x": np.array([1e-3])}, 1.0)
    assert params["x"][0] == pytest.approx(-0.5, rel=1e-12)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_strided_views_get_the_same_bits(method: str, dtype: type) -> None:
    shape = (700, 60)  # more than one piece
    start = draw_like(shape, seed=1, stream=0).astype(dtype)
    wide = np.zeros((700, 150), dtype=dtype)
    views = {
        "columns": wide[:, 7:127:2],
        "transposed": np.zeros((60, 700), dtype=dtype).T,
        "reversed": np.zeros(shape, dtype=dtype)[::-1],
    }
    plain = {"x": start.copy()}
    for view in views.values():
        view[...] = start
    steps = [METHODS[method](), METHODS[method]()]
    for turn in range(3):
        g = draw_like(shape, seed=2, stream=turn).astype(dtype)
        steps[0].step(plain, {"x": g}, 0.1)
        steps[1].step(views, dict.fromkeys(views, g), 0.1)
    assert plain["x"].dtype == dtype
    assert (plain["x"] != start).all()
    for view in views.values():
        np.testing.assert_array_equal(view, plain["x"])
    assert not wide[:, :7].any()
    assert not wide[:, 8:127:2].any()


def test_huge_rows_and_single_numbers() -> None:
    params = {"tall": np.zeros((2, 3, 40_000)).transpose(0, 2, 1), "one": np.array(1.0)}
    gradients = {"tall": np.ones((2, 40_000, 3)), "one": np.array(2.0)}
    wide_rows = {"w": np.zeros((3, 70_000))}
    Adam().step(params, gradients, 0.5)
    Adam().step(wide_rows, {"w": (np.array([1]), np.ones((1, 70_000)))}, 0.5)
    np.testing.assert_allclose(params["tall"], -0.5, rtol=1e-7)
    np.testing.assert_allclose(params["one"], 0.5, rtol=1e-7)
    np.testing.assert_allclose(wide_rows["w"][1], -0.5, rtol=1e-7)
    assert not wide_rows["w"][[0, 2]].any()


@pytest.mark.parametrize("method", METHODS)
def test_same_bits_on_any_number_of_threads(method: str) -> None:
    size = 400_003  # above the threading threshold, and no multiple of a piece
    start = draw_like((size,), seed=3, stream=0).astype(np.float32)
    results = []
    for threads in (1, 2, 3):
        params, optimizer = {"x": start.copy()}, METHODS[method](threads=threads)
        for turn in range(2):
            g = draw_like((size,), seed=4, stream=turn).astype(np.float32)
            optimizer.step(params, {"x": g}, 0.01)
        results.append({"x": params["x"], **optimizer.state()})
    assert (results[0]["x"] != start).any()
    for other in results[1:]:
        for key, array in results[0].items():
            np.testing.assert_array_equal(other[key], array)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("size", [50, 120_000])
def test_sparse_rows(method: str, size: int) -> None:
    start = draw_like((size, 3), seed=5, stream=0)
    dense, sparse = {"x": start.copy()}, {"x": start.copy()}
    two = METHODS[method](), METHODS[method]()
    first = draw_like((size, 3), seed=6, stream=0)
    for params, optimizer in zip((dense, sparse), two, strict=True):
        optimizer.step(params, {"x": first}, 0.1)  # all rows now have moments
    before, state = sparse["x"].copy(), two[1].state()
    rows = np.flatnonzero(draw_like((size,), seed=7, stream=0) > -0.5).astype(np.int64)
    second = draw_like((size, 3), seed=6, stream=1)
    two[0].step(dense, {"x": second}, 0.1)
    two[1].step(sparse, {"x": (rows, second[rows])}, 0.1)
    others = np.setdiff1d(np.arange(size), rows)
    assert 0 < len(others) < size
    np.testing.assert_array_equal(sparse["x"][rows], dense["x"][rows])
    np.testing.assert_array_equal(sparse["x"][others], before[others])
    assert (sparse["x"][rows] != before[rows]).any()
    for slot in two[1].slots:
        after = two[1].state()[f"{slot}/x"]
        np.testing.assert_array_equal(after[others], state[f"{slot}/x"][others])
        np.testing.assert_array_equal(after[rows], two[0].state()[f"{slot}/x"][rows])


def test_rates_by_group_and_frozen_groups() -> None:
    params = {"a": np.zeros(2), "b": np.zeros(2), "frozen": np.zeros(2)}
    ones = np.ones(2)
    SGD().step(params, {"a": ones, "b": ones}, {"a": 1.0, "b": 0.5})
    np.testing.assert_array_equal(params["a"], -ones)
    np.testing.assert_array_equal(params["b"], -0.5 * ones)
    np.testing.assert_array_equal(params["frozen"], 0.0 * ones)


@pytest.mark.parametrize("method", METHODS)
def test_resumed_run_repeats_every_bit(method: str) -> None:
    def go(optimizer: Optimizer, params: dict[str, np.ndarray], turns: range) -> None:
        for turn in turns:
            g = draw_like((40, 3), seed=8, stream=turn).astype(np.float32)
            optimizer.step(params, {"x": g}, 0.03)

    straight = {"x": np.zeros((40, 3), np.float32)}
    first = METHODS[method]()
    go(first, straight, range(3))
    resumed = {"x": straight["x"].copy()}
    saved = first.state()
    kept = {key: array.copy() for key, array in saved.items()}
    second = METHODS[method]()
    second.load_state(saved)
    go(first, straight, range(3, 7))
    go(second, resumed, range(3, 7))
    np.testing.assert_array_equal(straight["x"], resumed["x"])
    assert int(first.state()["step/x"]) == 7
    for key, array in kept.items():
        np.testing.assert_array_equal(saved[key], array, "a saved state follows no later step")


def test_row_map_moves_the_moments() -> None:
    optimizer, params = Adam(), {"x": np.zeros((4, 2)), "background": np.zeros(3)}
    gradients = {"x": draw_like((4, 2), seed=9, stream=0), "background": np.ones(3)}
    optimizer.step(params, gradients, 0.1)
    before = optimizer.state()
    row_map = RowMap(np.array([3, 0, 0, -1, 2]), source_count=4)
    optimizer.apply_row_map(row_map, ["x"])
    after = optimizer.state()
    for slot in ("mean", "mean_square"):
        old, new = before[f"{slot}/x"], after[f"{slot}/x"]
        np.testing.assert_array_equal(new, [old[3], old[0], old[0], [0.0, 0.0], old[2]])
        assert old.all()
        np.testing.assert_array_equal(after[f"{slot}/background"], before[f"{slot}/background"])
    with pytest.raises(ShapeError, match="apply_row_map"):
        optimizer.step(params, gradients, 0.1)
    grown = {"x": row_map.apply(params["x"]), "background": params["background"]}
    optimizer.step(grown, {"x": np.ones((5, 2))}, 0.1)
    assert (grown["x"] != row_map.apply(params["x"])).all()
    with pytest.raises(ShapeError, match="4 rows"):
        optimizer.apply_row_map(row_map)


def test_row_map_checks_itself() -> None:
    with pytest.raises(DtypeError, match="int64"):
        RowMap(np.array([0.0]))
    with pytest.raises(ShapeError, match="shape"):
        RowMap(np.zeros((2, 2), np.int64))
    with pytest.raises(RangeError, match="-1 or a row"):
        RowMap(np.array([-2]))
    with pytest.raises(RangeError, match="rows below 3"):
        RowMap(np.array([3]), source_count=3)
    with pytest.raises(RangeError, match="rows below 2"):
        RowMap(np.array([2])).apply(np.zeros((2, 3)))


def test_resample_moments() -> None:
    optimizer, params = Adam(), {"grid": np.zeros((2, 2, 2))}
    optimizer.step(params, {"grid": draw_like((2, 2, 2), seed=10, stream=0)}, 0.1)
    mean = optimizer.state()["mean/grid"]
    optimizer.resample("grid", lambda a: a.repeat(2, 0).repeat(2, 1).repeat(2, 2))
    np.testing.assert_array_equal(optimizer.state()["mean/grid"][::2, ::2, ::2], mean)
    fine = {"grid": np.zeros((4, 4, 4))}
    optimizer.step(fine, {"grid": np.ones((4, 4, 4))}, 0.1)
    assert (fine["grid"] != 0.0).all()
    optimizer.resample("unknown", lambda a: a)
    with pytest.raises(RangeError, match="mean_square"):
        optimizer.resample("grid", lambda a: -a - 1.0)
    with pytest.raises(DtypeError, match="mean"):
        optimizer.resample("grid", lambda a: a.astype(np.float32))


def test_merge_rows() -> None:
    rows, values = merge_rows(np.array([4, 1, 4]), np.array([[1.0], [2.0], [3.0]]))
    np.testing.assert_array_equal(rows, [1, 4])
    np.testing.assert_array_equal(values, [[2.0], [4.0]])


@pytest.mark.parametrize(
    ("gradient", "error", "text"),
    [
        (np.ones((4, 1)), ShapeError, "expected shape"),
        (np.ones((4, 2), np.float32), DtypeError, "float64"),
        (np.full((4, 2), np.nan), RangeError, "8 of 8"),
        (np.array([[np.inf, 0.0]] * 4), RangeError, "4 of 8"),
        ((np.array([1, 1]), np.ones((2, 2))), RangeError, "merge_rows"),
        ((np.array([4]), np.ones((1, 2))), RangeError, "0 .. 3"),
        ((np.array([-1]), np.ones((1, 2))), RangeError, "0 .. 3"),
        ((np.array([0.0]), np.ones((1, 2))), DtypeError, "int64"),
        ((np.array([0]), np.ones((2, 2))), ShapeError, "values"),
        ([1.0, 2.0], DtypeError, "a NumPy array"),
    ],
)
def test_bad_gradients_change_nothing(gradient: object, error: type, text: str) -> None:
    optimizer, params = Adam(), {"ok": np.zeros(1), "x": np.zeros((4, 2))}
    with pytest.raises(error, match=text):
        optimizer.step(params, {"ok": np.ones(1), "x": gradient}, 0.1)  # type: ignore[dict-item]
    assert not params["ok"].any()
    assert not params["x"].any()
    assert optimizer.state() == {}


def test_bad_arguments_are_refused() -> None:
    params, gradients = {"x": np.zeros(2)}, {"x": np.ones(2)}
    with pytest.raises(RangeError, match="learning_rates"):
        SGD().step(params, gradients, -1.0)
    with pytest.raises(RangeError, match="a rate for 'x'"):
        SGD().step(params, gradients, {"y": 1.0})
    with pytest.raises(RangeError, match="gradients"):
        SGD().step(params, {"y": np.ones(2)}, 1.0)
    read_only = np.zeros(2)
    read_only.flags.writeable = False
    with pytest.raises(RangeError, match="writeable"):
        SGD().step({"x": read_only}, gradients, 1.0)
    with pytest.raises(RangeError, match="epsilon"):
        Adam(epsilon=0.0)
    with pytest.raises(RangeError, match="beta_2"):
        Adam(beta_2=1.0)
    adam = Adam()
    adam.step(params, gradients, 0.1)
    with pytest.raises(RangeError, match="saved by Momentum"):
        Momentum().load_state(adam.state())
