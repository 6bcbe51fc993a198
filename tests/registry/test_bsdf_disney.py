"""Burley's principled model against the paper's own arrangement of it, and its limits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.bsdf import registry

from support.bsdf_proofs import hemisphere, near_mirror, towards, upper_grid

MODELS = registry()
MODEL = MODELS["disney"]
WO = hemisphere(300, seed=61, stream=1)
WI = hemisphere(300, seed=61, stream=2)
WI[::2] = near_mirror(WO[::2], seed=61, stream=3)
SLIDERS = {
    "subsurface": 0.3,
    "metalness": 0.4,
    "specular": 0.7,
    "specular_tint": 0.6,
    "roughness": 0.45,
    "anisotropic": 0.5,
    "sheen": 0.8,
    "sheen_tint": 0.7,
    "clearcoat": 0.9,
    "clearcoat_gloss": 0.4,
}
COLOR = np.array([0.8, 0.3, 0.1])


def published(p: dict[str, Any], base: Any, mistake: str = "") -> Any:
    """f (N, 3) in one sum, f0 mixed by metalness, as the paper's code has it."""
    h = WO + WI
    h = h / np.linalg.norm(h, axis=1, keepdims=True)
    d, o, i = (WO * h).sum(axis=1), WO[:, 2], WI[:, 2]
    rough, metal = p["roughness"], p["metalness"]
    fo, fi, fd = ((1 - c) ** 5 for c in (o, i, d))
    y = base @ [0.3, 0.6, 0.1]
    tint = np.ones(3) if mistake == "tint" else base / y

    def mix(a: Any, b: Any, t: Any) -> Any:
        return a + t * (b - a)

    f0 = mix(p["specular"] * 0.08 * mix(1.0, tint, p["specular_tint"]), base, metal)
    f90 = 0.5 + 2 * d * d * rough
    diffuse = mix(1, f90, fo) * mix(1, f90, fi)
    f90 = d * d * rough * (2 if mistake == "subsurface" else 1)
    inside = 1.25 * (mix(1, f90, fo) * mix(1, f90, fi) * (1 / (o + i) - 0.5) + 0.5)
    aspect = np.sqrt(1 - 0.9 * p["anisotropic"])
    ax, ay = rough**2 / aspect, rough**2 * aspect
    if mistake == "axes":
        ax, ay = ay, ax
    q = (h[:, 0] / ax) ** 2 + (h[:, 1] / ay) ** 2 + h[:, 2] ** 2
    D = 1 / (np.pi * ax * ay * q * q)

    def masked(c: Any, alpha: float) -> Any:
        return 1 / (c + np.sqrt(alpha**2 + c * c - alpha**2 * c * c))

    alpha = rough**2 if mistake == "masking" else (0.5 + rough / 2) ** 2
    G = masked(o, alpha) * masked(i, alpha)
    gloss = mix(0.1, 0.001, p["clearcoat_gloss"])
    power = gloss if mistake == "gloss" else gloss**2
    D1 = (power - 1) / (np.pi * np.log(power) * (1 + (power - 1) * h[:, 2] ** 2))
    coat = 0.25 * p["clearcoat"] * D1 * mix(0.04, 1, fd) * masked(o, 0.25) * masked(i, 0.25)
    sheen = np.outer(fd * p["sheen"], mix(1.0, tint, p["sheen_tint"]))
    ground = np.outer(mix(diffuse, inside, p["subsurface"]) / np.pi, base) + sheen
    fresnel = f0 + np.outer(fd, 1 - f0)
    if mistake == "coat under metal":
        coat = coat * (1 - metal)
    return (1 - metal) * ground + (G * D)[:, None] * fresnel + coat[:, None]


MISTAKES = ("tint", "subsurface", "axes", "masking", "gloss", "coat under metal")


