"""Chromatic aberration and vignetting: what they leave alone, and their formulas."""

from __future__ import annotations

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.frame import chromatic_aberration, vignette

from tests.frame import scenes

pytestmark = pytest.mark.usefixtures("core")
PICTURE = np.random.default_rng(0).uniform(0, 2, (64, 96, 3))


def test_green_and_a_strength_of_zero_change_nothing() -> None:
    np.testing.assert_array_equal(chromatic_aberration(PICTURE, 0.0), PICTURE)
    found = chromatic_aberration(PICTURE, 0.05)
    np.testing.assert_array_equal(found[..., 1], PICTURE[..., 1])
    assert (found[..., 0] != PICTURE[..., 0]).any()
    np.testing.assert_array_equal(vignette(PICTURE, scenes.camera(), 0.0), PICTURE)


def test_a_ramp_is_scaled_about_the_center() -> None:
    x = np.arange(96) + 0.5 - 48
    ramp = np.repeat(np.repeat(x[None, :, None], 8, axis=0), 3, axis=2) + 100.0
    found = chromatic_aberration(ramp, 0.1)[4, 8:-8]
    np.testing.assert_allclose(found[:, 0], x[8:-8] / 1.1 + 100, rtol=1e-12)
    # The last pixels of blue come from beyond the border.
    np.testing.assert_allclose(found[:, 2], np.clip(x[8:-8] / 0.9, -47.5, 47.5) + 100, rtol=1e-12)


def test_light_falls_with_the_fourth_power_of_the_cosine() -> None:
    camera = scenes.camera()
    found = vignette(np.ones((64, 96, 3)), camera)
    axis = camera.forward
    cosine = (camera.rays()[1] @ axis).reshape(64, 96)
    np.testing.assert_allclose(found[..., 1], cosine**4, rtol=1e-12)


def test_other_sizes_and_numbers_are_refused() -> None:
    with pytest.raises(ShapeError, match="vignette: color"):
        vignette(PICTURE[:5], scenes.camera())
    with pytest.raises(RangeError, match="chromatic_aberration: strength"):
        chromatic_aberration(PICTURE, 0.5)
