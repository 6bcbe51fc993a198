"""Sparse grids against dense arrays: values, topology, frames, sampling, refusals."""

from __future__ import annotations

import numpy as np
import pytest
from photograd.errors import DtypeError, Error, RangeError, ShapeError
from photograd.grids.sparse import SparseGrid
from photograd.types import Array

from grid.solids import ORIGIN, WORLD_FROM_INDEX, dilated, spotted, spotted_grid, trilinear

BOX = np.array([ORIGIN, np.add(ORIGIN, (20, 17, 30))])


@pytest.mark.parametrize("channels", [1, 3])
def test_dense_and_back_is_bit_exact(channels: int) -> None:
    grid = spotted_grid(channels)
    values, origin = grid.to_dense(BOX)
    assert np.array_equal(values, spotted(channels))
    assert tuple(origin) == ORIGIN


def test_statistics_count_what_is_active() -> None:
    values = spotted()[..., 0]
    at = np.argwhere(values != 0) + ORIGIN
    s = spotted_grid().statistics
    assert s.active_voxels == len(at) > 0
    assert s.active_tiles == 0
    assert s.leaves == len(np.unique(at >> 3, axis=0))
    assert np.array_equal(s.box, [at.min(axis=0), at.max(axis=0) + 1])
    assert (s.least, s.most) == (values.min(), values.max())
    # A leaf stores 512 floats at least; nodes above it add 32 KiB and 256 KiB each.
    assert s.memory > 2048 * s.leaves


def test_a_tolerance_and_a_background_decide_what_is_active() -> None:
    values = np.full((4, 4, 4, 3), (0.5, 1, 2), np.float32)
    values[1, 2, 3, 1] += 0.25
    values[0, 0, 0, 2] += 0.125
    grid = SparseGrid.from_dense(values, background=(0.5, 1, 2), tolerance=0.125)
    assert grid.statistics.active_voxels == 1
    found, active = grid.values_at([[1, 2, 3], [0, 0, 0], [-99, 5, 5]])
    assert active.tolist() == [True, False, False]
    assert found.tolist() == [[0.5, 1.25, 2], [0.5, 1, 2], [0.5, 1, 2]]


def test_world_and_index_are_inverse_and_exact_at_a_corner() -> None:
    grid = spotted_grid()
    points = np.random.default_rng(1).uniform(-50, 800, (200, 3))
    assert np.array_equal(grid.world_from_index, WORLD_FROM_INDEX)
    assert grid.to_world(np.array([[1.0, 0, 0]])).tolist() == [[1.5, 2.0, 3.0]]
    assert grid.to_world(np.array([[0, 1.0, 0]])).tolist() == [[1.1, 2.25, 3.05]]
    # Coordinates of up to 800, condition number below 5: 1e-12 is a few roundings.
    np.testing.assert_allclose(grid.to_index(grid.to_world(points)), points, atol=1e-11)


def test_an_affine_field_is_sampled_exactly() -> None:
    """No half-voxel shift: the value of voxel i sits at index i."""
    i, j, k = np.meshgrid(*(np.arange(n) for n in (9, 10, 11)), indexing="ij")
    values = (3 + 2 * i - 0.5 * j + 0.25 * k).astype(np.float32)
    grid = SparseGrid.from_dense(values, world_from_index=WORLD_FROM_INDEX)
    at = np.random.default_rng(2).uniform(0, (8, 9, 10), (10_000, 3))
    exact = 3 + at @ [2, -0.5, 0.25]
    # Values up to 22 in float32: one rounding is 1e-6, measured 4e-6.
    np.testing.assert_allclose(grid.sample(grid.to_world(at))[:, 0], exact, atol=1e-5)


@pytest.mark.parametrize("channels", [1, 3])
def test_samples_agree_with_another_trilinear_lookup(channels: int) -> None:
    grid = spotted_grid(channels)
    at = np.random.default_rng(3).uniform(BOX[0] - 2, BOX[1] + 1, (5000, 3))
    oracle = trilinear(spotted(channels), at - ORIGIN)
    assert np.abs(oracle).max() > 1
    # Float32 against float64 weights, values up to 2, indices up to 730: measured 5e-7.
    np.testing.assert_allclose(grid.sample(grid.to_world(at)), oracle, atol=2e-6)


def test_activation_adds_to_the_topology() -> None:
    grid = spotted_grid()
    before = grid.statistics.active_voxels
    at = np.array([[1000, -1000, 5], [1000, -1000, 6]])
    grid.activate(at, np.array([[7], [0]], np.float32))
    values, active = grid.values_at(at)
    assert values[:, 0].tolist() == [7, 0]
    assert active.all(), "a voxel may be active and hold the background's value"
    assert grid.statistics.active_voxels == before + 2


@pytest.mark.parametrize("steps", [1, 3])
def test_dilation_is_that_of_a_cube(steps: int) -> None:
    grid = spotted_grid(density=0.004)
    grid.dilate(steps)
    inside = np.pad(spotted(density=0.004)[..., 0] != 0, steps)
    expected = dilated(inside, steps)
    lowest = np.subtract(ORIGIN, steps)
    _, active = grid.values_at(np.argwhere(np.ones_like(inside)) + lowest)
    assert np.array_equal(active.reshape(inside.shape), expected)
    assert grid.statistics.active_voxels == expected.sum() > inside.sum() > 0
    assert np.array_equal(grid.to_dense(BOX)[0], spotted(density=0.004)), "values stay"


