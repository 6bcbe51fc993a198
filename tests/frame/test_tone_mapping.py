"""Tone curves: fixed points, monotony, and derivatives of a loss that comes after them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.frame import tone_map, tone_map_backward
from photograd.frame.tone_mapping import DEFAULT_TONES, TONE_CURVES, ToneCurve
from photograd_course.gradcheck import check_gradient

from support.gradient_mutants import check_gradient_mutants

pytestmark = pytest.mark.usefixtures("core")


def functions(curve: ToneCurve) -> tuple[Any, Any, dict[str, Any]]:
    names = list(DEFAULT_TONES[curve])

    def numbers(p: dict[str, Any]) -> dict[str, Any]:
        values = dict(zip(names, p["params"].tolist(), strict=True))
        return {"exposure": float(p["exposure"][0]), "params": values}

    def forward(p: dict[str, Any]) -> Any:
        return tone_map(p["color"], curve, **numbers(p))

    def backward(p: dict[str, Any], d: Any) -> dict[str, Any]:
        d_color, found = tone_map_backward(p["color"], d, curve, **numbers(p))
        d_params = np.array([found[name] for name in names])
        return {"color": d_color, "exposure": np.array([found["exposure"]]), "params": d_params}

    place = {
        "color": np.random.default_rng(1).uniform(0.2, 3.0, (5, 3)),
        "exposure": np.array([0.3]),
        "params": np.array(list(DEFAULT_TONES[curve].values())),
    }
    return forward, backward, place


@pytest.mark.parametrize("curve", TONE_CURVES)
def test_a_loss_may_come_after_it(curve: ToneCurve) -> None:
    forward, backward, place = functions(curve)
    report = check_gradient(forward, backward, place, seed=1)
    assert report, str(report)


def test_wrong_gradients_are_noticed() -> None:
    forward, backward, place = functions("agx")
    cotangent = np.random.default_rng(2).uniform(-1, 1, (5, 3))
    report = check_gradient_mutants(forward, backward, place, cotangent, seed=1)
    assert report, str(report)


@pytest.mark.parametrize("curve", TONE_CURVES)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_gray_grows_from_zero(curve: ToneCurve, dtype: Any) -> None:
    radiance = np.concatenate([[0.0], np.geomspace(1e-6, 1e4, 4000)])
    shown = tone_map(np.repeat(radiance[:, None], 3, axis=1).astype(dtype), curve)[:, 1]
    assert shown.dtype == dtype
    assert shown[0] == 0.0
    assert (np.diff(shown.astype(np.float64)) >= (0.0 if dtype == np.float64 else -2e-6)).all()
    assert shown[-1] > 0.9


def test_fixed_points_of_the_curves() -> None:
    assert tone_map([[4.0, 4.0, 4.0]], "reinhard") == pytest.approx(1.0)
    assert tone_map([[2.5, 2.5, 2.5]], "reinhard", params={"white": 2.5}) == pytest.approx(1.0)
    # AgX keeps middle gray, to what its matrices are rounded to.
    assert tone_map([[0.18, 0.18, 0.18]], "agx") == pytest.approx(0.18, rel=5e-4)


def test_exposure_doubles_with_each_stop() -> None:
    color = np.random.default_rng(0).uniform(0, 2, (4, 3))
    brighter = tone_map(color, "aces", exposure=1.5)
    np.testing.assert_allclose(brighter, tone_map(2**1.5 * color, "aces"), rtol=1e-14)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"color": [[-0.1, 0, 0]]}, "tone_map: color"),
        ({"color": [[np.nan, 0, 0]]}, "tone_map: color"),
        ({"curve": "filmic"}, "tone_map: curve: expected one of reinhard, aces, agx"),
        ({"params": {"slope": 1.0}}, "tone_map: slope"),
        ({"params": {"white": 2.0}}, "tone_map: params: expected parameters of 'agx'"),
    ],
)
def test_what_makes_no_curve_is_refused(wrong: dict[str, Any], said: str) -> None:
    given = {"color": [[1.0, 1.0, 1.0]], "curve": "agx"} | wrong
    with pytest.raises(RangeError, match=said):
        tone_map(**given)
