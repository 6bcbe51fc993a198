"""Mistakes with lights that have been made in the wild: a twin of the sum, each with one, must die.

As in test_mutants.py: unchanged, the twin agrees with the core; each mutant is compared on the same
paths, and must leave the mean by more than its noise.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from photograd.lights import PointLight, QuadLight
from photograd.transport import PathOptions, PathTracer

from tests.transport.light_scenes import environment_map, lit_by

SEED, SPP, SIZE = 3, 160, 4
OPTIONS = PathOptions(max_depth=5, roulette_from=None)
BACKGROUND, DELTA = -1, -3
WRONG = {
    "point light weighed": "a weight below 1, though no ray ever meets a point light",
    "map met in full": "a ray that escapes counts in full, though the map was asked as well",
    "lamp met in full": "the same for a lamp",
    "sine forgotten": "density over the map's picture instead of solid angle",
    "choice forgotten": "the density of a light's sample without the probability of the light",
    "area for solid angle": "the lamp's density is 1 / area",
    "map met never": "rays that escape are black: the part of the weight that they have is lost",
}
AREA = 0.25


@cache
def tracer() -> PathTracer:
    """A ball on a floor under a map, a point light and an area light."""
    lights = (
        environment_map(),
        PointLight([0.8, 1.6, 0.9], [3.0, 2.5, 2.0]),
        QuadLight([-0.3, 1.5, 0.0], [0.4, 0.0, -0.3], [0.3, 0.0, 0.4], [16.0, 13.0, 10.0]),
    )
    return PathTracer(lit_by(*lights, size=SIZE), dtype=np.float64)


@cache
def paths() -> list[list[dict[str, Any]]]:
    found = [
        tracer().path(pixel, sample, seed=SEED, options=OPTIONS)
        for pixel in range(SIZE * SIZE)
        for sample in range(SPP)
    ]
    for path in found:
        for v in path:
            for name in ("Le", "nee_f", "nee_Le", "f"):
                v[name] = np.array(v[name])
    return found


@cache
def probabilities() -> dict[str, float]:
    """Of the map, the point light and the area light."""
    entries, pmf = tracer()._geometry.choose_lights((np.arange(1000) + 0.5) / 1000)
    found = [float(pmf[entries == k][0]) for k in range(3)]
    assert sum(found) == pytest.approx(1.0)
    return dict(zip(("map", "point", "lamp"), found, strict=True))


def wrong_density(pdf: float, shape: int, direction: Any, wrong: str | None) -> float:
    """What a mutant takes a light's density for."""
    if wrong == "sine forgotten" and shape == BACKGROUND:
        return pdf * float(np.sqrt(1 - direction[1] ** 2))
    if wrong == "choice forgotten":
        name = {BACKGROUND: "map", DELTA: "point"}.get(shape, "lamp")
        return pdf / probabilities()[name]
    if wrong == "area for solid angle" and shape >= 0:
        return probabilities()["lamp"] / AREA
    return pdf


def power(p: float, q: float) -> float:
    return p * p / (p * p + q * q)


def met(v: dict[str, Any], wrong: str | None) -> Any:
    """Emission of a vertex, weighed."""
    p, q, shape = v["pdf"], v["emitter_pdf"], v["shape"]
    if wrong == "map met never" and shape == BACKGROUND and p > 0:
        return 0.0
    if p == 0 or q == 0:
        return v["Le"] * v["emission_weight"]
    if (wrong == "map met in full" and shape == BACKGROUND) or (
        wrong == "lamp met in full" and shape >= 0
    ):
        return v["Le"]
    return v["Le"] * power(p, wrong_density(q, shape, v["direction"], wrong))


def asked(v: dict[str, Any], wrong: str | None) -> Any:
    """What a light's sample adds."""
    if v["nee_weight"] == 0:
        return 0.0
    shape = v["nee_shape"]
    p = wrong_density(v["nee_pdf"], shape, v["nee_direction"], wrong)
    whole = shape == DELTA and wrong != "point light weighed"
    share = 1.0 if whole else power(p, v["nee_bsdf_pdf"])
    return v["nee_f"] * v["nee_Le"] * (share * v["nee_cosine"] / p)


def radiance(path: list[dict[str, Any]], wrong: str | None = None) -> Any:
    L, beta = np.zeros(3), np.ones(3)
    for v in path:
        L = L + beta * (met(v, wrong) + asked(v, wrong))
        beta = beta * v["f"] * v["weight"]
    return L


@cache
def right() -> Any:
    return np.array([radiance(path) for path in paths()])


def test_the_twin_agrees_with_the_core() -> None:
    core = tracer().render(spp=SPP, seed=SEED, options=OPTIONS).mean.reshape(-1, 3)
    np.testing.assert_allclose(right().reshape(-1, SPP, 3).mean(axis=1), core, rtol=1e-12)
    kinds = {v["nee_shape"] for path in paths() for v in path if v["nee_weight"] > 0}
    assert kinds == {BACKGROUND, DELTA, 1}  # the light is the second mesh


@pytest.mark.parametrize("wrong", WRONG)
def test_a_wrong_picture_dies(wrong: str) -> None:
    mutant = np.array([radiance(path, wrong) for path in paths()]) - right()
    strata = mutant.reshape(-1, SPP, 3)
    error = np.sqrt((strata.var(axis=1, ddof=1) / SPP).sum(axis=0)) / len(strata)
    assert (np.abs(mutant.mean(axis=0)) > 4 * error).all()
    # And by as much of the picture as anyone would see.
    assert (np.abs(mutant.mean(axis=0)) > 0.01 * right().mean(axis=0)).all()
