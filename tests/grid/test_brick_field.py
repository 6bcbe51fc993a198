"""Brick fields: the same as a dense grid on the active set, values and gradients, bit for bit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd import _core
from photograd.errors import RangeError, ShapeError
from photograd.grids.bricks import BrickField
from photograd.grids.sparse import SparseGrid
from photograd.types import Array

from grid.solids import ORIGIN, spotted, spotted_grid, trilinear
from support.bits import same_bits

SHAPE = (20, 17, 30)


def points(count: int, *, seed: int = 5) -> Array:
    """Index-space points in and around the spots, none on a cell's face."""
    at = np.random.default_rng(seed).uniform(-2.5, np.add(SHAPE, 1.5), (count, 3))
    base = np.floor(at)
    return np.asarray(base + np.clip(at - base, 0.02, 0.98) + ORIGIN)


def field(channels: int, *, background: float = 0.0) -> BrickField:
    """In float64, with a background of its own."""
    bricks = BrickField(spotted_grid(channels))
    bricks.values = bricks.values.astype(np.float64)
    bricks.background = np.full(channels, background)
    return bricks


@pytest.mark.parametrize("channels", [1, 3])
def test_rows_are_the_active_voxels_and_go_back_bit_for_bit(channels: int) -> None:
    grid = spotted_grid(channels)
    bricks = BrickField(grid)
    dense = spotted(channels)
    assert bricks.topology.bricks == grid.statistics.leaves
    assert len(bricks.values) == bricks.topology.voxels == grid.statistics.active_voxels > 0
    assert np.array_equal(bricks.values, dense[tuple((bricks.voxels - ORIGIN).T)])
    box = np.array([ORIGIN, np.add(ORIGIN, SHAPE)])
    assert np.array_equal(bricks.to_sparse().to_dense(box)[0], dense)
    bricks.values = bricks.values * np.float32(1 / 3)
    assert np.array_equal(bricks.to_sparse().to_dense(box)[0], dense * np.float32(1 / 3))
    assert np.array_equal(grid.to_dense(box)[0], dense), "the grid it came from stays"


@pytest.mark.parametrize("channels", [1, 3])
def test_samples_are_those_of_the_dense_grid(channels: int) -> None:
    at = points(20_000)
    oracle = trilinear(spotted(channels), at - ORIGIN)
    bricks = field(channels)
    assert np.abs(oracle).max() > 1
    # The fractions of at and of at - ORIGIN differ by roundings of 730: 1e-13 each.
    np.testing.assert_allclose(bricks.sample(at), oracle, atol=2e-12)
    single = BrickField(spotted_grid(channels))
    reference = single.grid.sample(single.grid.to_world(at.astype(np.float32).astype(np.float64)))
    # float32 fractions at index 730: 730 * 6e-8 = 4e-5 in place, times slopes of up to 4.
    np.testing.assert_allclose(single.sample(at.astype(np.float32)), reference, atol=2e-4)


@pytest.mark.parametrize("channels", [1, 3])
def test_gradients_are_those_of_the_dense_grid_on_the_active_set(channels: int) -> None:
    at = points(20_000)
    d_out = np.random.default_rng(6).normal(size=(len(at), channels))
    bricks = field(channels, background=0.25)
    got = bricks.sample_backward(at, d_out)
    padded = np.zeros((*np.add(SHAPE, 8), channels))
    base = np.floor(at).astype(int)
    for corner in np.ndindex(2, 2, 2):
        weight = np.where(corner, at - base, 1 - (at - base)).prod(axis=1)
        np.add.at(padded, tuple((base + corner - ORIGIN + 4).T), weight[:, None] * d_out)
    on = tuple((bricks.voxels - ORIGIN + 4).T)
    assert np.abs(got.values).max() > 1
    # Sums of a few hundred terms in another order: measured 5e-15.
    np.testing.assert_allclose(got.values, padded[on], atol=1e-12)
    outside = padded.copy()
    outside[on] = 0
    lost = outside.sum(axis=(0, 1, 2))
    assert np.abs(lost).min() > 1
    np.testing.assert_allclose(got.background, lost, atol=1e-10)
    np.testing.assert_allclose(
        got.values.sum(axis=0) + got.background, d_out.sum(axis=0), atol=1e-10
    )


def test_the_adjoint_is_the_transpose() -> None:
    """<J v, w> = <v, J^T w>: the samples are linear in values and background."""
    at, bricks = points(3000), field(3)
    random = np.random.default_rng(7)
    bricks.values = random.normal(size=bricks.values.shape)
    bricks.background = random.normal(size=3)
    w = random.normal(size=(len(at), 3))
    left = np.vdot(bricks.sample(at), w)
    got = bricks.sample_backward(at, w)
    right = np.vdot(bricks.values, got.values) + np.vdot(bricks.background, got.background)
    assert abs(left) > 1
    assert right == pytest.approx(left, rel=1e-12)


