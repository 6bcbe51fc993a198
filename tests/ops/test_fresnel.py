"""Fresnel's three forms against what is known of them."""

from __future__ import annotations

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.bsdf import registry

pytestmark = pytest.mark.usefixtures("core")


def reflectance(op: str, *inputs: float) -> float:
    return float(_core.ops[op].forward(np.array(inputs, np.float64))[0])


@pytest.mark.parametrize("eta", [1.1, 1.5, 2.4])
def test_glass_straight_on_at_brewsters_angle_and_at_the_horizon(eta: float) -> None:
    straight = ((eta - 1) / (eta + 1)) ** 2
    assert reflectance("fresnel_dielectric", eta, 1.0) == pytest.approx(straight, rel=1e-14)
    # tan(theta) = eta: the field in the plane of incidence is not reflected at all.
    brewster = 1 / np.sqrt(1 + eta**2)
    other = (eta**2 - 1) / (eta**2 + 1)
    assert reflectance("fresnel_dielectric", eta, brewster) == pytest.approx(
        0.5 * other**2, rel=1e-13
    )
    assert reflectance("fresnel_dielectric", eta, 0.0) == 1.0


@pytest.mark.parametrize("eta", [1.1, 1.5, 2.4])
def test_both_ways_through_a_boundary_reflect_the_same(eta: float) -> None:
    for cosine in np.linspace(0.05, 1.0, 20):
        refracted = np.sqrt(1 - (1 - cosine**2) / eta**2)
        there = reflectance("fresnel_dielectric", eta, cosine)
        back = reflectance("fresnel_dielectric", 1 / eta, refracted)
        assert there == pytest.approx(back, rel=1e-11)


def test_total_reflection_begins_at_the_critical_angle() -> None:
    critical = np.sqrt(1 - 1 / 1.5**2)
    assert reflectance("fresnel_dielectric", 1 / 1.5, critical * (1 - 1e-9)) == 1.0
    assert reflectance("fresnel_dielectric", 1 / 1.5, critical * (1 + 1e-3)) < 0.9


def test_a_metal_that_does_not_absorb_is_glass() -> None:
    for cosine in np.linspace(0.05, 1.0, 20):
        metal = reflectance("fresnel_conductor", 1.5, 1e-9, cosine)
        assert metal == pytest.approx(reflectance("fresnel_dielectric", 1.5, cosine), rel=1e-8)


def test_a_metal_straight_on_and_at_the_horizon() -> None:
    for eta, k in ((0.2, 3.0), (1.4, 1.9), (3.0, 0.5)):
        straight = ((eta - 1) ** 2 + k**2) / ((eta + 1) ** 2 + k**2)
        assert reflectance("fresnel_conductor", eta, k, 1.0) == pytest.approx(straight, rel=1e-13)
        assert reflectance("fresnel_conductor", eta, k, 0.0) == pytest.approx(1.0, rel=1e-13)


def test_schlick_is_within_0_0357_of_glass() -> None:
    cosines = np.linspace(0.0, 1.0, 1001)
    exact = np.array([reflectance("fresnel_dielectric", 1.5, c) for c in cosines])
    ramp = np.array([reflectance("fresnel_schlick", 0.04, 1.0, c) for c in cosines])
    gap = np.abs(ramp - exact)
    # Both ends are given and the power of 5 is fixed: nothing is left to bring the largest gap, at
    # 85 degrees from the normal, below this. It is a property of the formula.
    assert gap.max() == pytest.approx(0.0357, abs=1e-4)
    assert cosines[gap.argmax()] == pytest.approx(np.cos(np.radians(85)), abs=0.01)
    assert ramp[-1] == pytest.approx(exact[-1], rel=1e-14)
    assert ramp[0] == 1.0


def test_colors_reflect_as_each_of_their_numbers() -> None:
    # A metal is Schlick's color times what does not depend on it; one number is the scalar form.
    wi, wo = np.random.default_rng(1).uniform(0.05, 1, (2, 200, 3))
    wi, wo = (w / np.linalg.norm(w, axis=1, keepdims=True) for w in (wi, wo))
    cosine = np.einsum("nk,nk->n", wo, (wi + wo) / np.linalg.norm(wi + wo, axis=1, keepdims=True))
    model, f0 = registry()["ggx_metal"], np.array([0.04, 0.5, 0.95])
    color, white = (model.f({"f0": value, "roughness": 0.4}, wo, wi) for value in (f0, np.ones(3)))
    scalar = [[reflectance("fresnel_schlick", f, 1.0, c) for f in f0] for c in cosine]
    np.testing.assert_allclose(color / white, scalar, rtol=1e-12)


@pytest.mark.parametrize("alpha", [0.01, 0.1, 0.5, 1.0])
@pytest.mark.parametrize("name", ["ggx", "beckmann", "charlie"])
def test_facets_cover_the_surface_once(name: str, alpha: float) -> None:
    # int D cos = 1: with s = tan / alpha = x / (1 - x), dw = 2 pi cos^3 tan dtan.
    x = (np.arange(4000) + 0.5) / 4000
    tangent, slope = alpha * x / (1 - x), alpha / (1 - x) ** 2
    cosine = 1 / np.sqrt(1 + tangent**2)
    if name == "ggx":
        op = _core.ops["ggx"]
        D = [
            op.forward(np.array([t * c, 0, c, 0, 0, 1, 0, 0, 1, alpha, alpha]))[0]
            for t, c in zip(tangent, cosine, strict=True)
        ]
    elif name == "beckmann":
        D = np.exp(-((tangent / alpha) ** 2)) / (np.pi * alpha**2 * cosine**4)
        checked = _core.ops["beckmann"].forward(np.array([alpha]))[0]
        expected = np.exp(-((0.28 / 0.96 / alpha) ** 2)) / (np.pi * alpha**2 * 0.96**4)
        assert checked == pytest.approx(expected, rel=1e-12)
    else:  # by the sine x: dw cos = 2 pi x dx
        D = (2 + 1 / alpha) * x ** (1 / alpha) / (2 * np.pi)
        checked = _core.ops["charlie"].forward(np.array([alpha]))[0]
        expected = (2 + 1 / alpha) * 0.9 ** (1 / alpha) / (2 * np.pi)
        assert checked == pytest.approx(expected, rel=1e-12)
        assert (D * 2 * np.pi * x).mean() == pytest.approx(1.0, abs=1e-4)
        return
    total = (np.array(D) * cosine * 2 * np.pi * cosine**3 * tangent * slope).mean()
    assert total == pytest.approx(1.0, abs=1e-4)


def test_ggx_in_float_is_exact_where_the_lobe_is_highest() -> None:
    # alpha = 1e-3 (roughness 0.03), half an alpha from the peak: (alpha^2 - 1) h_z^2 + 1 keeps
    # two digits there.
    alpha, x = 1e-3, 5e-4
    inputs = np.array([x, 0, np.sqrt(1 - x * x), 0, 0, 1, 0, 0, 1, alpha, alpha])
    wide = _core.ops["ggx"].forward(inputs)[0]
    assert wide == pytest.approx(1 / (np.pi * alpha**2 * (1.25 - x * x) ** 2), rel=1e-12)
    assert _core.ops["ggx"].forward(inputs.astype("f4"))[0] == pytest.approx(wide, rel=1e-6)
    z = np.float32(inputs[2])
    usual = np.float32(alpha**2 - 1) * z * z + np.float32(1)
    assert abs(alpha**2 / (np.pi * float(usual) ** 2) / wide - 1) > 2e-3
