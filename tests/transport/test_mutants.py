"""Path tracers that have been written wrong in the wild: all must die.

A twin of gather and its adjoint in NumPy sums up recorded paths. Unchanged, it agrees with the core
to rounding. Each mutant has one thing wrong; those of the picture must leave the mean that sampling
by the BSDF alone gives, those of the derivative the core's derivative, which differences confirm.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from photograd.transport import Environment, Material, PathOptions, PathTracer, Scene, SphereShape
from photograd.transport.shapes import rectangle

from tests.transport.scenes import BLACK, FLOOR, LAMP, view

SEED, SPP, SIZE = 3, 224, 4
OPTIONS = PathOptions(max_depth=7, roulette_from=1)
WRONG_PICTURE = {
    "both counted": "light and BSDF samples in full: all light twice",
    "one heuristic each": "power for one strategy, balance for the other: weights do not add to 1",
    "one side only": "BSDF samples are weighed, light samples count in full",
    "measures mixed": "the density of the light per area, beside one per solid angle",
    "roulette not paid": "survivors are not divided by their probability",
    "cosine forgotten": "light samples without the cosine",
    "smooth lobe with a density": "a light behind glass is weighed as if glass had a density of 1",
    "lamp seen in full": "a lamp met by chance counts in full, though it was asked as well",
}
WRONG_GRADIENT = {
    "division by f": "what arrives is L / f: nothing at black surfaces",
    "weight of the next vertex": "the path's weight includes the vertex's own f",
    "light sample forgotten": "only the direction in which the path goes on",
    "continuation forgotten": "only the light sample",
    "emission ahead forgotten": "what arrives is without the emission at the next vertex",
    "roulette forgotten": "survival is missing in the derivative alone",
}


def power(p: float, q: float) -> float:
    return p * p / (p * p + q * q)


def balance(p: float, q: float) -> float:
    return p / (p + q)


@cache
def tracer() -> PathTracer:
    """A gray and a black floor tile, a ball of glass, a light and a dim sky."""
    shapes = (
        rectangle("floor", *FLOOR, "floor"),
        rectangle("tile", [-0.5, 0.02, 1.0], [1.0, 0, 0], [0, 0, -0.6], "tile"),
        SphereShape("ball", np.array([0.0, 0.75, 0.0]), 0.5, "glass"),
        rectangle("lamp", *LAMP, "tile", [6.0, 5.0, 4.0]),
    )
    materials = {
        "floor": Material("lambert", {"albedo": [0.8, 0.7, 0.6]}),
        "tile": BLACK,
        "glass": Material("glass", {"eta": 1.3, "tint": [1.0, 1.0, 1.0]}),
    }
    camera = view(SIZE, (0.0, 1.0, 2.4), (0.0, 0.3, 0.0))
    scene = Scene("m", shapes, materials, camera, Environment.constant(0.1))
    return PathTracer(scene, dtype=np.float64)


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


def emission_weight(path: list[dict[str, Any]], k: int, wrong: str | None) -> float:
    v = path[k]
    p, q = v["pdf"], v["emitter_pdf"]
    if wrong == "smooth lobe with a density" and k > 0 and p == 0:
        p = 1.0
    if p == 0 or q == 0 or wrong in ("both counted", "lamp seen in full"):
        return 1.0
    if wrong == "measures mixed":
        q *= 0.1  # cos / d^2 of some light
    return power(p, q)


def light_weight(v: dict[str, Any], wrong: str | None) -> float:
    if v["nee_weight"] == 0:
        return 0.0
    p, q = v["nee_pdf"], v["nee_bsdf_pdf"]
    share = power(p, q)
    if wrong in ("both counted", "one side only"):
        share = 1.0
    if wrong == "one heuristic each":
        share = balance(p, q)
    cosine = 1.0 if wrong == "cosine forgotten" else v["nee_cosine"]
    return float(share * cosine / p)


def radiance(path: list[dict[str, Any]], wrong: str | None = None) -> Any:
    L, beta = np.zeros(3), np.ones(3)
    for k, v in enumerate(path):
        L = L + beta * v["Le"] * emission_weight(path, k, wrong)
        L = L + beta * v["nee_f"] * v["nee_Le"] * light_weight(v, wrong)
        paid = v["survival"] if wrong == "roulette not paid" else 1.0
        beta = beta * v["f"] * v["weight"] * paid
    return L


def albedo_gradient(path: list[dict[str, Any]], shape: int, wrong: str | None = None) -> Any:
    """Derivative of the sum of channels by the albedo of a Lambertian shape; df = 1 / pi."""
    total, beta = np.zeros(3), np.ones(3)
    for k, v in enumerate(path):
        rest = path[k + 1 :]
        ahead = radiance(rest) if rest else np.zeros(3)
        if wrong == "emission ahead forgotten" and rest:
            ahead = ahead - rest[0]["Le"] * emission_weight(path, k + 1, None)
        after = beta * v["f"] * v["weight"]
        if v["shape"] == shape:
            own = after if wrong == "weight of the next vertex" else beta
            light = v["nee_Le"] * light_weight(v, None)
            onward = ahead * v["weight"]
            onward = onward * (v["survival"] if wrong == "roulette forgotten" else 1.0)
            if wrong == "division by f":
                onward = np.where(v["f"] > 0, onward, 0.0)
            total = total + own / np.pi * (
                (0 if wrong == "light sample forgotten" else light)
                + (0 if wrong == "continuation forgotten" else onward)
            )
        beta = after
    return total


def test_the_twin_agrees_with_the_core() -> None:
    core = tracer().render(spp=SPP, seed=SEED, options=OPTIONS).mean.reshape(-1, 3)
    twin = np.array([radiance(path) for path in paths()]).reshape(-1, SPP, 3).mean(axis=1)
    np.testing.assert_allclose(twin, core, rtol=1e-12)
    assert any(v["survival"] < 1 for path in paths() for v in path)
    assert any(v["lobe"] == 1 for path in paths() for v in path)
    ones = np.ones((SIZE, SIZE, 3))
    gradient = tracer().render_backward(ones, spp=SPP, seed=SEED, options=OPTIONS)
    for shape, name in ((0, "floor"), (1, "tile")):
        twin_gradient = sum(albedo_gradient(path, shape) for path in paths()) / SPP
        if name == "tile":  # the light has the same material
            twin_gradient = twin_gradient + sum(albedo_gradient(p, 2) for p in paths()) / SPP
        assert np.abs(twin_gradient).min() > 0.1
        core_gradient = gradient[f"materials.{name}.albedo"]
        np.testing.assert_allclose(twin_gradient, core_gradient, rtol=1e-10)


@cache
def truth() -> Any:
    """The mean of all pixels by the BSDF alone, and its standard error."""
    found = tracer().render(spp=8192, seed=99, options=PathOptions("bsdf", max_depth=7))
    return found.mean.mean(axis=(0, 1)), np.sqrt((found.standard_error**2).sum(axis=(0, 1))) / (
        SIZE * SIZE
    )


def z(values: Any, spread: Any = 0.0, mean: Any = 0.0) -> float:
    """How far the mean of values (paths, 3) is from `mean`, in its errors; pixels are strata."""
    strata = values.reshape(-1, SPP, 3)
    within = strata.std(axis=1, ddof=1) / np.sqrt(SPP)
    error = np.sqrt((within**2).sum(axis=0)) / len(strata)
    found: float = (np.abs(values.mean(axis=0) - mean) / np.hypot(error, spread)).max()
    return found


@cache
def right() -> Any:
    return np.array([radiance(path) for path in paths()])


def test_the_right_picture_lives() -> None:
    mean, spread = truth()
    assert z(right(), spread, mean) < 3.5  # false alarm: 1.4e-3, of one fixed seed


@pytest.mark.parametrize("wrong", WRONG_PICTURE)
def test_a_wrong_picture_dies(wrong: str) -> None:
    # On the same paths, so that the noise which both share does not hide the difference.
    mutant = np.array([radiance(path, wrong) for path in paths()])
    assert z(mutant - right()) > 4


@pytest.mark.parametrize("wrong", WRONG_GRADIENT)
def test_a_wrong_derivative_dies(wrong: str) -> None:
    errors = []
    for shape in (0, 1):
        right = sum(albedo_gradient(path, shape) for path in paths())
        mutant = sum(albedo_gradient(path, shape, wrong) for path in paths())
        errors.append(np.abs(mutant - right).max() / np.abs(right).max())
    assert max(errors) > 1e-3  # a million times the twin's own rounding