def test_every_gradient_is_a_difference() -> None:
    at = points(200)
    bricks = field(3, background=0.5)
    w = np.random.default_rng(8).normal(size=(len(at), 3))
    values, background = bricks.values, bricks.background
    got = bricks.sample_backward(at, w)

    def loss(v: Array, b: Array, p: Array) -> float:
        bricks.values, bricks.background = v, b
        result = float((bricks.sample(p) ** 2 * w).sum()) / 2
        bricks.values, bricks.background = values, background
        return result

    got = bricks.sample_backward(at, bricks.sample(at) * w)
    assert min(np.abs(g).max() for g in got) > 0.1
    random = np.random.default_rng(9)
    for k, array in enumerate((values, background, at)):
        direction = random.normal(size=array.shape)
        inputs = [values, background, at]
        slopes = []
        for h in (1e-3, 1e-4):
            ends = []
            for sign in (1, -1):
                inputs[k] = array + sign * h * direction * 1e-2
                ends.append(loss(*inputs))
            slopes.append((ends[0] - ends[1]) / (2e-2 * h))
        # Central differences of a piecewise polynomial, roundings of 730 / 1e-6.
        assert slopes[1] == pytest.approx(np.vdot(got[k], direction), rel=1e-5)


def test_backward_adds() -> None:
    at, bricks = points(500), field(1)
    w = np.ones((len(at), 1))
    once = bricks.sample_backward(at, w)
    sums = [np.zeros_like(g) for g in once]
    for _ in range(2):
        _core.sample_bricks_backward(
            bricks.topology, bricks.values, bricks.background, at, w, *sums
        )
    for total, single in zip(sums, once, strict=True):
        np.testing.assert_allclose(total, 2 * single, rtol=1e-12, atol=1e-12)


@same_bits("brick field")
def samples_and_gradients() -> list[Any]:
    at = points(60_000).astype(np.float32)
    bricks = BrickField(spotted_grid(3))
    w = np.random.default_rng(10).normal(size=(len(at), 3)).astype(np.float32)
    return [bricks.sample(at), *bricks.sample_backward(at, w)]


def test_rows_are_summed_in_the_order_of_the_points() -> None:
    """Bit for bit the plain loop, whatever the bricks."""
    at = points(3000).astype(np.float32)
    bricks = BrickField(spotted_grid(1))
    w = np.random.default_rng(11).normal(size=(len(at), 1)).astype(np.float32)
    rows = {tuple(v): n for n, v in enumerate(bricks.voxels.tolist())}
    plain = np.zeros_like(bricks.values)
    base = np.floor(at)
    fraction = (at - base).astype(np.float32)
    for p in range(len(at)):
        ends = np.stack([np.float32(1) - fraction[p], fraction[p]])
        for x, y, z in np.ndindex(2, 2, 2):
            row = rows.get(tuple(np.add(base[p].astype(int), (x, y, z)).tolist()))
            if row is not None:
                plain[row] += (ends[x, 0] * ends[y, 1]) * ends[z, 2] * w[p]
    assert np.abs(plain).max() > 0.5
    assert np.array_equal(bricks.sample_backward(at, w).values, plain)


def test_negative_indices_and_tiles() -> None:
    grid = SparseGrid.from_dense(np.ones((24, 24, 24), np.float32), origin=(-16, -8, 0))
    bricks = BrickField(grid)
    at = np.array([[-16, -8, 0], [-16.5, -7.5, 0.5], [-1.25, 0.5, 7.5], [7.5, 16, 24]], np.float32)
    assert bricks.sample(at)[:, 0].tolist() == [1, 0.5, 1, 0]


def test_bad_input_is_refused() -> None:
    bricks = BrickField(spotted_grid(1))
    with pytest.raises(ShapeError, match=r"shape \(P, 3\)"):
        bricks.sample(np.zeros(3, np.float32))
    with pytest.raises(RangeError, match="points: expected finite numbers in"):
        bricks.sample(np.full((1, 3), np.nan, np.float32))
    bricks.values = bricks.values[:-1]
    with pytest.raises(RangeError, match="one a voxel"):
        bricks.sample(np.zeros((1, 3), np.float32))
    far = spotted_grid(1)
    far.activate(np.array([[2**29, 2**29, 2**29]]), np.ones((1, 1), np.float32))
    with pytest.raises(RangeError, match="crop the grid"):
        BrickField(far)
    with pytest.raises(RangeError, match="room for"):
        BrickField(spotted_grid(1), memory_limit=1000)
