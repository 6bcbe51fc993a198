"""Where Gaussians begin."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd import sh
from photograd.capture.bounds import estimate_bounds
from photograd.capture.capture import Capture
from photograd.errors import RangeError
from photograd.splats.start import (
    RANDOM_DISTANCE,
    around,
    mean_colors,
    neighbor_distance,
    random_points,
    start_gaussians,
)

from tests.splats.scene import COLOR, ball_capture


def test_distance_to_neighbors_is_that_of_all_pairs() -> None:
    points = np.random.default_rng(1).normal(size=(1500, 3)) + 100.0
    away = np.linalg.norm(points[:, None] - points, axis=2)
    nearest = np.sort(away, axis=1)[:, 1:4]
    np.testing.assert_allclose(
        neighbor_distance(points), np.sqrt((nearest**2).mean(axis=1)), rtol=1e-6
    )


def test_few_and_coinciding_points_get_a_size_too() -> None:
    for points in (np.zeros((1, 3)), np.zeros((9, 3)), np.eye(3), np.ones((2, 3))):
        size = neighbor_distance(points)
        assert size.shape == (len(points),)
        assert (size > 0).all()


def test_the_distance_of_random_points_has_a_closed_form() -> None:
    points = np.random.default_rng(2).uniform(size=(20_000, 3))
    inner = ((points > 0.1) & (points < 0.9)).all(axis=1)
    measured = np.sqrt((neighbor_distance(points)[inner] ** 2).mean())
    # 2.4e4 numbers, of which each varies by about a quarter.
    assert measured == pytest.approx(RANDOM_DISTANCE * np.cbrt(1 / 20_000), rel=0.01)


def test_random_points_fill_the_hull_and_nothing_else() -> None:
    capture = ball_capture()
    box = estimate_bounds(capture).box
    points, volume, rule = random_points(capture, box, 3000, seed=4)
    assert points.shape == (3000, 3)
    assert "silhouettes" in rule
    radius = np.linalg.norm(points, axis=1)
    assert radius.max() < 0.75  # the ball of 0.5 and what twelve silhouettes leave around it
    # The hull is larger than the ball, 3000 of about 8000 points fall into it: measured 4 % more.
    assert volume == pytest.approx(4 / 3 * np.pi * 0.5**3, rel=0.1)
    again, _, _ = random_points(capture, box, 3000, seed=4)
    np.testing.assert_array_equal(points, again)


def test_without_alpha_the_whole_box_is_filled() -> None:
    capture = replace(ball_capture(), has_alpha=False)
    box = np.array([[-1.0, -2, -3], [1, 2, 3]])
    points, volume, rule = random_points(capture, box, 2000, seed=5)
    assert volume == pytest.approx(48)
    assert "of the box" in rule
    assert (points.min(axis=0) < 0.98 * box[0]).all()
    assert (points.max(axis=0) > 0.98 * box[1]).all()


def test_colors_are_those_of_the_pixels() -> None:
    capture = ball_capture()
    found = mean_colors(capture.train, np.array([[0.0, 0, 0], [0.0, 90, 0]]))
    np.testing.assert_allclose(found[0] / found[0, 0], [1, 0.5, 0.25], rtol=1e-5)
    assert 0.8 * COLOR[0] <= found[0, 0] <= 1.2 * COLOR[0]  # between the two stripes
    np.testing.assert_array_equal(found[1], 0.5)  # no view shows it


def with_points(count: int) -> Capture:
    g = np.random.default_rng(6)
    return replace(
        ball_capture(),
        points=g.normal(size=(count, 3)),
        point_colors=g.integers(0, 256, (count, 3), dtype=np.uint8),
    )


def test_sparse_points_are_taken_with_their_colors() -> None:
    capture = with_points(300)
    assert capture.points is not None
    assert capture.point_colors is not None
    gaussians, rule = start_gaussians(capture, np.eye(3)[:2], 500, degree=2, seed=0)
    assert rule == "300 of the 300 points of the capture"
    np.testing.assert_allclose(gaussians.means, capture.points, rtol=1e-6)
    drawn = 0.5 + sh.Y_0 * gaussians.sh[:, 0]
    np.testing.assert_allclose(drawn, capture.point_colors / 255, atol=1e-6)
    assert not gaussians.sh[:, 1:].any()
    few, rule = start_gaussians(capture, np.eye(3)[:2], 200, degree=0, seed=0)
    assert len(few) == 200
    assert rule == "200 of the 300 points of the capture"
    assert {tuple(p) for p in few.means} < {tuple(p) for p in gaussians.means}


def test_too_few_points_are_not_believed() -> None:
    capture = with_points(20)
    _, rule = start_gaussians(capture, estimate_bounds(capture).box, 50, degree=0, seed=0)
    assert "random points" in rule


@pytest.mark.parametrize(("count", "degree", "words"), [(0, 1, "at least 1"), (5, 7, "degree")])
def test_nonsense_is_refused(count: int, degree: int, words: str) -> None:
    with pytest.raises(RangeError, match=words):
        start_gaussians(with_points(200), np.eye(3)[:2], count, degree=degree, seed=0)


def test_gaussians_begin_round_and_faint() -> None:
    g: Any = around(np.zeros((2, 3)), np.array([0.1, 0.2]), np.full((2, 3), 0.7), degree=1)
    np.testing.assert_allclose(np.exp(g.log_scales), [[0.1] * 3, [0.2] * 3], rtol=1e-6)
    np.testing.assert_allclose(1 / (1 + np.exp(-g.opacity_logits)), 0.1, rtol=1e-6)
