"""Every model under a normal map: shading normals that lean by up to 60 degrees gain no light."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.bsdf import registry
from photograd.transport import Material, NormalMap, PathOptions, PathTracer

from tests.transport.test_textures import wall

MODELS = registry()
ONE_BOUNCE = PathOptions("bsdf", max_depth=2, sampler="independent")


def leaning(most: float, size: int = 16) -> NormalMap:
    """By up to `most` degrees, any way."""
    g = np.random.default_rng(4)
    lean = np.radians(most) * np.sqrt(g.uniform(0, 1, (size, size)))
    turn = g.uniform(0, 2 * np.pi, (size, size))
    tilts = [np.sin(lean) * np.cos(turn), np.sin(lean) * np.sin(turn), np.cos(lean)]
    return NormalMap(np.stack(tilts, axis=-1))


def sideways(lean: float) -> NormalMap:
    """By `lean` degrees to the right, everywhere."""
    x = np.radians(lean)
    return NormalMap(np.broadcast_to([np.sin(x), 0.0, np.cos(x)], (2, 2, 3)).copy())


MAPS = {"any way": leaning(60.0), "sideways": sideways(60.0)}


def shown(name: str, fraction: float, bent: NormalMap | None, spp: int = 48) -> Any:
    """Radiance (3,) of a wall under an even sky of 1, and its error; what passes meets it, too."""
    values = MODELS[name].at(fraction)
    scene = wall(Material(name, values, {}, bent), {}, 12)
    found = PathTracer(scene, dtype=np.float64).render(spp=spp, seed=2, options=ONE_BOUNCE)
    error = np.sqrt((found.standard_error**2).sum(axis=(0, 1))) / 144
    return found.mean.mean(axis=(0, 1)), error


@pytest.mark.parametrize("bent", MAPS)
@pytest.mark.parametrize("name", MODELS)
def test_bent_normals_gain_no_light(name: str, bent: str) -> None:
    for fraction in (0.3, 1.0):
        mean, error = shown(name, fraction, MAPS[bent])
        assert mean.min() > 0.005  # 0.010 of a Beckmann metal
        _, most = MODELS[name].energy
        # False alarm: 3e-5 for each channel.
        assert (mean < most * 1.001 + 4 * error).all()
        assert (mean != shown(name, fraction, None, 2)[0]).any()


@pytest.mark.parametrize("lean", [20.0, 40.0, 60.0])
def test_what_leans_below_the_surface_is_lost(lean: float) -> None:
    # Of a cosine lobe that leans by x, (1 - cos x) / 2 lies below the surface: to count it would
    # show the whole albedo.
    mean, error = shown("lambert", 1.0, sideways(lean), 400)
    expected = 0.5 * (1 + np.cos(np.radians(lean))) * MODELS["lambert"].at(1.0)["albedo"]
    assert (np.abs(mean - expected) < 4 * error).all()
    assert (error < 0.002).all()
