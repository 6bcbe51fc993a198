"""How much light each model returns: the published numbers, and the errors that change them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.bsdf import BsdfModel, registry

from support.bsdf_proofs import albedo, towards, upper_grid

MODELS = registry()
WHITE = np.ones(3)
BLACK = np.zeros(3)
COSINES = (0.1, 0.3, 0.6, 1.0)
# Directional albedo of perfect mirrors under height-correlated Smith masking, by alpha and cosine.
GGX = {
    0.1: (0.883, 0.936, 0.977, 0.988),
    0.25: (0.892, 0.838, 0.872, 0.916),
    0.5: (0.860, 0.745, 0.688, 0.688),
    0.75: (0.811, 0.650, 0.535, 0.464),
    1.0: (0.760, 0.560, 0.412, 0.307),
}


def of(name: str, cosine: float, **parameters: Any) -> float:
    """Albedo of the first channel."""
    return float(albedo(MODELS[name], parameters, cosine)[0])


@pytest.mark.parametrize("alpha", sorted(GGX))
def test_mirrors_of_ggx_lose_what_the_table_says(alpha: float) -> None:
    found = [of("ggx_metal", c, f0=WHITE, roughness=np.sqrt(alpha)) for c in COSINES]
    np.testing.assert_allclose(found, GGX[alpha], atol=6e-4)  # the table has three digits


def test_the_roughest_mirror_seen_straight_on_returns_one_minus_ln_two() -> None:
    found = of("ggx_metal", 1.0, f0=WHITE, roughness=1.0)
    assert found == pytest.approx(1.0 - np.log(2.0), abs=1e-6)


# What the same mirrors return under the masking without roots.
FAST = {
    0.1: (0.690, 0.805, 0.920, 0.984),
    0.25: (0.748, 0.703, 0.788, 0.895),
    0.5: (0.792, 0.661, 0.627, 0.661),
    0.75: (0.785, 0.615, 0.508, 0.452),
    1.0: GGX[1.0],
}


@pytest.mark.parametrize("alpha", sorted(FAST))
def test_the_shorter_masking_of_ggx_loses_a_fifth_at_grazing_angles(alpha: float) -> None:
    # V = 1 / (2 lerp(2 o_z i_z, o_z + i_z, alpha)), summed here without the core.
    grid, area = upper_grid()
    for cosine, exact, loss in zip(COSINES, GGX[alpha], FAST[alpha], strict=True):
        wo = towards(cosine, len(grid))
        found = of("ggx_metal_fast", cosine, f0=WHITE, roughness=np.sqrt(alpha))
        assert found == pytest.approx(loss, abs=6e-4)
        assert found < exact + 6e-4
        wh = (wo + grid) / np.linalg.norm(wo + grid, axis=1, keepdims=True)
        o, i, h = wo[:, 2], grid[:, 2], wh[:, 2]
        D = alpha**2 / (np.pi * ((alpha**2 - 1) * h * h + 1) ** 2)
        V = 0.5 / (2 * o * i * (1 - alpha) + (o + i) * alpha)
        assert float((D * V * i * area[:, 0]).sum()) == pytest.approx(found, rel=1e-9)


def test_cook_and_torrance_with_the_right_constants_and_with_the_printed_ones() -> None:
    slope, cosine = 0.2, 0.9
    found = of("cook_torrance", cosine, f0=WHITE, slope=slope)
    assert found == pytest.approx(0.999, abs=6e-4)
    # As the paper prints it: D = exp(-(tan / m)^2) / (m^2 cos^4), and F D G / (pi o_z i_z).
    grid, area = upper_grid()
    wo = towards(cosine, len(grid))
    wh = wo + grid
    wh /= np.linalg.norm(wh, axis=1, keepdims=True)
    c, o, i, d = wh[:, 2], wo[:, 2], grid[:, 2], (wo * wh).sum(axis=1)
    D = np.exp(-(1 / c**2 - 1) / slope**2) / (slope**2 * c**4)
    G = np.minimum(1.0, np.minimum(2 * c * o / d, 2 * c * i / d))
    printed = float((D * G / (np.pi * o * i) * i * area[:, 0]).sum())
    assert printed == pytest.approx(4 * 0.999, abs=3e-3)
    # And the same sum with the right ones is the core's model, point by point.
    model = MODELS["cook_torrance"].f({"f0": WHITE, "slope": slope}, wo, grid)[:, 0]
    np.testing.assert_allclose(model, D / np.pi * G / (4 * o * i), rtol=1e-9, atol=1e-12)


def test_blended_metalness_lies_between_its_ends_and_premixed_f0_does_not() -> None:
    shape: dict[str, Any] = {"base_color": WHITE, "roughness": 0.5}
    ends = [of("gltf", 0.6, metalness=m, **shape) for m in (0.0, 1.0)]
    blend = of("gltf", 0.6, metalness=0.5, **shape)
    np.testing.assert_allclose([*ends, blend], [1.002, 0.872, 0.937], atol=6e-4)
    # One lobe of the mixed f0 = 0.52 over half of a white ground.
    grid, area = upper_grid()
    wo = towards(0.6, len(grid))
    mirror = MODELS["ggx_metal"]
    lobe = mirror.f({"f0": WHITE, "roughness": 0.5}, wo, grid)[:, 0]
    fresnel = mirror.f({"f0": np.full(3, 0.52), "roughness": 0.5}, wo, grid)[:, 0] / lobe
    value = (1 - fresnel) * 0.5 / np.pi + fresnel * lobe
    premixed = float((value * grid[:, 2] * area[:, 0]).sum())
    assert premixed == pytest.approx(0.698, abs=6e-4)


def test_gltfs_ground_keeps_its_light_where_the_varnish_turns_to_a_mirror() -> None:
    white: dict[str, Any] = {"base_color": WHITE, "metalness": 0.0}
    places = ((0.6, 0.5), (0.1, 0.5), (0.1, 0.3), (0.6, 1.0))
    found = [of("gltf", cosine, roughness=r, **white) for cosine, r in places]
    np.testing.assert_allclose(found, [1.0024, 1.1096, 1.2837, 0.9751], atol=1e-3)
    # At the horizon: a mirror, and 1 - F_d over the half angles of a view along the surface.
    grid, area = upper_grid()
    half = np.sqrt(0.5 * (1.0 + (towards(1e-6, len(grid)) * grid).sum(axis=1)))
    ground = (1 - (0.04 + 0.96 * (1 - half) ** 5)) * grid[:, 2] / np.pi
    limit = 1.0 + float((ground * area[:, 0]).sum())
    assert limit == pytest.approx(1.933, abs=1e-3)
    assert MODELS["gltf"].energy == ("gains", 1.94)


def test_filaments_ground_keeps_what_the_lobe_reflects() -> None:
    white: dict[str, Any] = {"base_color": WHITE, "metalness": 0.0, "reflectance": 0.5}
    # 1 for the ground and the lobe's own albedo on top: the same as over a black ground.
    for cosine in COSINES:
        both = of("standard", cosine, roughness=0.5, **white)
        alone = of("standard", cosine, roughness=0.5, **(white | {"base_color": BLACK}))
        assert both == pytest.approx(1.0 + alone, abs=1e-6)
    assert of("standard", 0.1, roughness=0.3, **white) > 1.3


def test_burley_passes_one_at_grazing_angles_only_where_it_is_rough() -> None:
    cosines = (1e-6, 0.05, 0.3, 0.6, 1.0)
    rough = [of("burley_diffuse", c, albedo=WHITE, roughness=1.0) for c in cosines]
    smooth = [of("burley_diffuse", c, albedo=WHITE, roughness=0.0) for c in cosines]
    np.testing.assert_allclose(rough, [1.5575, 1.4636, 1.1510, 1.0405, 1.0357], atol=1e-4)
    assert rough[0] == pytest.approx(3 / 2 + 1 / 28 + 1 / 56 + 1 / 252, abs=1e-4)
    assert max(smooth) < 1.0
    assert np.argsort(smooth).tolist() == [0, 1, 2, 3, 4]


def test_sheen_by_fitted_masking_returns_less_than_came_and_by_the_shorter_one_more() -> None:
    grid, area = upper_grid()
    wo = towards(0.05, len(grid))
    alpha = 0.04
    value = MODELS["sheen"].f({"color": WHITE, "roughness": 0.2}, wo, grid)[:, 0]
    fitted = float((value * grid[:, 2] * area[:, 0]).sum())
    wh = wo + grid
    sine2 = 1.0 - (wh[:, 2] ** 2 / (wh * wh).sum(axis=1))
    D = (2 + 1 / alpha) * sine2 ** (0.5 / alpha) / (2 * np.pi)
    short = D / (4 * (wo[:, 2] + grid[:, 2] - wo[:, 2] * grid[:, 2]))
    assert fitted == pytest.approx(0.813, abs=2e-3)
    assert float((short * grid[:, 2] * area[:, 0]).sum()) == pytest.approx(1.289, abs=2e-3)


@pytest.mark.parametrize("n", [1.0, 4.0, 8.0, 40.0])
def test_highlights_are_normalised_for_a_view_along_the_normal(n: float) -> None:
    lobe: dict[str, Any] = {"diffuse": BLACK, "specular": WHITE, "exponent": n}
    for name in ("phong", "phong_reciprocal", "blinn_phong"):
        assert of(name, 1.0, **lobe) == pytest.approx(1.0, abs=1e-4), name
        assert max(of(name, c, **lobe) for c in (0.1, 0.4, 0.8)) < 1.0, name
    exact = 8 * np.pi * (n + 2 ** (-n / 2)) / ((n + 2) * (n + 4))
    fitted = of("blinn_phong_fitted", 1.0, **lobe)
    assert fitted == pytest.approx((n + 8) / (8 * np.pi) * exact, abs=1e-4)
    assert 1.0 < fitted < 1.077


def test_oren_and_nayar_lose_what_bounces_between_facets() -> None:
    straight = [of("oren_nayar_qualitative", 1.0, albedo=WHITE, sigma=s) for s in (0.0, 0.5, 1.0)]
    # Straight on the second term is 0: A alone.
    expected = [1 - 0.5 * s * s / (s * s + 0.33) for s in (0.0, 0.5, 1.0)]
    np.testing.assert_allclose(straight, expected, rtol=1e-6)


def worst(model: BsdfModel, **parameters: Any) -> float:
    return max(float(albedo(model, parameters, c).max()) for c in (0.03, 0.1, 0.3, 0.6, 1.0))


@pytest.mark.parametrize("sigma", [0.2, 0.5, 1.0])
def test_oren_and_nayar_return_most_at_grazing_angles(sigma: float) -> None:
    most = worst(MODELS["oren_nayar_qualitative"], albedo=WHITE, sigma=sigma)
    assert most == pytest.approx({0.2: 1.0138, 0.5: 0.9467, 1.0: 0.8264}[sigma], abs=1e-4)


@pytest.mark.parametrize("slope", [0.1, 0.4, 0.8])
def test_cook_and_torrance_stay_below_one(slope: float) -> None:
    assert 0.5 < worst(MODELS["cook_torrance"], f0=WHITE, slope=slope) < 1.001
