"""Polylines for curves: their error falls with the square of the number; the exact distance."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.vector import (
    Drawing,
    Flattening,
    Rendering,
    Shape,
    Stroke,
    Subpath,
    curve_distance,
    curve_distance_backward,
    distance_stroke,
)
from photograd.vector.flatten import Polylines, bernstein
from photograd_course.gradcheck import check_gradient

CONTROL = {
    1: np.array([[6.0, 7], [33, 28]]),
    2: np.array([[6.0, 7], [38, 4], [31, 33]]),
    3: np.array([[6.0, 9], [44, 1], [-7, 22], [33, 34]]),
}
SIZE = (40, 40)


def stroke_coverage(degree: int, width: float, **options: Any) -> Any:
    path = Subpath(CONTROL[degree], (degree,))
    shape = Shape((path,), stroke=Stroke(width, "round", "round"))
    return Rendering(Drawing.of([shape]), SIZE, flattening=Flattening(**options)).coverage(0)


@pytest.mark.parametrize("degree", [2, 3])
@pytest.mark.parametrize("what", ["fill", "stroke"])
def test_the_error_of_a_polyline_falls_with_the_square(degree: int, what: str) -> None:
    def coverage(segments: int) -> Any:
        stroke = Stroke(4.0, "butt", "round") if what == "stroke" else None
        shape = Shape((Subpath(CONTROL[degree], (degree,)),), stroke=stroke)
        flattening = Flattening(segments=segments)
        return Rendering(Drawing.of([shape]), SIZE, flattening=flattening).coverage(0)

    exact = coverage(1024)
    errors = [np.abs(coverage(n) - exact).sum() for n in (8, 16, 32, 64)]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert np.all(np.abs(orders - 2) < 0.35), orders


@pytest.mark.parametrize("degree", [2, 3])
@pytest.mark.parametrize("tolerance", [1.0, 0.1, 0.01])
def test_a_tolerance_holds(degree: int, tolerance: float) -> None:
    drawing = Drawing.of([Shape((Subpath(CONTROL[degree], (degree,)),))])
    points = drawing.parameters.points
    lines = Polylines.of(drawing.layout, points, Flattening(tolerance=tolerance))
    t = np.linspace(0, 1, 3001)
    curve = bernstein(np.full(len(t), degree), t)[:, : degree + 1] @ CONTROL[degree]
    line = lines.vertices(points)
    ends = np.linspace(0, 1, len(line))
    off = np.hypot(*(curve - np.stack([np.interp(t, ends, x) for x in line.T], axis=1)).T)
    assert 0.02 * tolerance < off.max() <= tolerance


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_distances_agree_with_a_fine_polyline(degree: int) -> None:
    points = np.random.default_rng(1).uniform(-5, 45, (200, 2))
    t = np.linspace(0, 1, 20001)
    curve = bernstein(np.full(len(t), degree), t)[:, : degree + 1] @ CONTROL[degree]
    found, where = curve_distance(CONTROL[degree], points)
    slow = [np.hypot(*(curve - p).T).min() for p in points]
    np.testing.assert_allclose(found, slow, atol=1e-4)
    at = bernstein(np.full(200, degree), where)[:, : degree + 1] @ CONTROL[degree]
    np.testing.assert_allclose(np.hypot(*(at - points).T), found, rtol=1e-12)


def test_a_cubic_that_is_a_line_has_the_distances_of_a_line() -> None:
    points = np.random.default_rng(2).uniform(0, 40, (50, 2))
    a, b = CONTROL[1]
    thirds = np.array([a, a + (b - a) / 3, a + 2 * (b - a) / 3, b])
    found = curve_distance(thirds, points)[0]
    np.testing.assert_allclose(found, curve_distance(CONTROL[1], points)[0], atol=1e-9)


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_the_derivative_of_distances(degree: int) -> None:
    points = np.random.default_rng(3).uniform(0, 40, (30, 2))
    report = check_gradient(
        lambda p: curve_distance(p["control"], points)[0],
        lambda p, d: {"control": curve_distance_backward(p["control"], points, d)},
        {"control": CONTROL[degree]},
        seed=1,
    )
    assert report, str(report)


def test_two_ways_to_a_stroke_agree() -> None:
    """The ramp over the distance is an estimate: up to a quarter of a pixel off, 1 % in sum."""
    area, ramp = stroke_coverage(3, 5.0), distance_stroke(CONTROL[3], 5.0, SIZE)
    assert np.abs(area - ramp).max() < 0.25
    assert area.sum() == pytest.approx(ramp.sum(), rel=0.01)
    along = stroke_coverage(1, 5.0)
    assert np.abs(along - distance_stroke(CONTROL[1], 5.0, SIZE)).max() < 0.25
