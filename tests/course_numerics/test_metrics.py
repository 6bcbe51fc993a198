"""PSNR and SSIM against hand-written direct forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from photograd_course import metrics
from photograd_course.errors import DtypeError, RangeError, ShapeError
from photograd_course.gradcheck import draw_like


def images(channels: tuple[int, ...] = ()) -> tuple[np.ndarray, np.ndarray]:
    shape = (16, 14, *channels)
    x = 0.5 + 0.4 * draw_like(shape, seed=1, stream=0)
    return np.clip(x + 0.1 * draw_like(shape, seed=1, stream=1), 0, 1), x


def direct_ssim(x: np.ndarray, y: np.ndarray, peak: float) -> float:
    """[Wang2004] window by window with a full 2D kernel and centered moments, for one channel."""
    kernel = np.array(
        [[math.exp(-(i * i + j * j) / (2 * 1.5**2)) for j in range(-5, 6)] for i in range(-5, 6)]
    )
    kernel /= kernel.sum()
    c1, c2 = (0.01 * peak) ** 2, (0.03 * peak) ** 2
    values = []
    for row in range(x.shape[0] - 10):
        for column in range(x.shape[1] - 10):
            a, b = x[row : row + 11, column : column + 11], y[row : row + 11, column : column + 11]
            mu_a, mu_b = (kernel * a).sum(), (kernel * b).sum()
            var_a, var_b = (kernel * (a - mu_a) ** 2).sum(), (kernel * (b - mu_b) ** 2).sum()
            cov = (kernel * (a - mu_a) * (b - mu_b)).sum()
            top = (2 * mu_a * mu_b + c1) * (2 * cov + c2)
            values.append(top / ((mu_a**2 + mu_b**2 + c1) * (var_a + var_b + c2)))
    return float(np.mean(values))


def test_psnr_by_hand() -> None:
    target = np.zeros((4, 5, 3))
    assert metrics.psnr(target + 0.1, target) == pytest.approx(20.0, abs=1e-12)
    assert metrics.psnr(target + 25.5, target, peak=255.0) == pytest.approx(20.0, abs=1e-12)
    assert metrics.psnr(target, target) == math.inf
    x, y = images((3,))
    error = sum(float(d) ** 2 for d in (x - y).reshape(-1)) / x.size
    assert metrics.psnr(x, y) == pytest.approx(-10 * math.log10(error), rel=1e-13)


@pytest.mark.parametrize("peak", [1.0, 255.0])
def test_ssim_against_the_direct_form(peak: float) -> None:
    x, y = (image * peak for image in images())
    value = metrics.ssim(x, y, peak=peak)
    assert 0.5 < value < 0.999
    # Moments as differences of blurred squares lose about four digits of sixteen.
    assert value == pytest.approx(direct_ssim(x, y, peak), abs=1e-12)


def test_ssim_of_channels_is_their_mean() -> None:
    x, y = images((3,))
    alone = [metrics.ssim(x[..., c], y[..., c]) for c in range(3)]
    assert metrics.ssim(x, y) == pytest.approx(np.mean(alone), abs=1e-15)
    assert len(set(alone)) == 3


def test_ssim_properties() -> None:
    x, y = images()
    assert metrics.ssim(x, x) == pytest.approx(1.0, abs=1e-14)
    assert metrics.ssim(x, y) == metrics.ssim(y, x)
    # Same mean squared error, other structure: a shift of brightness costs far less than noise.
    noise = x - y
    shift = y + math.sqrt(float(np.mean(noise**2)))
    assert metrics.psnr(shift, y) == pytest.approx(metrics.psnr(x, y), abs=1e-9)
    assert metrics.ssim(shift, y) > metrics.ssim(x, y)


MASK = np.ones((16, 14), np.bool_)
MASK[:3] = MASK[:, 12:] = MASK[14, 4] = False


@pytest.mark.parametrize("channels", [(), (3,)])
def test_only_valid_pixels_count(channels: tuple[int, ...]) -> None:
    x, y = images(channels)
    error = [(x - y)[row, column] ** 2 for row, column in np.argwhere(MASK)]
    assert metrics.psnr(x, y, valid=MASK) == pytest.approx(-10 * math.log10(np.mean(error)))
    # Of 6 x 4 windows those of the rows 3, and of the columns 0 and 1, hold valid pixels alone.
    windows = metrics.whole_windows(MASK)
    assert windows.shape == (6, 4)
    assert np.argwhere(windows).tolist() == [[3, 0], [3, 1]]
    inside = [metrics.ssim(x[3:14, c : c + 11], y[3:14, c : c + 11]) for c in (0, 1)]
    assert inside[0] != inside[1]
    assert metrics.ssim(x, y, valid=MASK) == pytest.approx(np.mean(inside), abs=1e-14)


@pytest.mark.parametrize("metric", [metrics.psnr, metrics.ssim])
def test_other_pixels_may_hold_anything(metric: Any) -> None:
    x, y = images((3,))
    before = metric(x, y, valid=MASK)
    for filling in (0.0, 1e30, np.nan, np.inf):
        a, b = x.copy(), y.copy()
        a[~MASK], b[~MASK] = filling, 0.25
        assert metric(a, b, valid=MASK) == before
    assert metric(x, y) != before
    assert metric(x, y, valid=np.ones((16, 14), np.bool_)) == metric(x, y)  # to the bit
    assert metric(x, np.where(MASK[..., None], x, y), valid=MASK) == metric(x, x)


@pytest.mark.parametrize("metric", [metrics.psnr, metrics.ssim])
def test_masks_that_cannot_be_are_refused(metric: Any) -> None:
    x, y = images((3,))
    name = metric.__name__
    with pytest.raises(ShapeError, match=rf"{name}: valid: expected shape \(16, 14\)"):
        metric(x, y, valid=MASK[1:])
    with pytest.raises(DtypeError, match=f"{name}: valid: expected a boolean array, got float64"):
        metric(x, y, valid=MASK.astype(np.float64))
    with pytest.raises(RangeError, match=f"{name}: valid: expected at least one .*, got none"):
        metric(x, y, valid=np.zeros_like(MASK))
    x[14, 4] = np.nan
    assert np.isfinite(metric(x, y, valid=MASK))
    x[13, 4] = np.nan
    with pytest.raises(RangeError, match="prediction: expected finite values, got 3 of 672"):
        metric(x, y, valid=MASK)


def test_a_window_needs_valid_pixels_alone() -> None:
    x, y = images()
    stripes = np.ones_like(MASK)
    stripes[::10] = False
    assert metrics.psnr(x, y, valid=stripes) > 0
    with pytest.raises(RangeError, match="ssim: valid: expected at least one 11 x 11 window"):
        metrics.ssim(x, y, valid=stripes)
    assert metrics.whole_windows(MASK[:10]).shape == (0, 4)
    with pytest.raises(ShapeError, match="whole_windows: valid"):
        metrics.whole_windows(MASK[0])


def test_round_to_8_bits() -> None:
    levels = np.arange(256) / 255.0
    np.testing.assert_array_equal(metrics.round_to_8_bits(levels), levels)
    rounded = metrics.round_to_8_bits(np.array([-1.0, 0.5, 0.001, 0.002, 2.0]))
    np.testing.assert_array_equal(rounded, np.array([0, 128, 0, 1, 255]) / 255.0)


@pytest.mark.parametrize("metric", [metrics.psnr, metrics.ssim])
def test_bad_input_is_refused(metric: object) -> None:
    x, y = images((3,))
    with pytest.raises(ShapeError, match="target"):
        metric(x, y[:1])  # type: ignore[operator]
    with pytest.raises(DtypeError, match="prediction"):
        metric((x * 255).astype(np.uint8), y)  # type: ignore[operator]
    with pytest.raises(RangeError, match="peak"):
        metric(x, y, peak=0.0)  # type: ignore[operator]
    y[0, 0, 0] = np.nan
    with pytest.raises(RangeError, match="1 of 672"):
        metric(x, y)  # type: ignore[operator]
    with pytest.raises(ShapeError, match="11 x 11"):
        metrics.ssim(x[:10], x[:10])
