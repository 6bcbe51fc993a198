"""Oren and Nayar's plaster with all its terms, and the form that gives all light back."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.bsdf import BsdfModel, registry

from support.bsdf_proofs import hemisphere, towards, upper_grid

MODELS = registry()
FULL, WHOLE = MODELS["oren_nayar_full"], MODELS["oren_nayar_energy_preserving"]
WHITE = np.ones(3)
COSINES = (0.01, 0.1, 0.4, 0.8, 1.0)
GRID, AREA = upper_grid(60, 128)  # lobes as wide as these need no more
WO, WI = (hemisphere(300, seed=21, stream=k) for k in (1, 2))


def albedo(model: BsdfModel, parameters: dict[str, Any], cosine: float) -> Any:
    """The part (3,) of light that leaves."""
    value = model.f(parameters, towards(cosine, len(GRID)), GRID)
    return (value * GRID[:, 2:] * AREA).sum(axis=0)


def published(albedo: Any, sigma: float, mistake: str = "") -> Any:
    """f (N, 3) by angles, as the paper has it; `mistake` names a term to get wrong."""
    theta = np.arccos(WO[:, 2]), np.arccos(WI[:, 2])
    phi = [np.arctan2(w[:, 1], w[:, 0]) for w in (WO, WI)]
    c = np.cos(phi[0] - phi[1])
    a, b = np.maximum(*theta), np.minimum(*theta)
    if mistake == "alpha and beta exchanged":
        a, b = b, a
    v = sigma**2
    first = 1 - 0.5 * v / (v + 0.33)
    second = 0.45 * v / (v + 0.09) * (np.sin(a) - np.where(c < 0, (2 * b / np.pi) ** 3, 0))
    if mistake == "one branch":
        second = 0.45 * v / (v + 0.09) * np.sin(a)
    third = 0.125 * v / (v + 0.09) * (4 * a * b / np.pi**2) ** 2
    if mistake == "two terms":
        third = 0 * third
    direct = first + c * second * np.tan(b) + (1 - np.abs(c)) * third * np.tan((a + b) / 2)
    twice = 0.17 * v / (v + 0.13) * (1 - c * (2 * b / np.pi) ** 2)
    if mistake == "no second bounce":
        twice = 0 * twice
    power = 1 if mistake == "second bounce by albedo" else 2
    return (np.outer(direct, albedo) + np.outer(twice, albedo**power)) / np.pi


MISTAKES = (
    "alpha and beta exchanged",
    "one branch",
    "two terms",
    "no second bounce",
    "second bounce by albedo",
)


@pytest.mark.parametrize("sigma", [0.1, 0.5, 1.0])
def test_all_terms_are_those_of_the_paper(sigma: float) -> None:
    color = np.array([0.9, 0.5, 0.2])
    found = FULL.f({"albedo": color, "sigma": sigma}, WO, WI)
    assert found.min() > 0
    np.testing.assert_allclose(found, published(color, sigma), rtol=1e-11)  # measured 6e-14
    for mistake in MISTAKES:
        gap = np.abs(found / published(color, sigma, mistake) - 1.0).max()
        assert gap > (1e-3 if sigma < 0.5 else 0.02), mistake


@pytest.mark.parametrize("name", ["oren_nayar_full", "oren_nayar_energy_preserving"])
def test_without_roughness_both_are_lambert(name: str) -> None:
    color = np.array([0.2, 0.5, 0.8])
    rough = "sigma" if name == "oren_nayar_full" else "roughness"
    plain = MODELS["lambert"].f({"albedo": color}, WO, WI)
    found = MODELS[name].f({"albedo": color, rough: 0.0}, WO, WI)
    np.testing.assert_allclose(found, plain, rtol=1e-14)


def test_what_the_second_bounce_brings_back() -> None:
    white: dict[str, Any] = {"albedo": WHITE, "sigma": 1.0}
    assert albedo(FULL, white, 1.0)[0] == pytest.approx(0.7745, abs=1e-4)
    qualitative = albedo(MODELS["oren_nayar_qualitative"], white, 1.0)[0]
    assert qualitative == pytest.approx(1 - 0.5 / 1.33, abs=1e-6)
    # The fit gains most at the horizon, where the claim holds it.
    most = albedo(FULL, {"albedo": WHITE, "sigma": 0.3}, 1e-3)[0]
    assert most == pytest.approx(1.0503, abs=2e-4)
    assert FULL.energy == ("gains", 1.051)


def test_where_the_fit_is_below_zero_there_is_no_light_and_no_derivative() -> None:
    low = np.array([[np.sqrt(1 - 0.05**2), 0.0, 0.05]])
    across = low * [-1.0, 1.0, 1.0]
    color = np.array([0.02, 0.02, 1.0])
    parameters = {"albedo": color, "sigma": 1.0}
    value = FULL.f(parameters, low, across)[0]
    np.testing.assert_array_equal(value[:2], 0.0)
    assert value[2] > 0.05
    d = FULL.f_backward(parameters, low, across, np.ones((1, 3)))
    np.testing.assert_array_equal(d["albedo"][0, :2], 0.0)
    assert d["albedo"][0, 2] > 0


@pytest.mark.parametrize("roughness", [0.0, 0.3, 1.0])
def test_white_plaster_returns_all_light_for_every_view(roughness: float) -> None:
    white = {"albedo": WHITE, "roughness": roughness}
    found = [albedo(WHOLE, white, c)[0] for c in COSINES]
    np.testing.assert_allclose(found, 1.0, atol=5e-5)  # quadrature: 2e-5


@pytest.mark.parametrize("roughness", [0.3, 1.0])
def test_gray_plaster_loses_what_each_bounce_takes(roughness: float) -> None:
    k1, k2 = 0.5 - 2 / (3 * np.pi), 2 / 3 - 28 / (15 * np.pi)
    once = 1e-6  # so dark that one bounce is all there is
    first = [
        albedo(WHOLE, {"albedo": once * WHITE, "roughness": roughness}, c)[0] / once
        for c in COSINES
    ]
    average = (1 + k2 * roughness) / (1 + k1 * roughness)
    nodes, weights = np.polynomial.legendre.leggauss(12)
    dark = {"albedo": once * WHITE, "roughness": roughness}
    mean = sum(
        w * c * albedo(WHOLE, dark, c)[0] / once
        for c, w in zip(0.5 * (nodes + 1), weights, strict=True)
    )
    assert mean == pytest.approx(average, abs=1e-4)
    # rho E + rho^2 (1 - E) E + rho^3 ...: what has not left meets the next facet.
    rho = 0.6
    more = rho**2 * average / (1 - rho * (1 - average))
    expected = [rho * e + more * (1 - e) for e in first]
    found = [albedo(WHOLE, {"albedo": rho * WHITE, "roughness": roughness}, c)[0] for c in COSINES]
    np.testing.assert_allclose(found, expected, atol=5e-5)
    # The mistakes that white does not show: one factor of the albedo, or no end of bounces.
    for wrong in (rho * average / (1 - rho * (1 - average)), rho**2, rho**2 * average):
        gap = max(abs(wrong - more) * (1 - e) for e in first)
        assert gap > 3e-4
