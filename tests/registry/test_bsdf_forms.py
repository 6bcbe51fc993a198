"""Closed forms, limits and identities of single reflectance models."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.bsdf import registry
from photograd.bsdf.models import METALS

from support.bsdf_proofs import hemisphere, squares, towards

MODELS = registry()
WHITE = np.ones(3)
WO, WI = (hemisphere(200, seed=11, stream=k) for k in (1, 2))


def value(name: str, wo: Any = WO, wi: Any = WI, **parameters: Any) -> Any:
    return MODELS[name].f(parameters, np.ascontiguousarray(wo), np.ascontiguousarray(wi))


# wi, the cosine c to the mirrored view (-0.6, 0, 0.8) by hand, and pi f for exponents 1 and 2.
PHONG = [
    ((-0.6, 0.0, 0.8), 1.0, 0.925, 1.2375),
    ((0.0, 0.0, 1.0), 0.8, 0.7, 0.78),
    ((0.6, 0.0, 0.8), 0.28, 0.475, 0.3735),
    ((0.0, 0.6, 0.8), 0.64, 0.7, 0.684),
    ((0.8, 0.0, 0.6), 0.0, 0.3, 0.3),
    ((-0.8, 0.0, 0.6), 0.96, 1.1, 1.452),
    ((0.0, 0.8, 0.6), 0.48, 0.7, 0.588),
    ((0.96, 0.0, 0.28), -0.352, 0.3, 0.3),
    ((-0.96, 0.0, 0.28), 0.8, 0.3 + 0.4 / 0.28, 0.3 + 0.48 / 0.28),
    ((-0.28, 0.0, 0.96), 0.936, 0.7875, 0.98445),
]


@pytest.mark.parametrize(("wi", "c", "first", "second"), PHONG)
def test_phong_at_twenty_points_worked_by_hand(
    wi: tuple[float, ...], c: float, first: float, second: float
) -> None:
    # pi f = 0.3 + 0.5 (n + 1) / 2 c^n / i_z
    places = np.array([[0.6, 0.0, 0.8]]), np.array([wi])
    for n, expected in ((1.0, first), (2.0, second)):
        f = value("phong", *places, diffuse=[0.3] * 3, specular=[0.5] * 3, exponent=n)
        np.testing.assert_allclose(np.pi * f, expected, rtol=1e-12, atol=1e-12)
        # The reciprocal form: another factor, and no division by the cosine.
        f = value("phong_reciprocal", *places, diffuse=[0.3] * 3, specular=[0.5] * 3, exponent=n)
        np.testing.assert_allclose(np.pi * f, 0.3 + 0.25 * (n + 2) * max(c, 0.0) ** n, rtol=1e-12)


def test_blinns_highlight_looks_like_phongs_with_a_quarter_of_the_exponent() -> None:
    # In the plane of incidence the half vector turns half as far: cos(x/2)^(4n) ~ cos(x)^n.
    x = np.linspace(-0.2, 0.2, 41)
    wi = np.stack([np.sin(x), np.zeros(41), np.cos(x)], axis=1)
    wo = np.tile([0.0, 0.0, 1.0], (41, 1))
    shape = {"diffuse": np.zeros(3), "specular": WHITE}
    phong = value("phong_reciprocal", wo, wi, exponent=50.0, **shape)[:, 0]
    blinn = value("blinn_phong", wo, wi, exponent=200.0, **shape)[:, 0]
    np.testing.assert_allclose(blinn / blinn.max(), phong / phong.max(), atol=1e-2)


def test_plaster_without_slopes_is_lambert() -> None:
    color = np.array([0.2, 0.5, 0.8])
    plain = value("lambert", albedo=color)
    np.testing.assert_allclose(value("oren_nayar_qualitative", albedo=color, sigma=0.0), plain)
    assert np.abs(value("oren_nayar_qualitative", albedo=color, sigma=0.5) - plain).max() > 0.01


def test_burley_is_lambert_straight_on() -> None:
    up = np.array([[0.0, 0.0, 1.0]])
    for roughness in (0.0, 0.4, 1.0):
        f = value("burley_diffuse", up, up, albedo=WHITE, roughness=roughness)
        np.testing.assert_allclose(f, 1.0 / np.pi, rtol=1e-14)


def test_premixed_f0_equals_blended_lobes_where_schlick_multiplies_nothing_else() -> None:
    base, metalness, reflectance = np.array([0.9, 0.5, 0.2]), 0.3, 0.7
    both = value(
        "standard", base_color=base, metalness=metalness, roughness=0.4, reflectance=reflectance
    )
    f0 = (1 - metalness) * 0.16 * reflectance**2 + metalness * base
    premixed = (1 - metalness) * base / np.pi + value("ggx_metal", f0=f0, roughness=0.4)
    np.testing.assert_allclose(both, premixed, rtol=1e-12)


@pytest.mark.parametrize("name", ["standard", "gltf"])
def test_a_full_metal_is_the_metal(name: str) -> None:
    base = np.array([0.9, 0.5, 0.2])
    extra: dict[str, Any] = {"reflectance": 0.5} if name == "standard" else {}
    f = value(name, base_color=base, metalness=1.0, roughness=0.3, **extra)
    np.testing.assert_allclose(f, value("ggx_metal", f0=base, roughness=0.3), rtol=1e-12)


def test_no_coat_is_the_base() -> None:
    base: dict[str, Any] = {"base_color": [0.9, 0.5, 0.2], "metalness": 0.3, "roughness": 0.4}
    bare = value("clearcoat", coat=0.0, coat_roughness=0.1, **base)
    np.testing.assert_array_equal(bare, value("gltf", **base))


def test_anisotropy_zero_is_isotropic_and_a_quarter_turn_swaps_the_axes() -> None:
    round_lobe: dict[str, Any] = {"f0": [0.9, 0.5, 0.2], "roughness": 0.4}
    plain = value("ggx_metal", **round_lobe)
    for rotation in (0.0, 1.0):
        same = value("ggx_anisotropic", anisotropy=0.0, rotation=rotation, **round_lobe)
        np.testing.assert_allclose(same, plain, rtol=1e-11)  # measured 5e-13
    swap = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    long: dict[str, Any] = {"anisotropy": 0.8, **round_lobe}
    turned = value("ggx_anisotropic", rotation=np.pi / 2, **long)
    swapped = value("ggx_anisotropic", WO @ swap, WI @ swap, rotation=0.0, **long)
    np.testing.assert_allclose(turned, swapped, rtol=1e-10)  # measured 2e-12
    assert np.abs(swapped / value("ggx_anisotropic", rotation=0.0, **long) - 1).max() > 0.5
    # Rougher along the tangent: the lobe is wider there than across.
    up = np.array([[0.0, 0.0, 1.0]])
    along, across = (np.array([w]) for w in ([0.6, 0.0, 0.8], [0.0, 0.6, 0.8]))
    wide = value("ggx_anisotropic", up, along, rotation=0.0, **long)
    assert (wide > value("ggx_anisotropic", up, across, rotation=0.0, **long)).all()


LEAST = {  # the sharpest lobe of each glossy model that is a mirror there, and its F at cosine c
    "ggx_metal": ({"f0": [0.5] * 3, "roughness": 0.045}, lambda c: 0.5 + 0.5 * (1 - c) ** 5),
    "ggx_metal_compensated": (
        {"f0": [0.5] * 3, "roughness": 0.045},
        lambda c: 0.5 + 0.5 * (1 - c) ** 5,
    ),
    "cook_torrance": ({"f0": [0.5] * 3, "slope": 0.002}, lambda c: 0.5 + 0.5 * (1 - c) ** 5),
    "ggx_anisotropic": (
        {"f0": [0.5] * 3, "roughness": 0.045, "anisotropy": 0.0, "rotation": 0.3},
        lambda c: 0.5 + 0.5 * (1 - c) ** 5,
    ),
}


@pytest.mark.parametrize("name", sorted(LEAST))
def test_the_smoothest_surface_is_a_mirror(name: str) -> None:
    parameters, fresnel = LEAST[name]
    model, count = MODELS[name], 20_000
    for cosine in (0.3, 0.8):
        wo = towards(cosine, count)
        wi = model.sample(parameters, wo, squares(count, seed=12))
        turned = wi @ (towards(cosine)[0] * [-1, -1, 1])
        assert np.quantile(turned, 0.5) > np.cos(0.01)
        weight = model.f(parameters, wo, wi)[:, 0] * wi[:, 2]
        pdf = model.pdf(parameters, wo, wi)
        albedo = float((weight[pdf > 0] / pdf[pdf > 0]).sum() / count)
        assert albedo == pytest.approx(fresnel(cosine), rel=5e-3)


def test_measured_metals_have_their_colors() -> None:
    # Straight on: R = ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2), here as F D V over the same D V.
    up = np.array([[0.0, 0.0, 1.0]])
    for name, metal in METALS.items():
        eta, k = np.array(metal["eta"]), np.array(metal["k"])
        expected = ((eta - 1) ** 2 + k**2) / ((eta + 1) ** 2 + k**2)
        f = value("ggx_conductor", up, up, roughness=0.5, **metal)
        mirror = value("ggx_metal", up, up, f0=WHITE, roughness=0.5)
        np.testing.assert_allclose((f / mirror)[0], expected, rtol=1e-12, err_msg=name)
    gold = METALS["gold"]
    red, _, blue = ((np.array(gold["eta"]) - 1) ** 2 + np.array(gold["k"]) ** 2) / (
        (np.array(gold["eta"]) + 1) ** 2 + np.array(gold["k"]) ** 2
    )
    assert red > 0.9
    assert blue < 0.45


def test_beckmann_has_shorter_tails_than_ggx() -> None:
    up = np.array([[0.0, 0.0, 1.0]])
    metal: dict[str, Any] = {"roughness": 0.5, **METALS["silver"]}
    tail = np.array([[0.96, 0.0, 0.28]])
    ratio = value("beckmann_conductor", up, tail, **metal) / value(
        "ggx_conductor", up, tail, **metal
    )
    assert (ratio < 0.02).all()
    near = value("beckmann_conductor", up, up, **metal) / value("ggx_conductor", up, up, **metal)
    np.testing.assert_allclose(near, 1.0, rtol=0.05)


def test_more_roughness_dims_the_middle_of_a_highlight_and_lights_a_ring_around_it() -> None:
    angle = np.linspace(0.0, 0.8, 17)
    wo = np.tile([0.0, 0.0, 1.0], (17, 1))
    wi = np.stack([np.sin(angle), np.zeros(17), np.cos(angle)], axis=1)
    rows = {"base_color": np.full((17, 3), 0.5), "metalness": np.zeros(17)}
    parameters = {**rows, "roughness": np.full(17, 0.35)}
    slope = MODELS["gltf"].f_backward(parameters, wo, wi, np.ones((17, 3)))["roughness"]
    signs = np.sign(slope)
    assert signs[0] == -1
    assert signs[-1] == 1
    assert (np.diff(signs) != 0).sum() == 1


@pytest.mark.parametrize("name", ["phong", "phong_reciprocal", "blinn_phong", "blinn_phong_fitted"])
def test_exponents_near_one_are_differentiated_too(name: str) -> None:
    # There 2^(-n/2) in the exact norm counts; the proof of all models draws larger exponents.
    color = {"diffuse": np.full(3, 0.3), "specular": np.full(3, 0.5)}
    n, h = 1.5, 1e-5
    ends = [value(name, exponent=e, **color).sum() for e in (n + h, n - h)]
    exact = MODELS[name].f_backward({**color, "exponent": n}, WO, WI, np.ones((200, 3)))
    assert exact["exponent"][0] == pytest.approx((ends[0] - ends[1]) / (2 * h), rel=1e-7)
