"""Painter's order, alpha, gradients: by hand."""

from __future__ import annotations

import numpy as np
import pytest
from photograd.vector import Drawing, LinearGradient, RadialGradient, Solid, render

from tests.vector.oracle import polygon

FULL = np.array([[-1.0, -1], [9, -1], [9, 9], [-1, 9]])
LEFT = np.array([[-1.0, -1], [2.5, -1], [2.5, 9], [-1, 9]])


def test_the_later_shape_lies_over_the_earlier_premultiplied() -> None:
    under = polygon(FULL, paint=Solid((1, 0, 0), 0.5), opacity=0.8)
    over = polygon(LEFT, paint=Solid((0, 1, 0.5), 0.5))
    found = render(Drawing.of([under, over]), (3, 5))
    np.testing.assert_allclose(found[0, 4], [0.4, 0, 0, 0.4])
    np.testing.assert_allclose(found[0, 0], [0.2, 0.5, 0.25, 0.7])
    np.testing.assert_allclose(found[0, 2], [0.3, 0.25, 0.125, 0.55])  # half of the pixel
    swapped = render(Drawing.of([over, under]), (3, 5))
    np.testing.assert_allclose(swapped[0, 0], [0.4, 0.3, 0.15, 0.7])


def test_the_background_shows_through() -> None:
    over = polygon(FULL, paint=Solid((0, 0, 1), 0.25))
    found = render(Drawing.of([over]), (1, 1), background=(0.5, 0.5, 0, 1))
    np.testing.assert_allclose(found[0, 0], [0.375, 0.375, 0.25, 1])


def test_a_linear_gradient_along_x() -> None:
    colors = np.array([[1.0, 0, 0, 1], [0, 0, 1, 1]])
    paint = LinearGradient((1, 7), (5, 7), np.array([0.0, 1.0]), colors)
    row = render(Drawing.of([polygon(FULL, paint=paint)]), (1, 8))[0]
    share = np.clip((np.arange(8) + 0.5 - 1) / 4, 0, 1)
    np.testing.assert_allclose(row[:, 2], share)
    np.testing.assert_allclose(row[:, 0], 1 - share)


def test_a_radial_gradient() -> None:
    colors = np.array([[1.0, 1, 1, 1], [0, 0, 0, 1]])
    paint = RadialGradient((4, 4), 3.0, np.array([0.0, 1.0]), colors)
    found = render(Drawing.of([polygon(FULL, paint=paint)]), (8, 8))[..., 0]
    y, x = np.mgrid[:8, :8] + 0.5
    np.testing.assert_allclose(found, 1 - np.clip(np.hypot(x - 4, y - 4) / 3, 0, 1), atol=1e-12)


@pytest.mark.parametrize("kind", ["line", "circle"])
def test_a_gradient_without_extent_is_its_last_color(kind: str) -> None:
    stops = np.array([0.0, 1.0]), np.array([[1.0, 0, 0, 1], [0, 1, 0, 1]])
    paint = (
        LinearGradient((3, 3), (3, 3), *stops)
        if kind == "line"
        else RadialGradient((3, 3), 0.0, *stops)
    )
    found = render(Drawing.of([polygon(FULL, paint=paint)]), (4, 4))
    np.testing.assert_array_equal(found, np.broadcast_to([0, 1, 0, 1], (4, 4, 4)))


def test_two_stops_at_one_offset_make_an_edge() -> None:
    colors = np.array([[1.0, 0, 0, 1], [1, 0, 0, 1], [0, 1, 0, 1], [0, 1, 0, 1]])
    paint = LinearGradient((0, 0), (8, 0), np.array([0.0, 0.5, 0.5, 1.0]), colors)
    row = render(Drawing.of([polygon(FULL, paint=paint)]), (1, 8))[0]
    np.testing.assert_array_equal(row[:, 0], [1, 1, 1, 1, 0, 0, 0, 0])
