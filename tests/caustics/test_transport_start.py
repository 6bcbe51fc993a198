"""Optimal transport, heights from slopes, and the lens that they make."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.caustics import Axes, Lens, transport_lens, transport_map
from photograd.caustics.measure import correlation, measure
from photograd.caustics.smoothing import CosineBasis
from photograd.errors import RangeError
from photograd.lights import PointLight
from photograd.transport import IrradianceSensor

from tests.caustics.test_lens import SUN


def axes(n: int, low: float = 0.0, high: float = 1.0) -> Axes:
    centers = low + (np.arange(n) + 0.5) / n * (high - low)
    return Axes(centers, centers)


def bell(where: Axes, x: float, y: float, width: float) -> Any:
    square = (where.x - x) ** 2 + ((where.y - y) ** 2)[:, None]
    return np.exp(-square / (2 * width * width))


def test_between_two_bells_the_map_is_linear() -> None:
    """Of Gaussians it is known: a shift, and a stretch by the ratio of their widths."""
    source, target = axes(32), axes(40, 0.5, 2.5)
    there = transport_map(bell(source, 0.5, 0.5, 0.1), source, bell(target, 1.6, 1.4, 0.2), target)
    x, y = np.meshgrid(source.x, source.y)
    inside = (x - 0.5) ** 2 + (y - 0.5) ** 2 < 0.15**2
    wanted = np.stack([1.6 + 2 * (x - 0.5), 1.4 + 2 * (y - 0.5)], axis=-1)
    assert np.abs(there - wanted)[inside].max() < 0.02  # m; a cell of the target is 0.05


def test_light_goes_where_the_target_has_it() -> None:
    """Shares of four quarters, by counting where cells of even light go."""
    source = axes(32)
    target = np.zeros((32, 32))
    target[:16, :16], target[16:, 16:], target[:16, 16:] = 1.0, 3.0, 2.0
    there = transport_map(np.ones((32, 32)), source, target, source)
    right, low = there[..., 0] > 0.5, there[..., 1] > 0.5
    found = [np.mean(~right & ~low), np.mean(right & low), np.mean(right & ~low)]
    np.testing.assert_allclose(found, [1 / 6, 1 / 2, 1 / 3], atol=0.02)
    curl = np.diff(there[..., 0], axis=0)[:, 1:] - np.diff(there[..., 1], axis=1)[1:]
    assert np.abs(curl).mean() < 0.25 * np.abs(np.diff(there[..., 0], axis=0)).mean()


def test_heights_come_back_from_their_differences() -> None:
    rng = np.random.default_rng(0)
    h, basis = rng.normal(size=(9, 14)), CosineBasis(9, 14)
    found = basis.integrate(np.diff(h, axis=1) / 0.2, np.diff(h, axis=0) / 0.3, 0.2, 0.3)
    np.testing.assert_allclose(found, h - h.mean(), atol=1e-12)


def test_smoothing_solves_with_the_laplacian_and_is_symmetric() -> None:
    rng = np.random.default_rng(1)
    a, b = rng.normal(size=(2, 7, 10))
    basis = CosineBasis(7, 10)
    h = basis.smooth(a, 3.0)
    padded = np.pad(h, 1, mode="edge")
    near = padded[:-2, 1:-1] + padded[2:, 1:-1] + padded[1:-1, :-2] + padded[1:-1, 2:]
    np.testing.assert_allclose(h + 3.0 * (4 * h - near), a, atol=1e-12)
    assert (h * b).sum() == pytest.approx((a * basis.smooth(b, 3.0)).sum())


def plate(m: int = 65, n: int = 65) -> Lens:
    return Lens([-0.05, 0.1, 0.05], [0.1, 0, 0], [0, 0, -0.1], 0.02, np.zeros((m, n)), 1.5)


def wall(cells: int = 32) -> IrradianceSensor:
    return IrradianceSensor([0.05, 0.4, 0.05], [-0.1, 0, 0], [0, 0, -0.1], cells, cells)


def spots(cells: int = 32) -> Any:
    grid = Axes(*[np.arange(cells) / cells] * 2)
    return 0.1 + bell(grid, 0.3, 0.4, 0.1) + 0.7 * bell(grid, 0.7, 0.6, 0.07)


@pytest.mark.parametrize("light", [SUN, PointLight([0.02, -0.9, 0.01], [9.0] * 3)], ids=str)
def test_the_lens_forms_the_picture_to_first_order(light: Any) -> None:
    target = spots()
    lens = transport_lens(plate(), light, wall(), target)
    before = measure([plate()], light, wall(), seed=0, rays=4)
    after = measure([lens], light, wall(), seed=0, rays=4)
    assert abs(correlation(before.irradiance, target)) < 0.4
    assert correlation(after.irradiance, target) > 0.97
    assert after.received > 0.98 * after.transmitted


def test_what_cannot_be_a_picture() -> None:
    with pytest.raises(RangeError, match="a picture with light"):
        transport_lens(plate(), SUN, wall(), np.zeros((32, 32)))
    with pytest.raises(RangeError, match=r"target: .*finite"):
        transport_lens(plate(), SUN, wall(), np.full((32, 32), np.nan))
    turned = IrradianceSensor([0.05, 0.4, 0], [-0.05, 0, 0.05], [-0.05, 0, -0.05], 32, 32)
    with pytest.raises(RangeError, match="parallel"):
        transport_lens(plate(), SUN, turned, spots())
