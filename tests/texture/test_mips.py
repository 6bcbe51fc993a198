"""Mip maps: means over covered areas, lookups between levels, and their adjoints."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd.textures import (
    build_mips,
    build_mips_backward,
    mip_level,
    sample,
    sample_mips,
    sample_mips_backward,
)
from photograd_course.gradcheck import check_gradient, dot_product_error

from tests.texture.oracle import noise, points

SHAPES = [(1, 1), (8, 8), (5, 7), (1, 6), (3, 2), (13, 16), (17, 33)]


def area_weights(n: int) -> Any:
    """(m, n): share of texel i of n in texel j of the next level, from the overlap of intervals."""
    m = max(n // 2, 1)
    coarse, fine = np.arange(m)[:, None] * n / m, np.arange(n)
    overlap = np.minimum(coarse + n / m, fine + 1) - np.maximum(coarse, fine)
    return np.maximum(overlap, 0) * m / n


@pytest.mark.parametrize("shape", SHAPES)
def test_levels_are_means_over_the_area(shape: tuple[int, int]) -> None:
    mips = build_mips(noise((*shape, 3), 1))
    assert mips[-1].shape == (1, 1, 3)
    for fine, coarse in pairwise(mips):
        height, width = fine.shape[:2]
        assert coarse.shape == (max(height // 2, 1), max(width // 2, 1), 3)
        rows, columns = area_weights(height), area_weights(width)
        expected = np.einsum("ih,jw,hwc->ijc", rows, columns, fine)
        np.testing.assert_allclose(coarse, expected, atol=1e-14)
        np.testing.assert_allclose(coarse.mean((0, 1)), fine.mean((0, 1)), atol=1e-14)


@pytest.mark.parametrize("shape", SHAPES)
def test_constants_stay(shape: tuple[int, int]) -> None:
    for level in build_mips(np.full((*shape, 2), 0.7)):
        np.testing.assert_allclose(level, 0.7, rtol=1e-15)


def ramp(height: int, width: int) -> Any:
    """(H, W, 2): u and v at the centers."""
    v, u = np.meshgrid(
        (np.arange(height) + 0.5) / height, (np.arange(width) + 0.5) / width, indexing="ij"
    )
    return np.stack([u, v], axis=-1)


def test_ramps_stay_where_sizes_are_even() -> None:
    for level in build_mips(ramp(64, 16)):
        np.testing.assert_allclose(level, ramp(*level.shape[:2]), atol=1e-15)


@pytest.mark.parametrize("n", [3, 5, 7, 31, 101])
def test_ramps_move_by_the_stated_part_of_a_texel_where_sizes_are_odd(n: int) -> None:
    m = n // 2
    gap = np.abs(build_mips(ramp(n, n))[1] - ramp(m, m)).max() * n
    assert gap == pytest.approx((m - 1) / (2 * m * n), abs=1e-13)


@pytest.mark.parametrize("shape", SHAPES)
def test_adjoint_of_the_levels(shape: tuple[int, int]) -> None:
    texture = noise((*shape, 3), 1)
    mips = build_mips(texture)
    d_mips = [noise(level.shape, 10 + k) for k, level in enumerate(mips)]
    kept = [level.copy() for level in d_mips]
    forward = sum(float(np.vdot(a, b)) for a, b in zip(mips, d_mips, strict=True))
    back = float(np.vdot(texture, build_mips_backward(d_mips)))
    size = sum(np.linalg.norm(a) * np.linalg.norm(b) for a, b in zip(mips, d_mips, strict=True))
    assert abs(forward) > 1e-3
    assert abs(forward - back) <= 1e-12 * size  # the map is linear
    assert all(np.array_equal(a, b) for a, b in zip(kept, d_mips, strict=True))


def test_level_of_a_footprint() -> None:
    # Of 64 x 32 texels: 4 texels along u, 8 texels along v, slanted 3-4-5, a point, a huge one.
    sides = np.array(
        [
            [[4 / 32, 0], [0, 1 / 64]],
            [[0, 1 / 64], [0, 8 / 64]],
            [[6 / 32, 8 / 64], [0, 0]],
            [[0, 0], [0, 0]],
            [[1e200, 0], [0, 0]],
        ]
    )
    level = mip_level((64, 32, 3), sides)
    np.testing.assert_allclose(level[:3], [2, 3, np.log2(10)], rtol=1e-15)
    assert level[3] == 0
    assert level[4] > 500
    sizes = 1 + 100 * points(1000, 2, reach=0.0)[:, 0]
    many = np.zeros((1000, 2, 2))
    many[:, 1, 0] = sizes / 32
    np.testing.assert_allclose(mip_level((64, 32), many), np.log2(sizes), rtol=1e-14, atol=1e-15)


def test_whole_levels_and_what_lies_between() -> None:
    mips, uv = build_mips(noise((12, 9, 3), 1)), points(50, 2)
    looked_up = [sample(level, uv) for level in mips]
    for k, expected in enumerate(looked_up):
        assert np.array_equal(sample_mips(mips, uv, np.full(50, float(k))), expected)
    quarter = sample_mips(mips, uv, np.full(50, 1.25))
    np.testing.assert_allclose(quarter, 0.75 * looked_up[1] + 0.25 * looked_up[2], atol=1e-15)
    for level, end in ((-3.0, 0), (99.0, -1)):
        assert np.array_equal(sample_mips(mips, uv, np.full(50, level)), looked_up[end])


def names(mips: list[Any]) -> dict[str, Any]:
    return {f"level {k}": level for k, level in enumerate(mips)}


def test_adjoint_of_the_lookup() -> None:
    mips, uv = build_mips(noise((37, 22, 3), 1)), points(3000, 2)
    level = np.random.default_rng(5).uniform(-1, 7, 3000)
    report = dot_product_error(
        lambda _, v: sample_mips(list(v.values()), uv, level),
        lambda p, d: names(sample_mips_backward(list(p.values()), uv, level, d)[0]),
        names(mips),
        seed=1,
        tolerance=1e-12,
    )
    assert report, str(report)


def inside_of_cells(count: int, sizes: list[int], seed: int) -> Any:
    """Coordinates at least a hundredth of a texel away from the centers of all levels."""
    x = np.random.default_rng(seed).uniform(0.05, 0.95, 40 * count)
    far = np.ones(len(x), bool)
    for n in sizes:
        q = x * n - 0.5
        far &= np.abs(q - np.round(q)) > 0.01
    return x[far][:count]


def test_derivative_by_point_and_level() -> None:
    mips = build_mips(noise((12, 9, 3), 1))
    columns, rows = [m.shape[1] for m in mips], [m.shape[0] for m in mips]
    uv = np.stack([inside_of_cells(40, columns, 3), inside_of_cells(40, rows, 4)], axis=-1)
    level = np.random.default_rng(5).integers(0, 3, 40) + np.linspace(0.05, 0.95, 40)

    def backward(p: Any, d: Any) -> Any:
        _, d_uv, d_level = sample_mips_backward(mips, p["uv"], p["level"], d)
        return {"uv": d_uv, "level": d_level}

    report = check_gradient(
        lambda p: sample_mips(mips, p["uv"], p["level"]),
        backward,
        {"uv": uv, "level": level},
        seed=3,
    )
    assert report, str(report)
    *_, d_level = sample_mips_backward(mips, uv, np.full(40, 50.0), np.ones((40, 3)))
    assert not d_level.any()


def test_a_texture_without_a_second_level() -> None:
    mips, uv, level = build_mips(noise((1, 1, 2), 1)), points(5, 2), np.linspace(-1, 3, 5)
    assert (sample_mips(mips, uv, level) == mips[0][0]).all()
    d_mips, d_uv, d_level = sample_mips_backward(mips, uv, level, np.ones((5, 2)))
    assert d_mips[0].ravel().tolist() == [5, 5]
    assert not d_uv.any()
    assert not d_level.any()


UV = np.zeros((4, 2))
BAD: list[tuple[Any, Any, Any, type[Exception], str]] = [
    ([], UV, UV[:, 0], RangeError, "sample_mips: mips: expected at least one level, got none"),
    (
        [np.zeros((4, 4, 3)), np.zeros((3, 2, 3))],
        UV,
        UV[:, 0],
        RangeError,
        r"mips\[1\]: expected the shapes that build_mips makes, got 3 x 2 x 3",
    ),
    ([np.zeros((4, 4, 3)), np.zeros((2, 2, 2))], UV, UV[:, 0], RangeError, "got 2 x 2 x 2"),
    ([np.zeros((1, 1, 3)), np.zeros((1, 1, 3))], UV, UV[:, 0], RangeError, r"mips\[1\]"),
    ([np.zeros((4, 4, 3))], UV, np.full(4, np.nan), RangeError, "level: expected finite numbers"),
    ([np.zeros((4, 4, 3))], UV, UV[:3, 0], ShapeError, r"level: expected shape \(N,\) with N = 4"),
    ([np.zeros((4, 4, 3), "f4")], UV, UV[:, 0], DtypeError, "uv: expected float32, got"),
    ([np.zeros((4, 4))], UV, UV[:, 0], ShapeError, r"mips\[0\]: expected shape \(H, W, C\)"),
]


@pytest.mark.parametrize(("mips", "uv", "level", "error", "words"), BAD)
def test_bad_input_is_refused(
    mips: Any, uv: Any, level: Any, error: type[Exception], words: str
) -> None:
    with pytest.raises(error, match=words):
        sample_mips(mips, uv, level)
