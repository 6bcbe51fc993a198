"""Batch lookups in textures of any shape, their adjoint, and what they refuse."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd.textures import sample, sample_backward
from photograd_course.gradcheck import check_gradient, dot_product_error

from tests.texture.oracle import adjoint, lookup, noise, points

# Sizes below, at and above a tile's 16 cells, with a single row or column among them.
SHAPES = [(2, 3), (1, 1), (1, 5), (4, 1), (16, 17), (17, 16), (18, 33), (53, 40)]
WRONG = [
    "swapped axes",
    "half a texel",
    "corners aligned",
    "fractions swapped",
    "wraps around",
    "a texel forgotten",
    "overwrites",
]


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
@pytest.mark.parametrize("shape", SHAPES)
def test_lookup_and_adjoint_agree_with_numpy(shape: tuple[int, int], channels: int) -> None:
    texture, uv = noise((*shape, channels), 1), points(700, 2)
    color = sample(texture, uv)
    assert np.abs(color).max() > 0.01
    np.testing.assert_allclose(color, lookup(texture, uv), atol=1e-15, rtol=1e-14)
    d_color = noise((700, channels), 3)
    d_texture, _ = sample_backward(texture, uv, d_color)
    expected = adjoint(texture.shape, uv, d_color)
    assert np.abs(expected).max() > 0.1
    # Up to 700 numbers below one add up in a texel, in another order.
    np.testing.assert_allclose(d_texture, expected, atol=1e-12)


@pytest.mark.parametrize("wrong", WRONG)
def test_a_wrong_lookup_or_adjoint_is_seen(wrong: str) -> None:
    texture, uv, d_color = noise((18, 33, 3), 1), points(700, 2), noise((700, 3), 3)
    d_texture, _ = sample_backward(texture, uv, d_color)
    gap = np.abs(d_texture - adjoint(texture.shape, uv, d_color, wrong)).max()
    if wrong != "overwrites":
        gap = min(gap, np.abs(sample(texture, uv) - lookup(texture, uv, wrong)).max())
    assert gap > 1e-3  # a thousand million times the tolerance above


def test_rows_go_down_and_columns_to_the_right() -> None:
    texture = np.array([[1.0, 2.0, 3.0], [10.0, 20.0, 30.0]])[..., None]
    centers = np.array([[(j + 0.5) / 3, (i + 0.5) / 2] for i in range(2) for j in range(3)])
    np.testing.assert_allclose(sample(texture, centers)[:, 0], texture.ravel(), rtol=1e-14)
    outside = np.array([[-5.0, 0.0], [7.0, 9.0], [0.0, 1.0]])
    assert sample(texture, outside)[:, 0].tolist() == [1, 30, 10]


@pytest.mark.parametrize("shape", [(2, 3), (40, 21)])
def test_affine_textures_are_exact(shape: tuple[int, int]) -> None:
    height, width = shape
    v, u = np.meshgrid(
        (np.arange(height) + 0.5) / height, (np.arange(width) + 0.5) / width, indexing="ij"
    )
    texture = np.stack([0.3 + 2 * u - v, np.ones_like(u), 5 * v], axis=-1)
    low = np.array([0.5 / width, 0.5 / height])
    uv = low + (1 - 2 * low) * points(10_000, 4, reach=0.0)
    x, y = uv.T
    expected = np.stack([0.3 + 2 * x - y, np.ones_like(x), 5 * y], axis=-1)
    np.testing.assert_allclose(sample(texture, uv), expected, atol=1e-12)  # measured 2e-15


def test_weights_add_up_to_one() -> None:
    uv = points(5000, 5)
    ones = np.ones((19, 35, 1))
    assert np.abs(sample(ones, uv) - 1).max() < 1e-15
    d_texture, _ = sample_backward(ones, uv, np.ones((5000, 1)))
    assert d_texture.min() >= 0
    assert d_texture.sum() == pytest.approx(5000, rel=1e-13)


@pytest.mark.parametrize("shape", [(2, 3), (33, 50)])
def test_adjoint_of_a_linear_map(shape: tuple[int, int]) -> None:
    uv = points(3000, 6)
    report = dot_product_error(
        lambda _, v: sample(v["texture"], uv),  # linear: J v is the function at v
        lambda p, d: {"texture": sample_backward(p["texture"], uv, d)[0]},
        {"texture": noise((*shape, 3), 7)},
        seed=1,
        tolerance=1e-12,
    )
    assert report, str(report)


def test_derivative_by_the_point() -> None:
    # Between centers, at least a hundredth of a cell from any: there the slope jumps.
    texture, g = noise((7, 5, 3), 8), np.random.default_rng(9)
    cell = np.stack([g.integers(0, 4, 60), g.integers(0, 6, 60)], axis=-1)
    uv = (cell + g.uniform(0.01, 0.99, (60, 2)) + 0.5) / [5, 7]
    report = check_gradient(
        lambda p: sample(texture, p["uv"]),
        lambda p, d: {"uv": sample_backward(texture, p["uv"], d)[1]},
        {"uv": uv},
        seed=3,
    )
    assert report, str(report)


def test_a_clamped_coordinate_does_not_move_the_value() -> None:
    texture = noise((7, 5, 3), 8)
    uv = np.array([[-0.3, 0.4], [0.5, 1.7], [0.05, 0.99], [0.5, 0.5]])
    _, d_uv = sample_backward(texture, uv, np.ones((4, 3)))
    assert (d_uv == 0).tolist() == [[True, False], [False, True], [True, True], [False, False]]


def test_backward_adds_to_its_buffers() -> None:
    texture, uv, d_color = noise((18, 20, 3), 1), points(200, 2), noise((200, 3), 3)
    once = sample_backward(texture, uv, d_color)
    twice = tuple(part.copy() for part in once)
    _core.sample_backward(texture, uv, d_color, *twice)
    for a, b in zip(once, twice, strict=True):
        np.testing.assert_allclose(b, 2 * a, rtol=1e-13)


def test_float_agrees_with_double() -> None:
    uv = points(2000, 2).astype(np.float32)
    for channels in (1, 3, 4):
        texture = noise((30, 41, channels), 1).astype(np.float32)
        d_color = noise((2000, channels), 3).astype(np.float32)
        narrow = [sample(texture, uv), *sample_backward(texture, uv, d_color)]
        wide_args = [a.astype(np.float64) for a in (texture, uv, d_color)]
        wide = [sample(*wide_args[:2]), *sample_backward(*wide_args)]
        for a, b in zip(narrow, wide, strict=True):
            # Published bound 1e-4; a fraction of a texel has lost 6 of 24 bits to its position.
            assert np.linalg.norm(a - b) <= 1e-4 * np.linalg.norm(b)


def test_three_channels_take_another_way_to_the_same_bits() -> None:
    uv = points(4097 + 33, 2).astype(np.float32)  # a last chunk that is not full
    four = noise((30, 41, 4), 1).astype(np.float32)
    three = sample(np.ascontiguousarray(four[..., :3]), uv)
    assert np.array_equal(three, sample(four, uv)[:, :3])


@pytest.mark.parametrize("count", [0, 1, 31, 32, 33, 4096, 4097])
def test_any_number_of_points(count: int) -> None:
    texture, uv = noise((9, 8, 3), 1).astype(np.float32), points(count, 2).astype(np.float32)
    lent = np.full((count + 1, 3), 7, np.float32)
    assert sample(texture, uv, out=lent[:count]).base is lent
    assert (lent[count] == 7).all()  # nothing was written behind the last point
    np.testing.assert_allclose(lent[:count], lookup(texture, uv), atol=1e-5)
    d_texture, d_uv = sample_backward(texture, uv, lent[:count])
    assert d_uv.shape == (count, 2)
    assert d_texture.any() == (count > 0)


UV = np.zeros((4, 2))
BAD: list[tuple[Any, Any, type[Exception], str]] = [
    (np.zeros((3, 3, 3), int), UV, DtypeError, "sample: texture: expected float32 or float64"),
    (np.zeros((3, 3, 3)), UV.astype("f4"), DtypeError, "uv: expected float64 as texture, got"),
    (np.zeros((3, 3)), UV, ShapeError, r"texture: expected shape \(H, W, C\), got \(3, 3\)"),
    (np.zeros((3, 3, 3)), UV[:, :1], ShapeError, r"uv: expected shape \(N, 2\), got \(4, 1\)"),
    (np.zeros((0, 3, 3)), UV, RangeError, "texels along each axis, got 0 x 3"),
    (np.zeros((3, 3, 5)), UV, RangeError, "1 to 4 channels, got 5"),
    (
        np.zeros((3, 3, 3)),
        np.array([[0, 0.5], [np.nan, np.inf]]),
        RangeError,
        "uv: expected finite numbers, got 2 that are not, the first in row 1",
    ),
]


@pytest.mark.parametrize(("texture", "uv", "error", "words"), BAD)
def test_bad_input_is_refused(texture: Any, uv: Any, error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        sample(texture, uv)


@pytest.mark.parametrize("channels", [3, 4])
@pytest.mark.parametrize("point", [0, 31, 32, 4095, 4096, 4996])
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_one_coordinate_that_is_no_number_is_found(channels: int, point: int, value: float) -> None:
    uv = points(4997, 2).astype(np.float32)
    uv[point, point % 2] = value
    with pytest.raises(RangeError, match=f"got 1 that are not, the first in row {point}"):
        sample(noise((9, 8, channels), 1).astype(np.float32), uv)


def test_a_cotangent_of_another_shape_is_refused() -> None:
    with pytest.raises(ShapeError, match=r"sample_backward: d_color: expected shape \(N, C\)"):
        sample_backward(np.zeros((3, 3, 3)), UV, np.zeros((4, 2)))
