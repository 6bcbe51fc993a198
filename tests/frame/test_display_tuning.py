"""Tone curves and bloom come nearer to a target by descent."""

from __future__ import annotations

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.frame import bloom, tone_map, tune_bloom, tune_tone_curve
from photograd.frame.tone_mapping import TONE_CURVES, ToneCurve

pytestmark = pytest.mark.usefixtures("core")
PICTURE = np.random.default_rng(0).gamma(0.7, 0.6, (24, 32, 3))
OTHER = {
    "reinhard": {"white": 2.0},
    "aces": {"a": 2.2, "b": 0.05, "c": 2.3, "d": 0.5, "e": 0.2},
    "agx": {"slope": 2.9, "power": 1.2},
}


@pytest.mark.parametrize("curve", TONE_CURVES)
def test_a_curve_is_found_again(curve: ToneCurve) -> None:
    target = tone_map(PICTURE, curve, exposure=0.6, params=OTHER[curve])
    found = tune_tone_curve(PICTURE, target, curve, steps=400, rate=0.04)
    assert found.before > 0.02
    assert found.after < 0.03 * found.before
    assert len(found.history) == 401
    if curve != "aces":  # of which many curves nearly agree
        assert found.exposure == pytest.approx(0.6, abs=0.02)
        for name, value in OTHER[curve].items():
            assert found.params[name] == pytest.approx(value, rel=0.03)


def test_the_spread_of_a_bloom_is_found_again() -> None:
    truth = np.array([0.02, 0.2, 0.05, 0.1])
    found = tune_bloom(PICTURE, bloom(PICTURE, truth), np.full(4, 0.05), steps=1000, rate=0.1)
    assert found.after < 0.02 * found.before
    # Neighboring levels nearly agree: pictures say little of how they share.
    np.testing.assert_allclose(found.weights, truth, atol=0.05)
    assert found.weights.argmax() == truth.argmax()


def test_weights_never_spread_more_than_all_light() -> None:
    target = np.broadcast_to(PICTURE.mean(axis=(0, 1)), PICTURE.shape).copy()
    found = tune_bloom(PICTURE, target, np.full(3, 0.3), steps=80)
    assert found.weights.sum() <= 1 + 1e-12
    assert found.after < found.before


def test_other_pictures_are_refused() -> None:
    with pytest.raises(ShapeError, match="tune_tone_curve: target"):
        tune_tone_curve(PICTURE, PICTURE[:5])
    with pytest.raises(RangeError, match="tune_bloom: steps"):
        tune_bloom(PICTURE, PICTURE, np.full(3, 0.1), steps=0)
