"""Exact coverage: areas, and derivatives in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.raster import polygon_coverage, polygon_coverage_backward
from photograd_course.gradcheck import check_gradient, taylor_slope

SIZE = (7, 9)
TRIANGLE = np.array([[1.3, 0.8], [7.6, 2.1], [3.2, 6.4]])
STAR = np.array(
    [[4.5, 0.3], [5.4, 2.8], [8.1, 3.1], [5.9, 4.3], [6.7, 6.6], [4.4, 5.2], [1.2, 6.1]]
)


def shoelace(points: Any) -> float:
    x, y = points.T
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2)


@pytest.mark.parametrize("points", [TRIANGLE, STAR], ids=["triangle", "star"])
def test_areas_add_up(points: Any) -> None:
    coverage = polygon_coverage(points, SIZE)
    assert (coverage >= -1e-12).all()
    assert (coverage <= 1 + 1e-12).all()
    assert coverage.max() == 1
    assert coverage.sum() == pytest.approx(shoelace(points))
    np.testing.assert_allclose(polygon_coverage(points[::-1], SIZE), -coverage, atol=1e-12)


@pytest.mark.parametrize("points", [TRIANGLE, STAR, TRIANGLE * 2 - 3], ids=["in", "star", "cut"])
def test_backward_agrees_with_central_differences(points: Any) -> None:
    def forward(p: dict[str, Any]) -> Any:
        return polygon_coverage(p["points"], SIZE)

    def backward(p: dict[str, Any], d: Any) -> dict[str, Any]:
        return {"points": polygon_coverage_backward(p["points"], d)}

    place = {"points": points}
    report = check_gradient(forward, backward, place, seed=3)
    assert report, str(report)
    slope = taylor_slope(forward, backward, place, seed=3)
    assert slope, str(slope)


def test_a_half_plane_in_closed_form() -> None:
    """x cos(a) + y sin(a) < d over one pixel: d moves the area by the length of the edge."""
    a, d = 0.4, 0.75
    normal, along = np.array([np.cos(a), np.sin(a)]), np.array([-np.sin(a), np.cos(a)])
    corners = [d * normal + 9 * along, (d - 9) * normal + 9 * along]
    corners += [(d - 9) * normal - 9 * along, d * normal - 9 * along]
    points = np.array(corners)
    # The edge enters the pixel through its top and leaves it through its left or its bottom side.
    at_top, at_bottom = d / np.cos(a), (d - np.sin(a)) / np.cos(a)
    assert 0 < at_bottom < at_top < 1
    coverage = polygon_coverage(points, (1, 1))
    assert coverage[0, 0] == pytest.approx((at_top + at_bottom) / 2, abs=1e-12)
    d_points = polygon_coverage_backward(points, [[1.0]])
    by_d = (d_points[[0, 3]] @ normal).sum()
    assert by_d == pytest.approx(1 / np.cos(a), rel=1e-6)  # the length of the edge in the pixel


def test_a_sample_jumps_where_coverage_does_not() -> None:
    shifts = np.linspace(0, 1, 11) + 0.013
    covered, sampled = [], []
    for shift in shifts:
        points = np.array([[-1.0, -1], [shift, -1], [shift, 2], [-1, 2]])
        covered.append(polygon_coverage(points, (1, 1))[0, 0])
        sampled.append(float(shift > 0.5))
    np.testing.assert_allclose(covered, np.minimum(shifts, 1))
    assert sorted(set(np.diff(sampled))) == [0, 1]


def test_bad_input_is_named() -> None:
    with pytest.raises(ShapeError, match=r"polygon_coverage: points"):
        polygon_coverage([[0.0, 0.0], [1.0, 1.0]], (2, 2))
    with pytest.raises(RangeError, match=r"polygon_coverage: points"):
        polygon_coverage([[0.0, 0.0], [1.0, np.nan], [1, 0]], (2, 2))
