"""Areas: exact polygons, fill rules, overlaps, what leaves the picture."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from photograd.raster import polygon_coverage, polygon_coverage_backward
from photograd.vector import Drawing, Rendering, Shape, Subpath, render

from tests.vector.oracle import polygon, sampled, windings

SIZE = (10, 11)
G = np.random.default_rng(1)


def coverage(points: Any, size: tuple[int, int] = SIZE, **shape: Any) -> Any:
    return Rendering(Drawing.of([polygon(points, **shape)]), size).coverage(0)


@pytest.mark.parametrize("seed", range(6))
def test_a_simple_polygon_agrees_with_clipping_and_so_does_its_derivative(seed: int) -> None:
    rng = np.random.default_rng(seed)
    turns = np.sort(rng.uniform(0, 2 * np.pi, 7))
    radii = rng.uniform(2, 8, 7)
    points = 5 + radii[:, None] * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    if seed == 0:
        points = np.array([[1.3, 2.2], [7.1, 2.2], [7.1, 6.4], [1.3, 6.4]])  # along the axes
    d = rng.uniform(-1, 1, SIZE)
    rendering = Rendering(Drawing.of([polygon(points)]), SIZE)
    np.testing.assert_allclose(
        rendering.coverage(0), np.abs(polygon_coverage(points, SIZE)), atol=1e-13
    )
    sign = np.sign(polygon_coverage(points, SIZE).sum())
    np.testing.assert_allclose(
        rendering.coverage_backward(0, d).points,
        sign * polygon_coverage_backward(points, d),
        atol=1e-12,
    )


@pytest.mark.parametrize("rule", ["nonzero", "evenodd"])
@pytest.mark.parametrize("seed", range(3))
def test_polygons_that_cross_themselves_agree_with_many_samples(rule: Any, seed: int) -> None:
    points = np.random.default_rng(seed).uniform(-3, 14, (9, 2))

    def inside(at: Any) -> Any:
        found = windings(points, at)
        return found != 0 if rule == "nonzero" else found % 2 == 1

    np.testing.assert_allclose(coverage(points, rule=rule), sampled(inside, SIZE, 48), atol=0.006)


SQUARE = np.array([[1.0, 1], [9, 1], [9, 9], [1, 9]])
HOLE = np.array([[3.0, 3], [7, 3], [7, 7], [3, 7]])


@pytest.mark.parametrize(
    ("inner", "rule", "hole"),
    [
        (HOLE, "nonzero", 1.0),
        (HOLE[::-1], "nonzero", 0.0),
        (HOLE, "evenodd", 0.0),
        (HOLE[::-1], "evenodd", 0.0),
    ],
)
def test_fill_rules(inner: Any, rule: Any, hole: float) -> None:
    paths = tuple(Subpath.lines(each, closed=True) for each in (SQUARE, inner))
    found = Rendering(Drawing.of([Shape(paths, rule=rule)]), SIZE).coverage(0)
    assert found[5, 5] == hole
    assert found[1, 1] == found[8, 8] == 1
    assert found.sum() == pytest.approx(64 if hole else 48, rel=1e-14)


def test_a_contour_that_winds_twice() -> None:
    twice = np.concatenate([SQUARE, SQUARE])
    assert coverage(twice).sum() == pytest.approx(64)
    assert coverage(twice, rule="evenodd").sum() == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("rule", ["nonzero", "evenodd"])
def test_the_hole_of_a_star(rule: Any) -> None:
    turns = np.arange(5) * 4 * np.pi / 5
    star = 5.5 + 4 * np.stack([np.sin(turns), -np.cos(turns)], axis=1)
    hole = 1 if rule == "nonzero" else 0
    assert coverage(star, rule=rule)[5, 5] == pytest.approx(hole, abs=1e-15)


def test_a_half_plane_in_closed_form() -> None:
    """It moves by one pixel along x: area and derivative of each row."""
    for x in (3.0, 3.25, 3.9):
        points = np.array([[-20.0, -20], [x, -20], [x, 40], [-20, 40]])
        rendering = Rendering(Drawing.of([polygon(points)]), SIZE)
        np.testing.assert_allclose(rendering.coverage(0).sum(axis=1), x)
        d = rendering.coverage_backward(0, np.ones(SIZE)).points
        np.testing.assert_allclose(d[1:3, 0].sum(), SIZE[0])
        np.testing.assert_allclose(d[:, 1], 0, atol=1e-12)


def test_a_horizontal_edge_has_its_derivative() -> None:
    for y in (4.0, 4.4):
        points = np.array([[-20.0, y], [50, y], [50, 40], [-20, 40]])
        rendering = Rendering(Drawing.of([polygon(points)]), SIZE)
        assert rendering.coverage(0).sum() == pytest.approx(SIZE[1] * (SIZE[0] - y))
        d = rendering.coverage_backward(0, np.ones(SIZE)).points
        assert d[:2, 1].sum() == pytest.approx(-SIZE[1])


def test_what_leaves_the_picture_is_cut_off() -> None:
    points = G.uniform(-30, 40, (8, 2))
    larger = coverage(points + 40, (90, 91))
    np.testing.assert_allclose(coverage(points), larger[40:50, 40:51], atol=1e-12)
    huge = np.array([[-1e6, -1e6], [1e6, -1e6], [1e6, 1e6], [-1e6, 1e6]])
    assert (coverage(huge) == 1).all()


def test_a_fan_of_crossing_edges_stays_exact() -> None:
    """Edges that almost touch: cuts at one point, areas that still sum up."""
    turns = np.linspace(0, np.pi, 12, endpoint=False)
    ends = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    spokes = [
        Subpath.lines([(5.5, 5.0), (5.5, 5.0) + 4 * a, (5.5, 5.0) + 4 * b], closed=True)
        for a, b in pairwise(ends)
    ]
    found = Rendering(Drawing.of([Shape(tuple(spokes))]), SIZE).coverage(0)
    area = 11 * 8 * np.sin(np.pi / 12)
    assert found.sum() == pytest.approx(area, rel=1e-12)


def test_an_empty_drawing_is_the_background() -> None:
    behind = (0.1, 0.2, 0.3, 0.4)
    for shapes in ([], [Shape(())], [Shape((Subpath(np.zeros((1, 2)), ()),))]):
        found = render(Drawing.of(shapes), (3, 4), background=behind)
        np.testing.assert_array_equal(found, np.broadcast_to(behind, (3, 4, 4)))
