"""Volumetric path tracers that have been written wrong: all must die.

A twin in NumPy sums up recorded paths, and their derivatives, forwards where the core goes
backwards. Unchanged, it agrees with the core to rounding; each mutant has one thing wrong.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from photograd.lights import PointLight
from photograd.transport import PathOptions, PathTracer

from tests.transport.media_scenes import FOG, ball_of, fog_box, smoke

SEED, SPP, SIZE = 3, 160, 3
OPTIONS = PathOptions(max_depth=5, roulette_from=2, sampler="independent")
THROUGH, COLLIDE, PASS = 0, 1, 2
LIGHT = PointLight([0.8, 1.6, 0.9], [5.0, 4.0, 3.0])
SCENES = {
    "even": lambda: ball_of(FOG, size=SIZE, lights=(LIGHT,), sky=0.3, floor=True),
    "grid": lambda: fog_box(smoke(), size=SIZE),
}
WRONG_PICTURE = {
    "one channel's density": "divided by the density of red, though any channel may have drawn",
    "light through fog": "nothing is lost on the way from a light",
    "camera through fog": "nothing is lost on the way to a vertex",
    "albedo forgotten": "all that is lost is scattered",
    "coefficient forgotten": "a collision without sigma_s: a density per meter is left",
    "null collisions free": "what passes a null collision is not weighed by sigma_n",
    "phase turned round": "the phase function of the angle between wo and wi",
}
WRONG_GRADIENT = {
    "transmittance held": "sigma_t of the way between vertices",
    "light's transmittance held": "sigma_t of the way from a light",
    "coefficient held": "sigma_t at collisions",
    "null collisions held": "sigma_t at null collisions",
    "sampling differentiated": "the density of the distance, though it is what was drawn",
    "light's phase held": "g where a light is asked",
    "onward phase held": "g where the path goes on",
}
GRID_ALONE = ("null collisions free", "null collisions held")
EVEN_ALONE = ("camera through fog", "transmittance held", "sampling differentiated")


@cache
def tracer(name: str) -> PathTracer:
    return PathTracer(SCENES[name](), dtype=np.float64)


@cache
def paths(name: str) -> list[list[dict[str, Any]]]:
    found = [
        tracer(name).path(pixel, sample, seed=SEED, options=OPTIONS)
        for pixel in range(SIZE * SIZE)
        for sample in range(SPP)
    ]
    for path in found:
        for v in path:
            for key in (
                "Le",
                "nee_f",
                "nee_Le",
                "f",
                "pdf_channels",
                "direction",
                "wi",
                "nee_direction",
            ):
                v[key] = np.array(v[key])
            for key in ("events", "nee_events"):
                v[key] = [(kind, length, np.array(value)) for _, kind, length, _, value in v[key]]
    return found


def phase(cosine: float, g: float) -> float:
    return float((1 - g * g) / (4 * np.pi * (1 + g * g - 2 * g * cosine) ** 1.5))


def d_phase(cosine: float, g: float, step: float = 1e-6) -> float:
    return (phase(cosine, g + step) - phase(cosine, g - step)) / (2 * step)


def medium_of(name: str) -> dict[str, Any]:
    (key,) = tracer(name).scene.media
    return {n: tracer(name).params[f"media.{key}.{n}"] for n in ("sigma_t", "albedo", "g")}


def product(steps: Any, name: str, wrong: str | None, *, shadow: bool) -> tuple[Any, Any]:
    """The product of the steps of a segment, and its derivative w.r.t. sigma_t, per channel."""
    m = medium_of(name)
    sigma, value, slope = m["sigma_t"], np.ones(3), np.zeros(3)
    for kind, length, x in steps:
        one = x
        d = {THROUGH: -length * x, COLLIDE: x / sigma, PASS: (x - 1) / sigma}[kind]
        lost = kind != COLLIDE
        if wrong == "light through fog" and shadow and lost:
            one = np.ones(3)
        if wrong == "camera through fog" and not shadow and lost:
            one = np.ones(3)
        if wrong == "albedo forgotten" and kind == COLLIDE:
            one = x / m["albedo"]
        if wrong == "coefficient forgotten" and kind == COLLIDE:
            one = x / sigma
        if wrong == "null collisions free" and kind == PASS:
            one = np.ones(3)
        held = {
            "transmittance held": kind == THROUGH and not shadow,
            "light's transmittance held": lost and shadow,
            "coefficient held": kind == COLLIDE,
            "null collisions held": kind == PASS,
        }
        d = np.zeros(3) if held.get(str(wrong), False) else d
        slope = slope * one + value * d
        value = value * one
    return value, slope


def segment_weight(v: dict[str, Any], shares: Any, wrong: str | None) -> Any:
    if wrong == "one channel's density":
        return shares[0] / v["pdf_channels"][0]
    return 1 / v["pdf_channels"].mean()


def walked(path: list[dict[str, Any]], name: str, wrong: str | None = None) -> tuple[Any, Any, Any]:
    """Radiance (3,) of a path, and its derivatives with respect to sigma_t (3,) and g (3,)."""
    g = float(medium_of(name)["g"])
    L, d_sigma, d_g = np.zeros(3), np.zeros(3), np.zeros(3)
    beta, by_sigma, by_g, shares = np.ones(3), np.zeros(3), np.zeros(3), np.ones(3)
    for v in path:
        value, slope = product(v["events"], name, wrong, shadow=False)
        weight = segment_weight(v, shares, wrong)
        shares = v["pdf_channels"] / v["pdf_channels"].mean()
        if wrong == "sampling differentiated":
            slope = slope + value * sum(np.mean(x[1]) for x in v["events"] if x[0] == THROUGH) / 3
        by_sigma = (by_sigma * value + beta * slope) * weight
        beta, by_g = beta * value * weight, by_g * value * weight
        met = v["Le"] * v["emission_weight"]
        L, d_sigma, d_g = L + beta * met, d_sigma + by_sigma * met, d_g + by_g * met
        f, d_f, d_value = v["nee_f"], 0.0, 0.0
        if v["medium"] >= 0:
            c = float(v["direction"] @ v["nee_direction"])
            f = phase(-c, g) if wrong == "phase turned round" else f
            d_f = 0.0 if wrong == "light's phase held" else d_phase(c, g)
            held = wrong == "onward phase held"
            d_value = 0.0 if held else d_phase(float(v["direction"] @ v["wi"]), g)
        if v["nee_weight"] > 0:
            value, slope = product(v["nee_events"], name, wrong, shadow=True)
            sent = v["nee_Le"] * v["nee_weight"]
            L = L + beta * f * value * sent
            d_sigma = d_sigma + (by_sigma * value + beta * slope) * f * sent
            d_g = d_g + (by_g * f + beta * d_f) * value * sent
        by_g = (by_g * v["f"] + beta * d_value) * v["weight"]
        by_sigma, beta = by_sigma * v["f"] * v["weight"], beta * v["f"] * v["weight"]
    return L, d_sigma, d_g


@cache
def summed(name: str, wrong: str | None = None) -> Any:
    """(paths, 3 kinds, 3 channels)."""
    return np.array([walked(path, name, wrong) for path in paths(name)])


@pytest.mark.parametrize("name", SCENES)
def test_the_twin_agrees_with_the_core(name: str) -> None:
    core = tracer(name).render(spp=SPP, seed=SEED, options=OPTIONS).mean.reshape(-1, 3)
    twin = summed(name).reshape(-1, SPP, 3, 3).mean(axis=1)
    assert core.min() > 0.01
    np.testing.assert_allclose(twin[:, 0], core, rtol=1e-11)
    ones = np.ones((SIZE, SIZE, 3))
    gradient = tracer(name).render_backward(ones, spp=SPP, seed=SEED, options=OPTIONS)
    (key,) = tracer(name).scene.media
    found = gradient[f"media.{key}.sigma_t"]
    assert np.abs(found).min() > 0.01
    np.testing.assert_allclose(twin[:, 1].sum(axis=0), found, rtol=1e-10)
    np.testing.assert_allclose(twin[:, 2].sum(), gradient[f"media.{key}.g"], rtol=1e-7)


def z(values: Any) -> float:
    """How far the mean of values (paths, 3) is from 0, in its errors; pixels are strata."""
    strata = values.reshape(-1, SPP, 3)
    within = strata.std(axis=1, ddof=1) / np.sqrt(SPP)
    error = np.sqrt((within**2).sum(axis=0)) / len(strata)
    return float((np.abs(values.mean(axis=0)) / error).max())


@pytest.mark.parametrize("wrong", WRONG_PICTURE)
def test_a_wrong_picture_dies(wrong: str) -> None:
    # On the same paths, so that the noise which both share does not hide the difference.
    name = "grid" if wrong in GRID_ALONE else "even"
    assert z(summed(name, wrong)[:, 0] - summed(name)[:, 0]) > 4


@pytest.mark.parametrize("wrong", WRONG_GRADIENT)
def test_a_wrong_derivative_dies(wrong: str) -> None:
    for name in SCENES:
        if wrong in (EVEN_ALONE if name == "grid" else GRID_ALONE):
            continue
        right, mutant = (summed(name, w)[:, 1:].sum(axis=0) for w in (None, wrong))
        error = np.abs(mutant - right).max(axis=1) / np.abs(right).max(axis=1)
        assert error.max() > 1e-3  # ten million times the twin's own rounding
