"""Strokes: unions of parts, joins and caps in closed form, the derivative of an area."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from photograd.vector import Drawing, Flattening, Rendering, Shape, Stroke, Subpath

from tests.vector.oracle import sampled, segment_distance

SIZE = (40, 40)
FINE = Flattening(segments=64, arc=128)


def drawn(path: Subpath, stroke: Stroke, flattening: Flattening = FINE) -> Rendering:
    return Rendering(Drawing.of([Shape((path,), stroke=stroke)]), SIZE, flattening=flattening)


LINE = Subpath.lines([[10.0, 12], [26, 24]])  # of length 20


@pytest.mark.parametrize(
    ("cap", "area", "by_width"),
    [
        ("butt", 20 * 4.0, 20),
        ("square", 24 * 4.0, 20 + 2 * 4.0),
        ("round", 20 * 4.0 + 4 * np.pi, 20 + 2 * np.pi),
    ],
)
def test_caps(cap: Any, area: float, by_width: float) -> None:
    rendering = drawn(LINE, Stroke(4.0, cap))
    assert rendering.coverage(0).sum() == pytest.approx(area, rel=1e-3)
    d = rendering.coverage_backward(0, np.ones(SIZE)).widths[0]
    assert d == pytest.approx(by_width, rel=1e-3)


CORNER = Subpath.lines([[5.0, 30], [25, 30], [25, 10]])
BOTH_ARMS = 2 * 20 * 6.0 - 9  # they overlap in a square of 3 x 3


@pytest.mark.parametrize(
    ("join", "limit", "wedge"),
    [
        ("bevel", 4.0, 4.5),
        ("miter", 4.0, 9.0),
        ("miter", 1.42, 9.0),  # sqrt(2) is the ratio of a right angle
        ("miter", 1.41, 4.5),
        ("round", 4.0, 9 * np.pi / 4),
    ],
)
def test_joins(join: Any, limit: float, wedge: float) -> None:
    rendering = drawn(CORNER, Stroke(6.0, "butt", join, limit))
    assert rendering.coverage(0).sum() == pytest.approx(BOTH_ARMS + wedge, rel=1e-4)


def test_the_area_of_a_ring_grows_by_its_perimeter() -> None:
    rendering = drawn(Subpath.circle((20, 20), 12), Stroke(5.0))
    perimeter = 2 * np.pi * 12
    assert rendering.coverage(0).sum() == pytest.approx(5 * perimeter, rel=1e-3)
    d = rendering.coverage_backward(0, np.ones(SIZE)).widths[0]
    assert d == pytest.approx(perimeter, rel=1e-3)


def test_the_area_of_a_disk_grows_by_its_perimeter() -> None:
    points = Subpath.circle((0, 0), 1.0).points
    path = Subpath(20.3 + 11.0 * points, (3, 3, 3, 3), closed=True)
    rendering = Rendering(Drawing.of([Shape((path,))]), SIZE, flattening=FINE)
    d = rendering.coverage_backward(0, np.ones(SIZE)).points
    assert (d * points).sum() == pytest.approx(2 * np.pi * 11, rel=1e-3)


@pytest.mark.parametrize("seed", range(4))
def test_round_strokes_are_the_points_near_the_path(seed: int) -> None:
    """However sharp the turns and short the segments are: a union, without holes."""
    points = np.random.default_rng(seed).uniform(8, 32, (9, 2))
    points[4] = points[3] + 0.4  # shorter than the width
    width = 5.0

    def inside(at: Any) -> Any:
        pairs = pairwise(points)
        return np.min([segment_distance(at, a, b) for a, b in pairs], axis=0) < width / 2

    found = drawn(Subpath.lines(points), Stroke(width, "round", "round")).coverage(0)
    np.testing.assert_allclose(found, sampled(inside, SIZE, 16), atol=0.04)
    assert found.sum() == pytest.approx(sampled(inside, SIZE, 16).sum(), rel=1e-3)


def test_a_tight_bend_has_no_hole() -> None:
    """The offset curve of the inner side turns around; the stroke does not."""
    path = Subpath([[8.0, 30], [19, 2], [21, 2], [32, 30]], (3,))
    found = drawn(path, Stroke(12.0, "round", "round"), Flattening(segments=32)).coverage(0)
    y, x = np.mgrid[:40, :40] + 0.5
    t = np.linspace(0, 1, 2001)[:, None]
    weights = np.hstack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3])
    curve = weights @ path.points
    at = np.stack([x.ravel(), y.ravel()], axis=1)
    distance = np.linalg.norm(at[:, None] - curve[None], axis=2).min(axis=1).reshape(SIZE)
    assert (found[distance < 5.1] > 0.999).all()
    assert (found[distance > 6.9] < 1e-3).all()


def test_the_way_back_over_itself_is_drawn_once() -> None:
    there = drawn(Subpath.lines([[10.0, 20], [30, 20]]), Stroke(4.0, "butt", "bevel")).coverage(0)
    back = Subpath.lines([[10.0, 20], [30, 20], [10, 20]])
    np.testing.assert_allclose(drawn(back, Stroke(4.0, "butt", "bevel")).coverage(0), there)


@pytest.mark.parametrize("path", [[[5.0, 5], [5, 5]], [[7.0, 7]], []])
def test_a_path_without_length_draws_nothing(path: Any) -> None:
    points = np.array(path, float).reshape(-1, 2)
    closed = not len(points)
    subpath = Subpath(points, (1,) * (len(points) - (not closed)), closed)
    rendering = drawn(subpath, Stroke(3.0, "round"))
    assert not rendering.picture.any()
    assert not rendering.coverage_backward(0, np.ones(SIZE)).points.any()


def test_no_width_draws_nothing_and_has_no_derivative() -> None:
    rendering = drawn(LINE, Stroke(0.0, "round"))
    assert not rendering.picture.any()
    found = rendering.backward(np.ones((*SIZE, 4))).parameters
    assert not any(array.any() for array in found.arrays().values())


def test_points_at_one_place_count_once() -> None:
    once = drawn(Subpath.lines([[5.0, 8], [20, 30], [33, 9]]), Stroke(5.0))
    twice = drawn(Subpath.lines([[5.0, 8], [20, 30], [20, 30], [33, 9]]), Stroke(5.0))
    np.testing.assert_array_equal(once.coverage(0), twice.coverage(0))
