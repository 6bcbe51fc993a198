"""Bilinear lookup on a texture without any symmetry: 2 rows, 3 columns, 3 different channels."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, ShapeError
from photograd.fields import Texture2D
from photograd.textures import sample, sample_backward
from photograd_course.gradcheck import check_gradient, dot_product_error

# Row 0: 1 2 3, row 1: 10 20 30; the second channel is minus the first, the third its square.
RED = np.array([[1.0, 2.0, 3.0], [10.0, 20.0, 30.0]])
TEXTURE = np.stack([RED, -RED, RED**2], axis=-1)


def red(*points: tuple[float, float]) -> list[float]:
    values: list[float] = sample(TEXTURE, np.array(points))[:, 0].tolist()
    return values


def test_rows_go_down_columns_to_the_right() -> None:
    centers = [((column + 0.5) / 3, (row + 0.5) / 2) for row in range(2) for column in range(3)]
    np.testing.assert_allclose(red(*centers), RED.ravel(), rtol=1e-14)
    np.testing.assert_allclose(
        sample(TEXTURE, np.array(centers)), TEXTURE.reshape(6, 3), rtol=1e-14
    )


def test_half_way_is_the_mean_of_its_neighbors() -> None:
    between_columns, between_rows, middle_of_four = (1 / 3, 0.25), (0.5, 0.5), (2 / 3, 0.5)
    np.testing.assert_allclose(
        red(between_columns, between_rows, middle_of_four),
        [1.5, 11.0, (2 + 3 + 20 + 30) / 4],
        rtol=1e-14,
    )


def test_the_border_continues_outwards() -> None:
    corners = red((0, 0), (1, 0), (0, 1), (1, 1), (-5, 0.0), (7.0, 9.0))
    assert corners == [1, 3, 10, 30, 1, 30]


def test_affine_pictures_are_exact_and_weights_add_up_to_one() -> None:
    row, column = np.meshgrid(np.arange(5), np.arange(4), indexing="ij")
    x, y = (column + 0.5) / 4, (row + 0.5) / 5
    texture = np.stack([0.3 + 2 * x - y, np.ones_like(x), 5 * y], axis=-1)
    g = np.random.default_rng(0)
    u, v = g.uniform(0.125, 0.875, 50), g.uniform(0.1, 0.9, 50)
    expected = np.stack([0.3 + 2 * u - v, np.ones(50), 5 * v], axis=-1)
    np.testing.assert_allclose(sample(texture, np.stack([u, v], -1)), expected, atol=1e-14)


def test_a_point_gives_its_derivative_to_its_four_texels() -> None:
    # Three quarters from column 1 to column 2, one quarter from row 0 to row 1.
    point = np.array([[(1.75 + 0.5) / 3, (0.25 + 0.5) / 2]])
    d_texture, d_point = sample_backward(TEXTURE, point, np.array([[1.0, 0.0, 0.0]]))
    expected = np.array([[0, 0.75 * 0.25, 0.75 * 0.75], [0, 0.25 * 0.25, 0.25 * 0.75]])
    np.testing.assert_allclose(d_texture[..., 0], expected, rtol=1e-13, atol=1e-16)
    assert not d_texture[..., 1:].any()
    # d/dx = W ((1 - g)(3 - 2) + g (30 - 20)), d/dy = H ((1 - f)(20 - 2) + f (30 - 3))
    slopes = [3 * (0.75 + 2.5), 2 * (0.25 * 18 + 0.75 * 27)]
    np.testing.assert_allclose(d_point, [slopes], rtol=1e-12)


def test_many_points_on_one_texel_add_up() -> None:
    points = np.tile([[0.5, 0.25]], (7, 1))
    d_texture, _ = sample_backward(TEXTURE, points, np.full((7, 3), 0.5))
    assert d_texture[0, 1].tolist() == [3.5, 3.5, 3.5]
    assert d_texture.sum() == pytest.approx(10.5, rel=1e-15)


def test_clamped_points_do_not_move_the_value() -> None:
    points = np.array([[-0.3, 0.4], [0.5, 1.7], [0.05, 0.95]])
    _, d_points = sample_backward(TEXTURE, points, np.ones((3, 3)))
    assert d_points[0, 0] == 0
    assert d_points[1, 1] == 0
    assert d_points[2].tolist() == [0, 0]
    assert abs(d_points[0, 1]) > 0
    assert abs(d_points[1, 0]) > 0


def test_dot_product_of_a_linear_stage() -> None:
    points = np.random.default_rng(1).uniform(-0.1, 1.1, (40, 2))
    report = dot_product_error(
        lambda _, v: sample(v["texture"], points),  # linear: J v is the function at v
        lambda p, d: {"texture": sample_backward(p["texture"], points, d)[0]},
        {"texture": TEXTURE},
        seed=1,
        tolerance=1e-12,
    )
    assert report, str(report)


@pytest.mark.parametrize("shape", [(1, 4, 3), (4, 1, 3), (1, 1, 3)])
def test_a_single_row_or_column_is_constant_across(shape: tuple[int, ...]) -> None:
    g = np.random.default_rng(2)
    texture, points = g.uniform(0, 1, shape), g.uniform(0, 1, (20, 2))
    report = check_gradient(
        lambda p: sample(p["texture"], points),
        lambda p, d: {"texture": sample_backward(p["texture"], points, d)[0]},
        {"texture": texture},
        seed=2,
    )
    assert report, str(report)
    if shape[0] == 1:
        other = points * [1.0, 0.3]
        np.testing.assert_array_equal(sample(texture, points), sample(texture, other))


@pytest.mark.parametrize(
    ("texels", "error", "words"),
    [
        (
            np.zeros((2, 3)),
            ShapeError,
            r"texels: expected shape \(H, W, 3\) with H, W >= 1, got \(2, 3\)",
        ),
        (np.zeros((2, 3, 4)), ShapeError, r"got \(2, 3, 4\)"),
        (np.zeros((0, 3, 3)), ShapeError, r"got \(0, 3, 3\)"),
        (np.zeros((2, 3, 3), int), DtypeError, "expected float32 or float64, got int64"),
    ],
)
def test_bad_textures_are_refused(texels: Any, error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        Texture2D(texels)
