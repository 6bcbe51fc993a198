"""Reflected radiance is the integral of f L cos over the hemisphere [Kajiya1986]."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.lights import EnvironmentMap, about_y
from photograd.transport import PathOptions, PathTracer, Scene
from photograd.transport.builtin import camera_at
from photograd.transport.material import MODELS
from photograd.transport.shapes import rectangle

from tests.transport.light_scenes import TILT, texels
from tests.transport.scenes import FLOOR, any_material

POINT, EYE = np.array([0.5, 0.0, 0.3]), np.array([0.5, 1.0, 2.5])
BRDFS = ("lambert", "oren_nayar_full", "ggx_metal", "gltf", "burley_diffuse")
MAPS = {
    "spot": EnvironmentMap(texels(6)),
    "tilted": EnvironmentMap(texels(10, seed=7), TILT, 0.3),
    "patches": EnvironmentMap(
        np.random.default_rng(8).random((4, 8, 3)) ** 3, about_y(1.0), uniform_share=1.0
    ),
}


def quadrature(model: Any, parameters: Any, light: EnvironmentMap, nodes: int) -> Any:
    """Radiance (3,) towards the eye: Gauss in the cosine, a plain sum in azimuth."""
    u, weight = np.polynomial.legendre.leggauss(nodes)
    cosine, turn = 0.5 * (u + 1), 2 * np.pi * (np.arange(4 * nodes) + 0.5) / (4 * nodes)
    c, phi = (x.ravel() for x in np.meshgrid(cosine, turn, indexing="ij"))
    s = np.sqrt(1 - c * c)
    wi = np.stack([s * np.cos(phi), s * np.sin(phi), c], axis=-1)
    to_eye = (EYE - POINT) / np.linalg.norm(EYE - POINT)
    # The shading normal is +Z, the floor's +Y: local (x, y, z) is world (z, x, y).
    wo = np.broadcast_to(to_eye[[2, 0, 1]], wi.shape).copy()
    L = light.L(np.zeros_like(wi), np.ascontiguousarray(wi[:, [1, 2, 0]]))
    f = model.f(parameters, wo, wi)
    share = np.repeat(0.5 * weight, 4 * nodes) * 2 * np.pi / (4 * nodes)
    return (f * L * (c * share)[:, None]).sum(axis=0)


@pytest.mark.parametrize("sky", MAPS)
@pytest.mark.parametrize("name", BRDFS)
def test_quadrature_and_chance_agree(name: str, sky: str) -> None:
    # One pixel of 0.01 degrees on a floor. 15 tests of 3 channels, each with 16 batches of even
    # samples, independent of each other.
    material, light = any_material(name), MAPS[sky]
    camera = camera_at(EYE, POINT, 0.01, 1, 1)
    floor = rectangle("floor", *FLOOR, "m")
    scene = Scene("pixel", (floor,), {"m": material}, camera, lights=(light,))
    tracer = PathTracer(scene, dtype=np.float64)
    options = PathOptions(max_depth=2)
    means = np.array(
        [tracer.render(spp=2048, seed=s, options=options).mean[0, 0] for s in range(16)]
    )
    expected = quadrature(MODELS[name], material.values, light, 160)
    # Texels have kinks between them; half as many nodes change the sum by at most this.
    slack = np.abs(expected - quadrature(MODELS[name], material.values, light, 80))
    assert (slack < 2e-3 * expected).all()
    error = means.std(axis=0, ddof=1) / 4
    assert (error < 0.0025 * expected).all()  # one percent is four of these: a bias would be seen
    assert (np.abs(means.mean(axis=0) - expected) < 4 * error + slack).all()
