"""Upsampling: affine fields exactly, constants everywhere, borders clamped, nothing overshoots."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from photograd_course.errors import DtypeError, RangeError, ShapeError
from photograd_course.gradcheck import draw_like
from photograd_course.resample import upsample_trilinear


def centers(count: int) -> np.ndarray:
    return (np.arange(count) + 0.5) / count


def affine(shape: tuple[int, int, int]) -> np.ndarray:
    x, y, z = np.meshgrid(*(centers(n) for n in shape), indexing="ij")
    return np.stack([1.0 + 2.0 * x - 3.0 * y + 0.5 * z, x - y], axis=-1)


@pytest.mark.parametrize("new", [(8, 10, 12), (5, 7, 6), (4, 5, 13), (11, 5, 6)])
def test_affine_fields_are_exact_inside(new: tuple[int, int, int]) -> None:
    old = (4, 5, 6)
    fine, expected = upsample_trilinear(affine(old), new), affine(new)
    inside = np.ones(new, dtype=bool)
    for axis, (n, m) in enumerate(zip(old, new, strict=True)):
        within = (centers(m) >= 0.5 / n - 1e-12) & (centers(m) <= 1 - 0.5 / n + 1e-12)
        shape = [1, 1, 1]
        shape[axis] = m
        inside &= within.reshape(shape)
    assert inside.sum() > 20
    # Values up to 3.5: four ulps.
    np.testing.assert_allclose(fine[inside], expected[inside], rtol=0, atol=4e-15)
    first = tuple(0 for _ in new)
    doubled = all(m >= 2 * n for n, m in zip(old, new, strict=True))
    if doubled:
        np.testing.assert_allclose(fine[first], affine(old)[first], atol=4e-15)


def test_against_eight_corners_by_hand() -> None:
    grid, new = draw_like((3, 4, 2), seed=1, stream=0), (5, 8, 3)
    fine = upsample_trilinear(grid, new)
    for target in itertools.product(*(range(n) for n in new)):
        total = 0.0
        at = [
            min(max((i + 0.5) * n / m - 0.5, 0.0), n - 1.0)
            for i, n, m in zip(target, grid.shape, new, strict=True)
        ]
        for corner in itertools.product((0, 1), repeat=3):
            low = [min(int(a), n - 2) for a, n in zip(at, grid.shape, strict=True)]
            parts = [a - b for a, b in zip(at, low, strict=True)]
            weight = np.prod([f if c else 1 - f for f, c in zip(parts, corner, strict=True)])
            total += weight * grid[tuple(b + c for b, c in zip(low, corner, strict=True))]
        assert fine[target] == pytest.approx(total, abs=1e-15)


def test_mean_positivity_and_dtype() -> None:
    grid = np.abs(draw_like((4, 4, 4), seed=2, stream=0)).astype(np.float32)
    fine = upsample_trilinear(grid, (8, 8, 8))
    assert fine.dtype == np.float32
    assert fine.flags.c_contiguous
    assert grid.min() <= fine.min()
    assert fine.max() <= grid.max()
    # Doubling a clamped cell-centered grid keeps its mean: each voxel gives weight 2 per axis.
    assert fine.mean(dtype=np.float64) == pytest.approx(grid.mean(dtype=np.float64), rel=1e-6)
    np.testing.assert_array_equal(upsample_trilinear(grid[:1, :1, :1], (3, 2, 1)), grid[0, 0, 0])


def test_same_shape_is_a_copy() -> None:
    grid = draw_like((3, 4, 5, 2), seed=3, stream=0)
    same = upsample_trilinear(grid, (3, 4, 5))
    np.testing.assert_array_equal(same, grid)
    assert not np.shares_memory(same, grid)


def test_bad_input_is_refused() -> None:
    with pytest.raises(ShapeError, match="grid"):
        upsample_trilinear(np.ones((2, 2)), (4, 4, 4))
    with pytest.raises(RangeError, match="at least 4"):
        upsample_trilinear(np.ones((4, 4, 4)), (8, 3, 8))
    with pytest.raises(ShapeError, match="three sizes"):
        upsample_trilinear(np.ones((4, 4, 4)), (8, 8))  # type: ignore[arg-type]
    with pytest.raises(DtypeError, match="grid"):
        upsample_trilinear(np.ones((4, 4, 4), dtype=np.int64), (8, 8, 8))
