"""Sheets and bodies of glTF's transmission: what they are in their limits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.bsdf import registry

from support.bsdf_proofs import albedo, hemisphere

MODELS = registry()
SHEET, BODY = MODELS["gltf_transmission"], MODELS["gltf_refraction"]
WO, WI = (hemisphere(200, seed=21, stream=k) for k in (1, 2))
BELOW = np.array([1.0, 1.0, -1.0])
CORE: dict[str, Any] = {"base_color": [0.9, 0.5, 0.2], "metalness": 0.3, "roughness": 0.4}


def test_nothing_transmitted_is_the_core_model() -> None:
    # f0 of an index of 1.5 is 0.04.
    plain = MODELS["gltf"].f(CORE, WO, WI)
    for model in (SHEET, BODY):
        opaque = CORE | {"transmission": 0.0, "eta": 1.5}
        np.testing.assert_allclose(model.f(opaque, WO, WI), plain, rtol=1e-13)
        assert (model.f(opaque, WO, np.ascontiguousarray(WI * BELOW)) == 0).all()
    assert plain.max() > 0.1


def test_a_sheet_has_two_like_sides() -> None:
    values = CORE | {"transmission": 0.7, "eta": 1.4}
    for side in (1.0, -1.0):
        there = SHEET.f(values, WO, np.ascontiguousarray(WI * [1, 1, side]))
        turned = [np.ascontiguousarray(w * BELOW) for w in (WO, WI * [1, 1, side])]
        np.testing.assert_array_equal(SHEET.f(values, *turned), there)
        assert there.max() > 0.01


@pytest.mark.parametrize("cosine", [0.1, 0.3, 0.6, 1.0])
def test_a_clear_sheet_loses_what_one_facet_loses(cosine: float) -> None:
    # F and 1 - F of the same lobe: together a white mirror's, whose losses test_bsdf_energy knows.
    white = {"base_color": np.ones(3), "metalness": 0.0, "roughness": 0.5}
    sheet = albedo(SHEET, white | {"transmission": 1.0, "eta": 1.5}, cosine)
    mirror = albedo(MODELS["ggx_metal"], {"f0": np.ones(3), "roughness": 0.5}, cosine)
    np.testing.assert_allclose(sheet, mirror, rtol=2e-4)


def test_a_clear_body_is_frosted_glass_and_a_tint_colors_what_passes() -> None:
    glass = {"eta": 1.6, "roughness": 0.4}
    for wo, wi in ((WO, WI), (WO, WI * BELOW), (WO * BELOW, WI), (WO * BELOW, WI * BELOW)):
        there = [np.ascontiguousarray(w) for w in (wo, wi)]
        frosted = MODELS["rough_dielectric"].f(glass, *there)
        whole = {"metalness": 0.0, "transmission": 1.0, **glass}
        clear = BODY.f(whole | {"base_color": np.ones(3)}, *there)
        np.testing.assert_allclose(clear, frosted, rtol=1e-14)
        assert clear.max() > 0
        passes = wo[0, 2] * wi[0, 2] < 0
        tint = np.array([0.9, 0.5, 0.2])
        tinted = BODY.f(whole | {"base_color": tint}, *there)
        np.testing.assert_allclose(tinted, frosted * (tint if passes else 1.0), rtol=1e-14)


@pytest.mark.parametrize("model", [SHEET, BODY], ids=lambda model: model.name)
def test_a_metal_lets_nothing_through(model: Any) -> None:
    values = CORE | {"metalness": 1.0, "eta": 1.5}
    metal = MODELS["ggx_metal"].f({"f0": CORE["base_color"], "roughness": 0.4}, WO, WI)
    for transmission in (0.0, 1.0):
        found = model.f(values | {"transmission": transmission}, WO, WI)
        np.testing.assert_allclose(found, metal, rtol=1e-12)
        below = model.f(
            values | {"transmission": transmission}, WO, np.ascontiguousarray(WI * BELOW)
        )
        assert (below == 0).all()
