"""Rows that disappear: the map, the optimizer's moments, the rendering afterwards."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd.fields import ToyBlobs
from photograd.representation import CanvasBatch, Outputs, RenderOptions, dense_gradient
from photograd_course.optim import Adam

RATES = {"mean": 0.005, "log_radius": 0.01, "color": 0.01}


def grid_of_points(size: int) -> CanvasBatch:
    center = (np.arange(size) + 0.5) / size
    return CanvasBatch(np.stack(np.meshgrid(center, center), axis=-1).reshape(-1, 2))


def render(blobs: ToyBlobs, batch: CanvasBatch) -> tuple[Any, Any]:
    outputs, context = blobs.render(batch, seed=0, step=0, options=RenderOptions())
    return outputs.color, context


def descend(blobs: ToyBlobs, adam: Adam, truth: Any, batch: CanvasBatch) -> float:
    """One step on the mean squared error; returns the error before it."""
    color, context = render(blobs, batch)
    gradients = blobs.render_backward(context, Outputs(2 * (color - truth) / color.size))
    adam.step(blobs.params, gradients, RATES)
    return float(np.mean((color - truth) ** 2))


def test_one_blob_by_hand() -> None:
    blobs = ToyBlobs(np.array([[0.5, 0.5]]), np.log([0.2]), np.array([[1.0, 2.0, -1.0]]))
    color, context = render(blobs, CanvasBatch(np.array([[0.5, 0.5], [0.7, 0.5], [0.5, 0.1]])))
    w = np.exp([0, -0.5, -2.0])
    np.testing.assert_allclose(color, w[:, None] * [1, 2, -1], rtol=1e-14)
    d = blobs.render_backward(context, Outputs(np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, 1]])))
    # At the second point e = 1, p - m = (0.2, 0); at the third e = -1, p - m = (0, -0.4).
    np.testing.assert_allclose(d["mean"][1], [[w[1] * 0.2 / 0.04, w[2] * 0.4 / 0.04]], rtol=1e-13)
    np.testing.assert_allclose(d["log_radius"][1], [w[1] - 4 * w[2]], rtol=1e-13)
    np.testing.assert_allclose(d["color"][1], [[w[1], 0, w[2]]], rtol=1e-13)


def test_refine_removes_the_faint_ones_and_says_which() -> None:
    blobs = ToyBlobs.example(seed=1)
    before = {name: array.copy() for name, array in blobs.params.items()}
    brightness = np.abs(before["color"]).max(axis=1)
    stays = np.flatnonzero(brightness >= blobs.faint)
    assert 0 < len(stays) < len(brightness)
    row_map = blobs.refine(10, {})
    assert row_map is not None
    assert row_map.source.tolist() == stays.tolist()
    assert row_map.source_count == 9
    for name, array in blobs.params.items():
        np.testing.assert_array_equal(array, before[name][stays])
    assert blobs.pruned == 9 - len(stays)
    assert {spec.shape[0] for spec in blobs.param_groups().values()} == {len(stays)}
    assert blobs.refine(20, {}) is None


def test_the_brightest_blob_always_stays() -> None:
    blobs = ToyBlobs.example(seed=1)
    blobs.params["color"] *= 1e-6
    row_map = blobs.refine(0, {})
    assert row_map is not None
    assert len(row_map.source) == 1


def test_the_rendering_is_that_of_the_survivors() -> None:
    blobs, batch = ToyBlobs.example(seed=2), grid_of_points(12)
    before, context = render(blobs, batch)
    faint = np.abs(blobs.params["color"]).max(axis=1) < blobs.faint
    lost = np.abs(blobs.params["color"][faint]).sum(axis=0)
    earlier = blobs.render_backward(context, Outputs(np.ones_like(before)))
    blobs.refine(0, {})
    after, _ = render(blobs, batch)
    alone = ToyBlobs(*(blobs.params[name] for name in ("mean", "log_radius", "color")))
    assert np.array_equal(after, render(alone, batch)[0])
    # A weight is at most 1, so that the image changes by no more than the colors that are gone.
    assert 0 < np.abs(before - after).max() <= lost.max()
    # A rendering from before the pruning can still be differentiated: it keeps its parameters.
    later = blobs.render_backward(context, Outputs(np.ones_like(before)))
    for name in RATES:
        assert np.array_equal(earlier[name][1], later[name][1])
        assert len(later[name][1]) == 9


def test_adam_follows_the_map_entry_by_entry() -> None:
    blobs, batch, adam = ToyBlobs.example(seed=3), grid_of_points(8), Adam()
    truth = np.random.default_rng(3).uniform(0, 1, (64, 3))
    for _ in range(5):
        descend(blobs, adam, truth, batch)
    blobs.params["color"][[2, 6]] = 0.001  # these two must go
    before = adam.state()
    row_map = blobs.refine(5, {})
    assert row_map is not None
    kept = row_map.source.tolist()
    assert not {2, 6} & set(kept)
    assert len(kept) < 9
    adam.apply_row_map(row_map, list(RATES))
    after = adam.state()
    for name in RATES:
        assert after[f"step/{name}"] == before[f"step/{name}"] == 5
        for slot in ("mean", "mean_square"):
            old, new = before[f"{slot}/{name}"], after[f"{slot}/{name}"]
            assert len(new) == len(kept)
            for row, source in enumerate(kept):
                assert np.array_equal(new[row], old[source])
                assert np.abs(new[row]).max() > 0
    # The next step is the one that Adam takes with moments of the survivors alone.
    twin, twin_adam = ToyBlobs(**{k: v.copy() for k, v in blobs.params.items()}), Adam()
    twin_adam.load_state(after)
    descend(blobs, adam, truth, batch)
    descend(twin, twin_adam, truth, batch)
    assert all(np.array_equal(blobs.params[name], twin.params[name]) for name in RATES)


def test_forgetting_the_map_is_refused_by_the_optimizer() -> None:
    blobs, batch, adam = ToyBlobs.example(seed=4), grid_of_points(8), Adam()
    truth = np.zeros((64, 3))
    descend(blobs, adam, truth, batch)
    blobs.refine(1, {})
    with pytest.raises(ShapeError, match="call apply_row_map or resample"):
        descend(blobs, adam, truth, batch)


def test_a_picture_is_recovered_while_blobs_are_pruned() -> None:
    # T11: four blobs make the truth; nine start elsewhere, some of them too faint to last. Over
    # twenty pairs of seeds the error fell to 1/1270 (median) and to 1/114 at worst: 1/50 is asked.
    batch, adam = grid_of_points(16), Adam()
    truth_blobs = ToyBlobs.example(seed=5)
    truth_blobs.params = {name: array[[0, 2, 3, 5]] for name, array in truth_blobs.params.items()}
    truth, _ = render(truth_blobs, batch)
    blobs = ToyBlobs.example(seed=6)
    errors = []
    for step in range(300):
        if step == 1:
            row_map = blobs.refine(step, {})
            if row_map is not None:
                adam.apply_row_map(row_map, list(RATES))
        errors.append(descend(blobs, adam, truth, batch))
    assert len(blobs.params["mean"]) < 9
    assert errors[-1] < errors[0] / 50


def test_the_cut_off_drops_far_rows_and_little_of_the_image() -> None:
    mean = np.array([[0.1, 0.1], [0.9, 0.9], [0.2, 0.1]])
    arrays = (mean, np.log([0.05, 0.05, 0.05]), np.ones((3, 3)))
    near = CanvasBatch(np.random.default_rng(1).uniform(0.0, 0.3, (40, 2)))
    full, context = render(ToyBlobs(*arrays), near)
    cut, cut_context = render(ToyBlobs(*arrays, reach=3.0), near)
    # Per blob at most exp(-9 / 2) of its color is dropped.
    assert 0 < np.abs(full - cut).max() <= 3 * np.exp(-4.5)
    d = Outputs(np.ones_like(full))
    all_rows = ToyBlobs(*arrays).render_backward(context, d)
    few_rows = ToyBlobs(*arrays).render_backward(cut_context, d)
    for name, array in zip(("mean", "log_radius", "color"), arrays, strict=True):
        assert all_rows[name][0].tolist() == [0, 1, 2]
        assert few_rows[name][0].tolist() == [0, 2]
        dense = dense_gradient(few_rows[name], array)
        assert not dense[1].any()
        assert np.array_equal(dense[[0, 2]], few_rows[name][1])


def test_rows_without_a_gradient_keep_every_bit() -> None:
    mean = np.array([[0.1, 0.1], [0.9, 0.9]])
    blobs = ToyBlobs(mean, np.log([0.05, 0.05]), np.ones((2, 3)), reach=3.0)
    before = {name: array.copy() for name, array in blobs.params.items()}
    descend(
        blobs,
        Adam(),
        np.zeros((40, 3)),
        CanvasBatch(np.random.default_rng(1).uniform(0.0, 0.3, (40, 2))),
    )
    for name, array in blobs.params.items():
        assert np.array_equal(array[1], before[name][1])
        assert not np.array_equal(array[0], before[name][0])


ONE = {"mean": np.zeros((2, 2)), "log_radius": np.zeros(2), "color": np.zeros((2, 3))}


@pytest.mark.parametrize(
    ("change", "error", "words"),
    [
        ({"log_radius": np.zeros(3)}, ShapeError, r"log_radius: expected shape \(N,\) with N = 2"),
        (
            {"mean": np.zeros((2, 3))},
            ShapeError,
            r"mean: expected shape \(N, 2\) with N >= 1, got \(2, 3\)",
        ),
        (
            {"color": np.zeros((2, 3), np.float32)},
            DtypeError,
            "color: expected float64 as mean, got float32",
        ),
        ({name: array[:0] for name, array in ONE.items()}, ShapeError, "with N >= 1"),
        ({"reach": 0.0}, RangeError, "reach: expected a finite number above 0, got 0.0"),
    ],
)
def test_bad_blobs_are_refused(change: dict[str, Any], error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        ToyBlobs(**(ONE | change))