def test_blended_lobes_are_the_papers_one_lobe() -> None:
    found = MODEL.f({"base_color": COLOR, **SLIDERS}, WO, WI)
    np.testing.assert_allclose(found, published(SLIDERS, COLOR), rtol=1e-11)  # measured 4e-14
    for mistake in MISTAKES:
        gap = np.abs(found / published(SLIDERS, COLOR, mistake) - 1.0).max()
        assert gap > 0.01, mistake


@pytest.mark.parametrize("name", sorted(SLIDERS))
@pytest.mark.parametrize("end", [0.0, 1.0])
def test_each_slider_at_its_ends(name: str, end: float) -> None:
    end = max(end, 0.045) if name == "roughness" else end
    given = {**SLIDERS, name: end}
    found = MODEL.f({"base_color": COLOR, **given}, WO, WI)
    np.testing.assert_allclose(found, published(given, COLOR), rtol=1e-10)
    middle = MODEL.f({"base_color": COLOR, **SLIDERS}, WO, WI)
    assert np.abs(found / middle - 1.0).max() > 0.01


def test_black_has_the_hue_of_white() -> None:
    black = MODEL.f({"base_color": np.zeros(3), **SLIDERS}, WO, WI)
    assert black.min() > 0
    np.testing.assert_allclose(black, black[:, :1] * np.ones(3), rtol=1e-12)


def test_a_bare_ground_is_burleys() -> None:
    # No highlight of its own, but Schlick's ramp of f0 = 0 stays: the difference has no color.
    bare = {**dict.fromkeys(SLIDERS, 0.0), "roughness": 0.6}
    found = MODEL.f({"base_color": COLOR, **bare}, WO, WI)
    ground = MODELS["burley_diffuse"].f({"albedo": COLOR, "roughness": 0.6}, WO, WI)
    rest = found - ground
    np.testing.assert_allclose(rest, rest[:, :1] * np.ones(3), atol=1e-14)
    assert rest.min() >= 0


@pytest.mark.parametrize("gloss", [0.0, 0.5, 1.0])
def test_coats_facets_cover_the_surface_once(gloss: float) -> None:
    # int D cos, with tan = alpha x / (1 - x) as in the proof of the other facets; D is what two
    # coats differ by, over Fresnel and masking, for light and view along the facet's normal.
    count = 4000
    x = (np.arange(count) + 0.5) / count
    alpha = 0.1 - 0.099 * gloss
    tangent, slope = alpha * x / (1 - x), alpha / (1 - x) ** 2
    c = 1 / np.sqrt(1 + tangent**2)
    w = np.stack([tangent * c, np.zeros(count), c], axis=1)
    given = {**SLIDERS, "clearcoat_gloss": gloss, "base_color": COLOR}
    f = [MODEL.f({**given, "clearcoat": k}, w, w)[:, 0] for k in (1.0, 0.0)]
    masked = 1 / (c + np.sqrt(0.0625 + (1 - 0.0625) * c * c))
    D = 4 * (f[0] - f[1]) / (0.04 * masked**2)
    whole = (D * c * 2 * np.pi * tangent * c**3 * slope).sum() / count
    assert whole == pytest.approx(1.0, abs=2e-3)


def test_light_returned_at_the_worst() -> None:
    grid, area = upper_grid(60, 256)
    all_up = {
        **dict.fromkeys(SLIDERS, 1.0),
        "metalness": 0.0,
        "subsurface": 0.0,
        "clearcoat_gloss": 0.0,
        "base_color": np.array([0.0, 0.0, 1.0]),
    }
    wo = np.tile([1.0, 0.0, 1e-5], (len(grid), 1))  # along the smooth direction's tangent
    blue = (MODEL.f(all_up, wo, grid) * grid[:, 2:] * area).sum(axis=0)
    assert blue[2] == pytest.approx(3.80, abs=0.01)
    assert MODEL.energy == ("gains", 3.81)
    white = {**all_up, "base_color": np.ones(3)}
    wo = towards(1e-4, len(grid))
    value = (MODEL.f(white, wo, grid) * grid[:, 2:] * area).sum(axis=0)
    assert value[0] == pytest.approx(1.82, abs=0.01)
