"""Curves go through their points at an even pace; frames do not twist."""

from __future__ import annotations

import numpy as np
import pytest
from photograd.scenes.curves import evenly_spaced, smooth_curve, untwisted_frames
from photograd_course.errors import RangeError, ShapeError

POINTS = np.array([[0.0, 0, 0], [1, 0.5, 0], [1.5, 2, 0.3], [0, 2.5, 1], [-1, 1, 0]])


def nearest(points: np.ndarray, curve: np.ndarray) -> np.ndarray:
    return np.linalg.norm(points[:, None] - curve, axis=-1).min(axis=1)


@pytest.mark.parametrize("closed", [False, True])
def test_a_smooth_curve_meets_its_points_evenly(closed: bool) -> None:
    curve = smooth_curve(POINTS, 2000, closed=closed)
    assert curve.shape == (2000, 3)
    steps = np.linalg.norm(np.diff(curve, axis=0), axis=1)
    # Between points 5 mm apart on a curve about 10 long; half a step is the most one can be off.
    assert nearest(POINTS, curve).max() < 0.6 * steps.max()
    # Steps are measured along a polyline of 32 pieces a span, whose corners shorten a few.
    assert steps.min() > 0.98 * steps.max()
    if closed:
        assert np.linalg.norm(curve[0] - curve[-1]) == pytest.approx(steps.mean(), rel=0.01)
    else:
        np.testing.assert_allclose(curve[[0, -1]], POINTS[[0, -1]], atol=1e-12)


def test_a_curve_through_points_of_a_line_is_the_line() -> None:
    line = np.outer(np.arange(5.0), [1.0, 2.0, 2.0])
    np.testing.assert_allclose(
        smooth_curve(line, 25), np.outer(np.linspace(0, 4, 25), [1, 2, 2]), atol=1e-12
    )


def test_a_point_given_twice_is_a_corner() -> None:
    corner = np.array([[0.0, 1], [1, 1], [1, 1], [1, 0]])
    curve = smooth_curve(corner, 201)
    assert nearest(np.array([[1.0, 1.0]]), curve)[0] < 1e-2
    np.testing.assert_allclose(np.abs(curve - [1.0, 1.0]).min(axis=1), 0.0, atol=1e-12)
    assert curve.max() <= 1.0, "the curve shoots over its corner"


@pytest.mark.parametrize("closed", [False, True])
def test_frames_are_orthonormal_and_change_little(closed: bool) -> None:
    curve = smooth_curve(POINTS, 300, closed=closed)
    tangents, normals = untwisted_frames(curve, closed=closed)
    for vectors in (tangents, normals):
        np.testing.assert_allclose(np.linalg.norm(vectors, axis=1), 1.0, atol=1e-12)
    np.testing.assert_allclose((tangents * normals).sum(axis=1), 0.0, atol=1e-12)
    following = np.roll(normals, -1, axis=0) if closed else normals[1:]
    agreement = (normals[: len(following)] * following).sum(axis=1)
    assert agreement.min() > np.cos(0.15)  # the sharpest bend of this curve turns 0.1 a step


def test_a_plane_curve_keeps_its_normal_out_of_plane() -> None:
    """Rotation minimizing: the component across the plane stays what it was at the start."""
    angle = np.linspace(0.0, 4.0, 200)
    arc = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=-1)
    _, normals = untwisted_frames(arc)
    np.testing.assert_allclose(normals[:, 2], normals[0, 2], atol=1e-10)


def test_impossible_curves_are_refused() -> None:
    with pytest.raises(ShapeError, match=r"smooth_curve: points: expected shape \(P, D\)"):
        smooth_curve(POINTS[:1], 10)
    with pytest.raises(RangeError, match="finite"):
        smooth_curve(POINTS * np.nan, 10)
    with pytest.raises(RangeError, match="count"):
        smooth_curve(POINTS, 1)
    with pytest.raises(RangeError, match="with a length"):
        evenly_spaced(np.ones((3, 2)), 4)
    with pytest.raises(ShapeError, match="untwisted_frames"):
        untwisted_frames(POINTS[:, :2])
