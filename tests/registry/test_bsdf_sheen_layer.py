"""Sheen over a scaled base layer: energy conservation, limits, mistakes that violate it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.bsdf import registry

from support.bsdf_proofs import hemisphere, towards, upper_grid

MODELS = registry()
CLOTH, BASE, SHEEN = MODELS["gltf_sheen"], MODELS["gltf"], MODELS["sheen"]
GRID, AREA = upper_grid(64, 384)
WHITE = np.ones(3)
# A white metal that is rough never gains: whatever is over 1 comes from the layering.
METAL: dict[str, Any] = {"base_color": WHITE, "metalness": 1.0, "roughness": 0.4}
WO, WI = (hemisphere(200, seed=51, stream=k) for k in (1, 2))


def cloth(sheen: Any, roughness: float, base: dict[str, Any] = METAL) -> dict[str, Any]:
    return {"sheen_color_factor": sheen, "sheen_roughness_factor": roughness, **base}


def albedo(name: str, parameters: dict[str, Any], cosine: float) -> Any:
    """The part (3,) of light that leaves."""
    value = MODELS[name].f(parameters, towards(cosine, len(GRID)), GRID)
    return (value * GRID[:, 2:] * AREA).sum(axis=0)


@pytest.mark.parametrize("roughness", [0.3, 0.5, 0.8, 1.0])
def test_sheen_takes_from_the_base_what_it_returns(roughness: float) -> None:
    for cosine in (0.02, 0.1, 0.4, 1.0):
        total = albedo("gltf_sheen", cloth(WHITE, roughness), cosine)[0]
        sheen = albedo("sheen", {"color": WHITE, "roughness": roughness}, cosine)[0]
        base = albedo("gltf", METAL, cosine)[0]
        # The smaller of what both directions leave is at most what this one leaves.
        assert sheen < total < sheen + (1 - sheen) * base + 5e-3
        assert total < 1.003
    # Without the scaling the sum is not energy-conserving.
    grazing = [
        albedo("sheen", {"color": WHITE, "roughness": roughness}, 0.05)[0],
        albedo("gltf", METAL, 0.05)[0],
    ]
    assert sum(grazing) > 1.2


def test_no_sheen_is_the_base_to_the_bit() -> None:
    base = {"base_color": [0.9, 0.5, 0.2], "metalness": 0.3, "roughness": 0.4}
    bare = CLOTH.f(cloth(np.zeros(3), 0.5, base), WO, WI)
    np.testing.assert_array_equal(bare, BASE.f(base, WO, WI))


def test_over_black_there_is_sheen_alone() -> None:
    color = np.array([0.9, 0.5, 0.2])
    black: dict[str, Any] = {"base_color": np.zeros(3), "metalness": 1.0, "roughness": 1.0}
    found = CLOTH.f(cloth(color, 0.6, black), WO, WI)
    alone = SHEEN.f({"color": color, "roughness": 0.6}, WO, WI)
    # A black metal of f0 = 0 keeps Schlick's ramp.
    assert (found >= alone * (1 - 1e-12)).all()
    np.testing.assert_allclose(found - alone, (found - alone)[:, :1] * np.ones(3), atol=1e-14)


def test_the_most_of_the_color_dims_all_channels_alike() -> None:
    # Dimming each channel by its own sheen would give a red sheen a base of cyan.
    red = np.array([0.8, 0.0, 0.0])
    part = CLOTH.f(cloth(red, 0.5), WO, WI) - SHEEN.f({"color": red, "roughness": 0.5}, WO, WI)
    share = part / BASE.f(METAL, WO, WI)
    np.testing.assert_allclose(share, share[:, :1] * np.ones(3), rtol=1e-12)
    assert share.min() < 0.6
    assert share.max() < 1.0


@pytest.mark.parametrize("roughness", [0.3, 0.45, 0.7, 1.0])
def test_the_fitted_albedo_is_that_of_sheen(roughness: float) -> None:
    # Both directions alike: what the base lacks is E of that direction.
    for cosine in (0.01, 0.05, 0.2, 0.6, 1.0):
        w = towards(cosine)
        one = cloth(WHITE, roughness)
        part = CLOTH.f(one, w, w) - SHEEN.f({"color": WHITE, "roughness": roughness}, w, w)
        fitted = 1 - (part / BASE.f(METAL, w, w))[0, 0]
        exact = albedo("sheen", {"color": WHITE, "roughness": roughness}, cosine)[0]
        assert fitted == pytest.approx(exact, abs=5e-3)


def test_scaling_by_the_view_alone_would_not_be_reciprocal() -> None:
    one = cloth(WHITE, 0.5)
    np.testing.assert_allclose(CLOTH.f(one, WO, WI), CLOTH.f(one, WI, WO), rtol=1e-12)
    lacks = []
    for w in (WO, WI):
        part = CLOTH.f(one, w, w) - SHEEN.f({"color": WHITE, "roughness": 0.5}, w, w)
        lacks.append((part / BASE.f(METAL, w, w))[:, 0])
    both = CLOTH.f(one, WO, WI) - SHEEN.f({"color": WHITE, "roughness": 0.5}, WO, WI)
    np.testing.assert_allclose(
        (both / BASE.f(METAL, WO, WI))[:, 0], np.minimum(*lacks), rtol=1e-9, atol=1e-9
    )
    assert np.abs(lacks[0] - lacks[1]).max() > 0.2


def test_roughness_beyond_the_fit_takes_what_its_end_takes() -> None:
    w = towards(0.3)
    left = []
    for roughness in (0.2, 0.3):
        part = CLOTH.f(cloth(WHITE, roughness), w, w)
        part = part - SHEEN.f({"color": WHITE, "roughness": roughness}, w, w)
        left.append((part / BASE.f(METAL, w, w))[0, 0])
    assert left[0] == pytest.approx(left[1], rel=1e-9)
