"""A coating with a strength and a color: its limits at the ends of their ranges."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd.bsdf import registry

from support.bsdf_proofs import hemisphere

MODELS = registry()
MODEL = MODELS["gltf_specular"]
BASE: dict[str, Any] = {"base_color": [0.9, 0.5, 0.2], "metalness": 0.3, "roughness": 0.4}
PLAIN = {"eta": 1.5, "specular_factor": 1.0, "specular_color_factor": [1.0, 1.0, 1.0]}
WO, WI = (hemisphere(200, seed=61, stream=k) for k in (1, 2))


def dielectric(**more: Any) -> dict[str, Any]:
    return {**BASE, "metalness": 0.0, **PLAIN, **more}


def test_without_changes_it_is_the_core_model() -> None:
    found = MODEL.f({**BASE, **PLAIN}, WO, WI)
    np.testing.assert_allclose(found, MODELS["gltf"].f(BASE, WO, WI), rtol=1e-12)
    assert found.max() > 0.1


def test_without_reflection_it_is_matt() -> None:
    found = MODEL.f(dielectric(specular_factor=0.0), WO, WI)
    matt = MODELS["lambert"].f({"albedo": BASE["base_color"]}, WO, WI)
    np.testing.assert_allclose(found, matt, rtol=1e-12)


def test_metal_is_not_varnished() -> None:
    metal = {**BASE, "metalness": 1.0}
    changed = {"eta": 1.2, "specular_factor": 0.3, "specular_color_factor": [1.0, 0.2, 0.0]}
    found = MODEL.f({**metal, **changed}, WO, WI)
    np.testing.assert_array_equal(found, MODEL.f({**metal, **PLAIN}, WO, WI))


def test_a_factor_scales_the_reflection_at_all_angles() -> None:
    # Over black only the coating reflects; at grazing angles it is white, whatever its color.
    black: dict[str, Any] = {"base_color": [0.0] * 3, "roughness": 0.5}
    color = {"specular_color_factor": [1.0, 0.5, 0.1]}
    whole = MODEL.f(dielectric(**black, **color), WO, WI)
    half = MODEL.f(dielectric(**black, **color, specular_factor=0.5), WO, WI)
    np.testing.assert_allclose(half, 0.5 * whole, rtol=1e-12)
    slant = np.array([[np.sqrt(1 - 1e-8), 0.0, 1e-4]])
    ahead = slant * [-1.0, 1.0, 1.0]
    grazing = MODEL.f(dielectric(**black, **color), slant, ahead)[0]
    np.testing.assert_allclose(grazing, grazing[0] * np.ones(3), rtol=1e-3)
    up = np.array([[0.0, 0.0, 1.0]])
    straight = MODEL.f(dielectric(**black, **color), up, up)[0]
    np.testing.assert_allclose(straight / straight[0], [1.0, 0.5, 0.1], rtol=1e-12)


def test_the_ground_loses_what_the_strongest_channel_reflects() -> None:
    # A red coating over white: no channel gets more light than red, so nothing turns green or blue.
    white: dict[str, Any] = {"base_color": [1.0] * 3, "eta": 2.0}
    red = MODEL.f(dielectric(**white, specular_color_factor=[1.0, 0.0, 0.0]), WO, WI)
    plain = MODEL.f(dielectric(**white), WO, WI)
    assert (red[:, 1:] <= red[:, :1]).all()
    np.testing.assert_allclose(red[:, 0], plain[:, 0], rtol=1e-12)
    assert (red[:, 1] < plain[:, 1]).all()


def test_reflection_straight_on_stays_below_one() -> None:
    # s = (1.5 / 3.5)^2 = 0.18: six times it is cut to 1, and then neither factor moves it.
    bright = dielectric(eta=2.5, specular_color_factor=[6.0, 3.0, 1.0])
    up = np.array([[0.0, 0.0, 1.0]])
    value = MODEL.f(bright, up, up)[0]
    lobe = MODEL.f({**BASE, "base_color": [1.0] * 3, "metalness": 1.0, **PLAIN}, up, up)[0, 0]
    s = (1.5 / 3.5) ** 2
    np.testing.assert_allclose(value, np.array([1.0, 3 * s, s]) * lobe, rtol=1e-12)
    slopes = MODEL.f_backward(bright, up, up, np.ones((1, 3)))
    by_color = np.ravel(slopes["specular_color_factor"])
    assert by_color[0] == 0
    np.testing.assert_allclose(by_color[1:], s * lobe, rtol=1e-12)
    ends = [MODEL.f({**bright, "eta": 2.5 + h}, up, up).sum() for h in (1e-5, -1e-5)]
    np.testing.assert_allclose(np.ravel(slopes["eta"]), (ends[0] - ends[1]) / 2e-5, rtol=1e-7)
