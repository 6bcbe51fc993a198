"""Wrong occluders in fog: every mutant must be killed.

As in test_media_mutants, a twin in NumPy sums up recorded paths forwards. It works out anew what
covering in part does: to the image, and to its derivative with respect to alpha.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from photograd.transport import PathOptions, PathTracer, derivative_image

from tests.transport.media_scenes import FOG, smoke
from tests.transport.test_alpha import gray
from tests.transport.test_media_alpha import veiled

SEED, SPP, SIZE, ALPHA = 4, 60, 3, 0.4
OPTIONS = PathOptions(max_depth=6, roulette_from=3, sampler="independent")
MEDIA = {"even": FOG, "grid": smoke()}
WRONG_PICTURE = {
    "chance forgotten": "alpha and 1 - alpha, though one of the two ways was drawn",
    "covered twice": "what passes is weighed at the surface it has passed and at the next",
    "veils let all through": "a shadow ray does not lose what veils keep",
    "veils block": "a shadow ray ends at the first veil",
    "clear behind veils": "a shadow ray that has met a veil forgets what media take",
}
WRONG_GRADIENT = {
    "coverage held": "alpha of the way that was drawn",
    "same sign": "what passes falls with alpha, too",
    "veils held": "alpha of the veils before a light",
}


@cache
def tracer(name: str) -> PathTracer:
    return PathTracer(veiled(gray(ALPHA), MEDIA[name], size=SIZE), dtype=np.float64)


@cache
def paths(name: str) -> list[list[dict[str, Any]]]:
    return [
        tracer(name).path(pixel, sample, seed=SEED, options=OPTIONS)
        for pixel in range(SIZE * SIZE)
        for sample in range(SPP)
    ]


def product(steps: Any) -> Any:
    return np.prod([np.ones(3), *(np.array(value) for *_, value in steps)], axis=0)


def cover(passed: bool, wrong: str | None) -> tuple[float, float]:
    """The weight of a vertex on the card, and its derivative with respect to alpha."""
    stays = 0.025 + 0.95 * ALPHA
    if wrong == "chance forgotten":
        stays = 0.5
    weight, slope = ALPHA / stays, 1 / stays
    if passed:
        weight, slope = (1 - ALPHA) / (1 - stays), -1 / (1 - stays)
        if wrong == "covered twice":
            weight *= weight
        if wrong == "same sign":
            slope = -slope
    return weight, 0.0 if wrong == "coverage held" else slope


def walked(path: list[dict[str, Any]], card: int, wrong: str | None = None) -> tuple[Any, Any]:
    """Radiance (3,) of a path, and its derivative with respect to the alpha of the card."""
    L, d_L, beta, d = np.zeros(3), np.zeros(3), np.ones(3), np.zeros(3)
    for v in path:
        arrival = product(v["events"]) / np.mean(v["pdf_channels"])
        beta, d = beta * arrival, d * arrival
        if v["shape"] == card:
            weight, slope = cover(v["is_null"], wrong)
            beta, d = beta * weight, d * weight + beta * slope
        met = np.array(v["Le"]) * v["emission_weight"]
        L, d_L = L + beta * met, d_L + d * met
        if v["nee_weight"] > 0:
            through = v["nee_alpha_transmittance"]
            veils = round(np.log(through) / np.log(1 - ALPHA))
            T = product(v["nee_events"])
            if wrong == "clear behind veils" and veils:
                T = np.ones(3)
            if wrong == "veils let all through":
                through = 1.0
            if wrong == "veils block" and veils:
                through = 0.0
            by_veils = -veils * (1 - ALPHA) ** (veils - 1)
            if wrong == "veils held":
                by_veils = 0.0
            sent = np.array(v["nee_f"]) * v["nee_Le"] * v["nee_weight"] * T
            L, d_L = L + beta * sent * through, d_L + (d * through + beta * by_veils) * sent
        onward = np.array(v["f"]) * v["weight"]
        beta, d = beta * onward, d * onward
    return L, d_L


@cache
def summed(name: str, wrong: str | None = None) -> Any:
    """(pixels, 2 kinds, 3 channels), means over the samples."""
    shapes = [shape.name for shape in tracer(name).scene.shapes]
    found = [walked(path, shapes.index("card"), wrong) for path in paths(name)]
    return np.array(found).reshape(-1, SPP, 2, 3).mean(axis=1)


@pytest.mark.parametrize("name", MEDIA)
def test_the_twin_agrees_with_the_core(name: str) -> None:
    seen = {
        v["nee_alpha_transmittance"] for path in paths(name) for v in path if v["nee_weight"] > 0
    }
    assert len(seen) >= 2  # lights without an occluder, and behind one
    twin = summed(name)
    picture = tracer(name).render(spp=SPP, seed=SEED, options=OPTIONS).mean.reshape(-1, 3)
    assert picture.min() > 0.01
    np.testing.assert_allclose(twin[:, 0], picture, rtol=1e-11)
    ones = np.ones((SIZE, SIZE, 3))
    gradient = tracer(name).render_backward(ones, spp=SPP, seed=SEED, options=OPTIONS)
    _, tangent = derivative_image(
        tracer(name), "materials.card.alpha", spp=SPP, seed=SEED, options=OPTIONS
    )
    assert np.abs(tangent.mean).max() > 0.05
    largest = np.abs(tangent.mean).max()
    np.testing.assert_allclose(
        twin[:, 1], tangent.mean.reshape(-1, 3), rtol=1e-9, atol=1e-11 * largest
    )
    total = gradient["materials.card.alpha"]
    assert twin[:, 1].sum() == pytest.approx(float(total), rel=1e-9)


@pytest.mark.parametrize("wrong", WRONG_PICTURE)
def test_a_wrong_picture_dies(wrong: str) -> None:
    for name in MEDIA:
        right, mutant = summed(name)[:, 0], summed(name, wrong)[:, 0]
        # A hundred million times the twin's own rounding.
        assert np.abs(mutant - right).max() > 1e-3 * right.max(), name


@pytest.mark.parametrize("wrong", WRONG_GRADIENT)
def test_a_wrong_derivative_dies(wrong: str) -> None:
    for name in MEDIA:
        right, mutant = summed(name)[:, 1], summed(name, wrong)[:, 1]
        assert np.abs(mutant - right).max() > 1e-3 * np.abs(right).max(), name
