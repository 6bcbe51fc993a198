"""GGX mirrors that get back what they lose: the furnace, its fits, and mistakes that show."""

from __future__ import annotations

import importlib.util
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from photograd.bsdf import BsdfModel, registry

from support.bsdf_proofs import hemisphere, towards, upper_grid
from support.tree import ROOT


def load_tool() -> ModuleType:
    spec = importlib.util.spec_from_file_location("fit_albedo", ROOT / "tools" / "fit_albedo.py")
    assert spec is not None
    assert spec.loader is not None
    tool = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tool)
    return tool


MODELS = registry()
WHOLE, LOSSY = MODELS["ggx_metal_compensated"], MODELS["ggx_metal"]
WHITE = np.ones(3)
GRID, AREA = upper_grid(64, 384)
TOOL = load_tool()


def albedo(model: BsdfModel, cosine: float, **parameters: Any) -> Any:
    """The part (3,) of light that leaves."""
    value = model.f(parameters, towards(cosine, len(GRID)), GRID)
    return (value * GRID[:, 2:] * AREA).sum(axis=0)


def test_white_mirrors_return_all_light() -> None:
    # Sharp lobes are summed over facets (TOOL), the glow over directions. Worst at the
    # horizon: 0.0073 at cosine 0.01, roughness 1; from cosine 0.03 on 0.005.
    for roughness in (0.1, 0.25, 0.45, 0.7, 1.0):
        for cosine in (0.01, 0.03, 0.1, 0.3, 0.6, 1.0):
            given: dict[str, Any] = {"f0": WHITE, "roughness": roughness}
            wo = towards(cosine, len(GRID))
            glow = (WHOLE.f(given, wo, GRID) - LOSSY.f(given, wo, GRID))[:, 0]
            lobe = 1.0 - TOOL.ggx_loss(cosine, roughness, 64, 64)
            total = lobe + float((glow * GRID[:, 2] * AREA[:, 0]).sum())
            assert total == pytest.approx(1.0, abs=8e-3), f"{roughness}, {cosine}"
    # The same by directions alone, where the lobe is wide.
    for cosine in (0.1, 0.6, 1.0):
        assert albedo(WHOLE, cosine, f0=WHITE, roughness=0.8)[0] == pytest.approx(1.0, abs=6e-3)
        assert albedo(LOSSY, cosine, f0=WHITE, roughness=0.8)[0] < 0.9
    assert WHOLE.energy == ("gains", 1.006)


def test_each_bounce_takes_its_share() -> None:
    # Averaged over views, what leaves after k bounces is A^k E (1 - E)^(k - 1); k = 1 is the lobe.
    roughness, f0 = 1.0, np.array([1.0, 0.6, 0.1])
    nodes, weights = np.polynomial.legendre.leggauss(10)
    views = list(zip(0.5 * (nodes + 1.0), weights, strict=True))
    E = sum(w * c * albedo(LOSSY, c, f0=WHITE, roughness=roughness)[0] for c, w in views)
    glow = sum(
        w
        * c
        * (
            albedo(WHOLE, c, f0=f0, roughness=roughness)
            - albedo(LOSSY, c, f0=f0, roughness=roughness)
        )
        for c, w in views
    )
    nodes, weights = np.polynomial.legendre.leggauss(8)
    c = 0.5 * (nodes + 1.0)
    ramp = (weights * c * (1 - c) ** 5).sum()
    A = f0 + (1.0 - f0) * ramp
    np.testing.assert_allclose(A, (20 * f0 + 1) / 21, rtol=1e-12)
    expected = sum(A**k * E * (1 - E) ** (k - 1) for k in range(2, 60))
    np.testing.assert_allclose(glow, expected, atol=2e-3)
    # One factor of A too few, two bounces only, and F at the horizon in place of the mean.
    q = 1 - A * (1 - E)
    for wrong in (A * E / q, A**2 * E, f0**2 * E / q):
        assert np.abs(wrong * (1 - E) - expected).max() > 8e-3


def test_more_bounces_deepen_a_color() -> None:
    gold = np.array([1.0, 0.78, 0.34])
    once, all_light = (albedo(m, 0.8, f0=gold, roughness=1.0) for m in (LOSSY, WHOLE))
    assert all_light[2] / all_light[0] < 0.9 * once[2] / once[0]


def test_scaling_the_lobe_instead_is_not_reciprocal() -> None:
    # f (1 + f0 (1 - E(wo)) / E(wo)): all light as well, and another value with wo and wi exchanged.
    wo, wi = (hemisphere(100, seed=41, stream=k) for k in (1, 2))
    loss = [
        np.array([1 - albedo(LOSSY, z, f0=WHITE, roughness=1.0)[0] for z in w[:20, 2]])
        for w in (wo, wi)
    ]
    scale = [1 + x / (1 - x) for x in loss]
    assert np.abs(scale[0] / scale[1] - 1).max() > 0.2
    given: dict[str, Any] = {"f0": WHITE, "roughness": 1.0}
    there, back = WHOLE.f(given, wo, wi), WHOLE.f(given, wi, wo)
    np.testing.assert_allclose(there, back, rtol=1e-12)


def test_the_fits_are_those_of_the_quadrature() -> None:
    for header, fits in (("ggx_loss.h", TOOL.fit_ggx()), ("charlie_albedo.h", TOOL.fit_charlie())):
        for name, numbers in fits.items():
            # Six digits are written down.
            np.testing.assert_allclose(TOOL.committed(header, name), numbers, atol=1e-5)
    # And the quadrature is that of the model: another sum, over directions in place of facets.
    for cosine, roughness in ((0.1, 0.5), (0.6, 0.8), (1.0, 1.0)):
        other = 1 - albedo(LOSSY, cosine, f0=WHITE, roughness=roughness)[0]
        assert TOOL.ggx_loss(cosine, roughness) == pytest.approx(other, abs=1.5e-3)
    for cosine, roughness in ((0.1, 0.4), (0.6, 0.8)):
        other = albedo(MODELS["sheen"], cosine, color=WHITE, roughness=roughness)[0]
        assert TOOL.charlie_albedo(cosine, roughness) == pytest.approx(other, abs=2e-4)