def test_a_dilation_beyond_time_or_memory_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    grid = SparseGrid.from_dense(np.ones((1, 1, 1), np.float32))
    for steps in (0, 201, 1000):
        with pytest.raises(RangeError, match=f"steps: expected .*, got {steps}"):
            grid.dilate(steps)
    monkeypatch.setattr("photograd._memory.available_memory", lambda: 40_000_000)
    with pytest.raises(RangeError, match=r"steps: expected room for up to 64,481,201 voxels"):
        grid.dilate(200)
    assert grid.statistics.active_voxels == 1
    grid.dilate(90)
    assert grid.statistics.active_voxels == 181**3
    assert 4 * 181**3 < grid.statistics.memory < 40_000_000


def test_pruning_drops_what_is_small_and_frees_its_nodes() -> None:
    values = spotted()
    values[8:] *= 1e-4
    grid = SparseGrid.from_dense(values, origin=(0, 0, 0))
    before = grid.statistics
    grid.prune(1e-3)
    kept = np.where(np.abs(values) > 1e-3, values, 0)
    assert np.array_equal(grid.to_dense(np.array([(0, 0, 0), (20, 17, 30)]))[0], kept)
    assert grid.statistics.active_voxels == np.count_nonzero(kept) > 0
    assert grid.statistics.leaves < before.leaves


def test_a_copy_shares_nothing() -> None:
    grid = spotted_grid()
    other = grid.copy()
    other.prune(100)
    assert other.statistics.active_voxels == 0
    assert np.array_equal(grid.to_dense(BOX)[0], spotted())
    assert grid.statistics.active_voxels > 0


def test_metadata_keep_their_types() -> None:
    grid = spotted_grid()
    given: dict[str, bool | int | float | str] = {"b": True, "i": 3, "x": 0.25, "s": "fog"}
    for key, value in given.items():
        grid.set_metadata(key, value)
    grid.set_metadata("s", 2.5)
    given["s"] = 2.5
    assert {key: grid.metadata[key] for key in given} == given
    assert {key: type(grid.metadata[key]) for key in given} == {
        k: type(v) for k, v in given.items()
    }
    with pytest.raises(RangeError, match="a key of yours, got 'file_mem_bytes'"):
        grid.set_metadata("file_mem_bytes", 1)


def bad_nan() -> Array:
    values = spotted()
    values[1, 2, 3] = np.nan
    return values


@pytest.mark.parametrize(
    ("values", "options", "error", "text"),
    [
        (np.zeros((3, 3), np.float32), {}, ShapeError, r"got \(3, 3\)"),
        (np.zeros((3, 3, 3, 2), np.float32), {}, ShapeError, r"got \(3, 3, 3, 2\)"),
        (np.zeros((3, 3, 3), bool), {}, DtypeError, "expected numbers, got an array of bool"),
        (bad_nan(), {}, RangeError, r"values: expected finite numbers, got nan at \["),
        (spotted(), {"background": np.nan}, Error, "background: expected a finite"),
        (spotted(), {"tolerance": -1.0}, RangeError, "at least 0, got -1.0"),
        (spotted(), {"tolerance": np.nan}, RangeError, "at least 0, got nan"),
        (spotted(), {"origin": (2**31, 0, 0)}, RangeError, r"numbers in \[-2\^30, 2\^30\]"),
        (spotted(), {"origin": (0.5, 0, 0)}, DtypeError, "integers, got float64"),
        (spotted(), {"world_from_index": np.zeros((4, 4))}, RangeError, "affine"),
        (spotted(), {"world_from_index": np.diag([1.0, 1, 0, 1])}, RangeError, "singular"),
        (spotted(), {"world_from_index": np.diag([1, 1, np.nan, 1])}, RangeError, "not finite"),
        (spotted(), {"world_from_index": np.eye(3)}, ShapeError, r"shape \(4, 4\)"),
    ],
)
def test_bad_input_is_refused(
    values: Array, options: dict[str, object], error: type[Error], text: str
) -> None:
    with pytest.raises(error, match=text):
        SparseGrid.from_dense(values, **options)  # type: ignore[arg-type]


def test_a_dense_array_beyond_memory_is_refused_before_it_is_made() -> None:
    grid = spotted_grid()
    grid.activate(np.array([[2**29, 2**29, 2**29]]), np.ones((1, 1), np.float32))
    with pytest.raises(RangeError, match=r"\(\d[\d,]*\.\d [GT]iB\)"):
        grid.to_dense()
    with pytest.raises(RangeError, match=r"40,800 bytes.*got 40,799 bytes"):
        grid.to_dense(BOX, memory_limit=40_799)


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e12])
def test_points_far_away_are_refused(value: float) -> None:
    with pytest.raises(RangeError, match=r"SparseGrid\.sample: points: expected finite"):
        spotted_grid().sample(np.full((2, 3), value))
