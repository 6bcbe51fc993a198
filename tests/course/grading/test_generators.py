"""Inputs that several assignments draw from: lengths, ranges, integrals with known values."""

from __future__ import annotations

import numpy as np
import pytest
from photograd_course.grading.generators import (
    cell_centers,
    hemisphere_quadrature,
    random_rotation,
    unit_vectors,
    upper_directions,
)


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(8)


def test_unit_vectors_cover_the_sphere(rng: np.random.Generator) -> None:
    v = unit_vectors(rng, 20_000)
    np.testing.assert_allclose(np.linalg.norm(v, axis=1), 1.0, atol=1e-15)
    np.testing.assert_allclose(v.mean(axis=0), 0.0, atol=0.02)
    np.testing.assert_allclose(v.T @ v / len(v), np.eye(3) / 3, atol=0.02)
    assert unit_vectors(rng, 0).shape == (0, 3)


@pytest.mark.parametrize("up", [0, 1, 2])
def test_upper_directions_lie_above_their_plane(rng: np.random.Generator, up: int) -> None:
    v = upper_directions(rng, 20_000, 0.25, up)
    np.testing.assert_allclose(np.linalg.norm(v, axis=1), 1.0, atol=1e-15)
    assert 0.25 <= v[:, up].min() < 0.26
    assert v[:, up].mean() == pytest.approx(0.625, abs=0.01)
    np.testing.assert_allclose(np.delete(v, up, axis=1).mean(axis=0), 0.0, atol=0.02)


def test_rotations_are_proper(rng: np.random.Generator) -> None:
    many = np.stack([random_rotation(rng) for _ in range(500)])
    np.testing.assert_allclose(
        many @ many.swapaxes(1, 2), np.tile(np.eye(3), (500, 1, 1)), atol=1e-14
    )
    np.testing.assert_allclose(np.linalg.det(many), 1.0, atol=1e-14)
    np.testing.assert_allclose(many.mean(axis=0), 0.0, atol=0.1)


@pytest.mark.parametrize("up", [1, 2])
def test_the_quadrature_integrates_over_half_a_sphere(up: int) -> None:
    directions, solid_angles = hemisphere_quadrature(24, 32, up)
    height = directions[:, up]
    assert solid_angles.sum() == pytest.approx(2 * np.pi, rel=1e-13)
    assert solid_angles @ height == pytest.approx(np.pi, rel=1e-13)
    assert solid_angles @ height**2 == pytest.approx(2 * np.pi / 3, rel=1e-13)
    level = np.delete(directions, up, axis=1)
    np.testing.assert_allclose(solid_angles @ level, 0.0, atol=1e-14)


def test_cell_centers_follow_the_memory_of_a_grid() -> None:
    centers = cell_centers((2, 3))
    assert centers.shape == (6, 2)
    np.testing.assert_allclose(centers[1], [0.25, 0.5])
    grid = (centers @ [10.0, 1.0]).reshape(2, 3)
    np.testing.assert_allclose(grid[1, 2], 7.5 + 2.5 / 3)
