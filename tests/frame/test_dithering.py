"""Dithering keeps the mean, and shows gradients where rounding shows bands."""

from __future__ import annotations

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.frame import FrameOptions, FrameScene, dither, frame_graph
from photograd_course.color import srgb_encode

from tests.frame import scenes


def test_without_noise_it_is_rounding() -> None:
    picture = np.random.default_rng(1).uniform(0, 1, (9, 8, 3))
    np.testing.assert_allclose(dither(picture, strength=0), np.floor(picture * 255 + 0.5) / 255)
    np.testing.assert_array_equal(dither(np.ones((2, 2, 3)), strength=0), 1.0)


@pytest.mark.parametrize("value", [0.2371, 0.5, 0.7003])
def test_the_mean_and_the_spread_do_not_depend_on_the_color(value: float) -> None:
    steps = 255 * dither(np.full((200, 200, 3), value)) - 255 * value
    assert abs(steps.mean()) < 4 * 0.5 / np.sqrt(steps.size)
    assert steps.var() == pytest.approx(0.25, rel=0.03)


def test_the_seed_decides() -> None:
    picture = np.full((20, 20, 3), 0.4, np.float32)
    np.testing.assert_array_equal(dither(picture, seed=3), dither(picture, seed=3))
    assert (dither(picture, seed=3) != dither(picture, seed=4)).any()
    assert set(np.round(dither(picture, levels=4) * 3).ravel()) <= {0, 1, 2, 3}


@pytest.mark.usefixtures("core")
def test_the_pass_rounds_the_display_and_without_levels_does_nothing() -> None:
    scene = scenes.room(scenes.LIGHTS["directional"])
    found = {}
    for levels, seed in ((0, 0), (32, 0), (32, 0), (32, 5), (256, 0)):
        options = FrameOptions(sky_directions=0, dither_levels=levels, dither_seed=seed)
        result = frame_graph(FrameScene(scene), options).run({"camera": scene.camera})
        shown = srgb_encode(np.clip(result["display"], 0.0, 1.0))
        found.setdefault((levels, seed), []).append(shown)
        if not levels:
            np.testing.assert_array_equal(result["display"], result["smoothed"])
    (plain,), coarse, (other,), (fine,) = found.values()
    np.testing.assert_array_equal(*coarse)
    assert (coarse[0] != other).any()
    for levels, shown in ((32, coarse[0]), (256, fine)):
        steps = shown * (levels - 1)
        assert np.abs(steps - np.rint(steps)).max() < 1e-3
        assert 0.5 < np.abs(shown - plain).max() * (levels - 1) < 1.5 + 1e-3
    # Away from black and white, where noise is cut off, the mean stays.
    inside = (plain > 0.1) & (plain < 0.9)
    assert inside.sum() > 3000
    deviation = (coarse[0] - plain)[inside]
    assert abs(float(deviation.mean())) < 4 * float(deviation.std()) / np.sqrt(inside.sum())


def test_other_numbers_are_refused() -> None:
    with pytest.raises(RangeError, match="dither: display"):
        dither(np.full((2, 2, 3), 1.5))
    with pytest.raises(RangeError, match="dither: levels"):
        dither(np.zeros((2, 2, 3)), levels=1)
    for wrong in (1, -1, 65537):
        with pytest.raises(RangeError, match="FrameOptions: dither_levels"):
            FrameOptions(dither_levels=wrong)
