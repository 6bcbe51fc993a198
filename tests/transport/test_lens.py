"""The thin lens: how far a point is spread, what stays sharp, and what stays as it was."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.transport import Lens, PathOptions, PathTracer, Scene, SphereShape
from photograd.transport.builtin import cornell_box

from tests.transport.scenes import BLACK, view

DEPTH, RADIUS, SIZE, BALL = 3.0, 0.4, 24, 0.05


def spread(lens: Lens) -> tuple[float, float, Any]:
    """Second moments in pixels (columns, rows) of a small ball's picture, and the picture."""
    ball = SphereShape("ball", np.zeros(3), BALL, "black", np.ones(3))
    camera = view(SIZE, (0.0, 0.0, DEPTH), (0.0, 0.0, 0.0))
    scene = Scene("point", (ball,), {"black": BLACK}, camera, lens=lens)
    picture = PathTracer(scene).render(spp=2048, seed=1, options=PathOptions(max_depth=1)).mean
    weight = picture[..., 0] / picture[..., 0].sum()
    at = np.arange(SIZE) + 0.5 - SIZE / 2
    return float(weight.sum(axis=0) @ at**2), float(weight.sum(axis=1) @ at**2), picture[..., 0]


@pytest.mark.parametrize("focus", [1.6, 10.0])
def test_a_point_becomes_the_circle_of_confusion(focus: float) -> None:
    focal = SIZE / 2 / np.tan(np.radians(20.0))
    circle = focal * RADIUS * abs(1 / focus - 1 / DEPTH)
    # Of a uniform disc the second moment along an axis is a quarter of its radius squared; the ball
    # is one too, and pixels are squares of 1/12.
    own = 0.25 * (focal * BALL / DEPTH) ** 2 + 1 / 12
    x, y, picture = spread(Lens(RADIUS, focus))
    for found in (x, y):
        # 2000 samples hit it: an error of 2.3 %.
        assert found == pytest.approx(0.25 * circle**2 + own, rel=0.09)
    column, row = np.meshgrid(np.arange(SIZE) - 11.5, np.arange(SIZE) - 11.5)
    assert picture[np.hypot(column, row) > circle + 1.6].max() == 0


def test_what_is_in_focus_is_sharp() -> None:
    _, _, picture = spread(Lens(RADIUS, DEPTH))
    assert picture[11:13, 11:13].sum() > 0.9
    assert picture[11:13, 11:13].sum() == pytest.approx(picture.sum(), rel=1e-6)


def test_no_lens_is_a_pinhole() -> None:
    scene = cornell_box(12)
    plain = PathTracer(scene).render(spp=4, seed=1).radiance
    far = PathTracer(replace(scene, lens=Lens(0.0, 9.0))).render(spp=4, seed=1).radiance
    np.testing.assert_array_equal(plain, far)
    blurred = PathTracer(replace(scene, lens=Lens(0.3, 6.8))).render(spp=4, seed=1).radiance
    assert np.abs(plain - blurred).max() > 0.1


def test_wrong_lenses_are_refused() -> None:
    for radius, focus, words in (
        (-1.0, 1.0, "radius"),
        (0.1, 0.0, "focus"),
        (np.inf, 1.0, "radius"),
    ):
        with pytest.raises(RangeError, match=words):
            Lens(radius, focus)
