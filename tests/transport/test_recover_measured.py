"""What the caption of docs/images/recover_measured.png says, and what its numbers rest on."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.bsdf import registry

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import recover_measured as measured


def test_what_is_asked_cancels_in_every_parameter_and_is_still_there() -> None:
    model = registry()["ggx_metal"]
    values = {"f0": [0.8, 0.6, 0.3], "roughness": 0.35}

    def target(wo: Any, wi: Any) -> Any:
        return model.f(values, wo, wi)

    own = measured.fitted("ggx_metal", target, 400, (0.75,))
    assert own.loss < 1e-5  # the model itself is found: 5e-7
    assert float(own.values["roughness"]) == pytest.approx(0.35, abs=0.01)
    other = measured.fitted("cook_torrance", target, 400, (0.75,))
    assert other.loss > 100 * own.loss
    wo, wi = measured.pairs(1)
    d_f = measured.loss_backward(
        measured.MODELS["cook_torrance"].f(other.values, wo, wi), target(wo, wi), wi[:, 2:]
    )
    first = measured.fitted("cook_torrance", target, 1, (0.75,))
    before = max(np.abs(slope).max() for slope in first.slope.values())
    assert max(np.abs(slope).max() for slope in other.slope.values()) < 0.03 * before
    assert np.abs(d_f).sum() > 0
    asked = measured.pull(other, target, 30)
    assert np.nanmin(asked) < 0 < np.nanmax(asked)


def test_the_loss_of_reflectances_has_the_derivative_it_says() -> None:
    g = np.random.default_rng(2)
    f, target, cosine = g.random((6, 3)), g.random((6, 3)), g.random((6, 1))
    found = measured.loss_backward(f, target, cosine)
    step = 1e-6 * g.standard_normal(f.shape)
    difference = measured.loss(f + step, target, cosine) - measured.loss(f - step, target, cosine)
    assert (found * step).sum() == pytest.approx(difference / 2, rel=1e-6)
    wo, wi = measured.directions(*(g.uniform(0.1, 0.6, 5) for _ in range(3)))
    angles = measured.half_difference(wo, wi)
    again = measured.directions(
        np.arccos(angles[:, 2]), np.arccos(angles[:, 5]), np.arctan2(angles[:, 4], angles[:, 3])
    )
    np.testing.assert_allclose(again, (wo, wi), atol=1e-12)


def test_a_measured_material_has_the_values_of_its_source(shared_data: Path) -> None:
    # theta_h 0, theta_d 0.2, phi_d a right angle.
    wo, wi = measured.directions(np.zeros(1), np.full(1, 0.2), np.full(1, 0.5 * np.pi))
    paint = measured.measured(shared_data, "gold-metallic-paint")(wo, wi)
    np.testing.assert_allclose(paint[0], [0.46, 0.34, 0.12], atol=0.006)


def test_at_grazing_light_one_model_lacks_light_and_another_has_too_much(shared_data: Path) -> None:
    target = measured.measured(shared_data, measured.PULL_OF)
    asked = {
        model: measured.pull(measured.fitted(model, target, 300, (0.75,)), target)
        for model in ("blinn_phong", "ggx_metal")
    }
    # Difference angles above 70 degrees, half angles below 15.
    assert asked["blinn_phong"][:6, -4:].mean() < 0 < asked["ggx_metal"][:6, -4:].mean()
