"""Lens distortion: the inverse is an inverse, and straight things become straight again."""

from __future__ import annotations

import numpy as np
import pytest
from photograd.capture import Camera, Distortion, undistort_image
from photograd_course.errors import RangeError, ShapeError

LENSES = [
    Distortion(k1=0.0113),
    Distortion(k1=0.0885, k2=-0.2324),
    Distortion(k1=-0.3, k2=0.1, p1=0.01, p2=-0.02),
    Distortion(k1=0.2, k2=0.05, p1=-0.005, p2=0.004),
]
CAMERA = Camera(120, 90, 130.0, 125.0, 58.0, 47.0, np.eye(4))


def ideal_points() -> np.ndarray:
    """Normalized positions of all pixel centers of CAMERA, (N, 2)."""
    u, v = np.meshgrid(np.arange(120) + 0.5, np.arange(90) + 0.5)
    return np.stack([(u - 58.0) / 130.0, (v - 47.0) / 125.0], axis=-1).reshape(-1, 2)


@pytest.mark.parametrize("lens", LENSES)
def test_round_trip(lens: Distortion) -> None:
    points = ideal_points()
    bent = lens.distort(points)
    assert np.abs(bent - points).max() * 130.0 > 0.1  # the lens does something
    # Newton stops at residuals of 1e-12; times the focal length that is far below 1e-6 px.
    np.testing.assert_allclose(lens.undistort(bent) * 130.0, points * 130.0, atol=1e-6)
    again = lens.distort(lens.undistort(points))
    np.testing.assert_allclose(again * 130.0, points * 130.0, atol=1e-6)


@pytest.mark.parametrize("lens", LENSES)
def test_jacobian_is_the_derivative(lens: Distortion) -> None:
    points = ideal_points()[::37]
    jacobian = lens.jacobian(points)
    assert np.abs(jacobian - np.eye(2)).max() > 1e-4
    for axis in range(2):
        step = 1e-6 * np.eye(2)[axis]
        slope = (lens.distort(points + step) - lens.distort(points - step)) / 2e-6
        # Central differences: 1e-12 from truncation, 1e-10 from rounding.
        np.testing.assert_allclose(jacobian[:, :, axis], slope, atol=1e-9)


def test_radial_distortion_by_hand() -> None:
    bent = Distortion(k1=0.1, k2=0.01).distort(np.array([[0.6, 0.8]]))
    np.testing.assert_allclose(bent, [[0.6 * 1.11, 0.8 * 1.11]], rtol=1e-15)
    tangential = Distortion(p1=0.1, p2=0.01).distort(np.array([[0.6, 0.8]]))
    expected = [0.6 + 0.2 * 0.48 + 0.01 * 1.72, 0.8 + 0.1 * 2.28 + 0.02 * 0.48]
    np.testing.assert_allclose(tangential, [expected], rtol=1e-15)


def test_points_beyond_the_fold_are_refused() -> None:
    lens = Distortion(k1=-0.3)  # r - 0.3 r^3 is largest, 0.703, at r = 1.054
    assert lens.inside_fold(np.array([[1.05, 0.0], [1.06, 0.0]])).tolist() == [True, False]
    assert lens.undistort(np.array([[0.70, 0.0]]))[0, 0] < 1.054
    with pytest.raises(
        RangeError, match=r"Distortion\.undistort: points: expected points that the lens shows"
    ):
        lens.undistort(np.array([[0.1, 0.0], [0.71, 0.0]]))
    with pytest.raises(ShapeError, match=r"Distortion\.distort: points"):
        lens.distort(np.zeros((3, 3)))
    with pytest.raises(RangeError, match="Distortion: k2"):
        Distortion(k2=float("nan"))


def pattern(points: np.ndarray) -> np.ndarray:
    """A smooth opaque picture of the ideal image plane, (N, 4)."""
    x, y = points[:, 0], points[:, 1]
    color = [0.5 + 0.4 * np.sin(9 * x), 0.5 + 0.4 * np.cos(7 * y), 0.5 + 0.3 * np.sin(6 * (x + y))]
    return np.stack([*color, np.ones_like(x)], axis=-1)


def test_a_photograph_becomes_the_pinhole_picture() -> None:
    lens = Distortion(k1=0.09, k2=-0.02, p1=0.003, p2=-0.002)
    photograph = pattern(lens.undistort(ideal_points())).reshape(90, 120, 4).astype(np.float32)
    expected = pattern(ideal_points()).reshape(90, 120, 4)
    assert np.abs(photograph - expected)[..., :3].max() > 0.02  # 40 times the error allowed below
    result, valid = undistort_image(photograph, CAMERA, lens)
    assert 0.9 < valid.mean() < 1.0
    # Bilinear interpolation errs by h^2/8 |f''| <= (1/125)^2 / 8 * (81 + 49) * 0.4 = 4e-4.
    np.testing.assert_allclose(result[valid], expected[valid], atol=5e-4)
    assert (result[~valid] == 0.0).all()


def test_no_distortion_changes_nothing() -> None:
    image = np.random.default_rng(0).random((90, 120, 4), dtype=np.float32)
    result, valid = undistort_image(image, CAMERA, Distortion())
    assert valid.all()
    # Positions come back to the pixel centers within rounding, so weights within about 1e-13.
    np.testing.assert_allclose(result, image, atol=1e-6)
    with pytest.raises(ShapeError, match="undistort_image: image"):
        undistort_image(image[:5], CAMERA, Distortion())


def test_hidden_colors_do_not_bleed() -> None:
    image = np.zeros((90, 120, 4), dtype=np.float32)
    image[..., 0] = 1.0  # red everywhere, but transparent in the left half
    image[:, 60:] = [0.0, 1.0, 0.0, 1.0]
    result, _ = undistort_image(image, CAMERA, LENSES[0])
    seen = result[..., 3] > 0.0
    assert seen.any()
    np.testing.assert_allclose(result[seen][:, 0], 0.0, atol=1e-6)
    np.testing.assert_allclose(result[seen][:, 1], 1.0, atol=1e-6)
