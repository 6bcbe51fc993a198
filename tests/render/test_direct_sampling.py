"""How good the samples of direct light are: strata, self-shadowing, any distance and size."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.data.camera import Camera
from photograd.orbit import look_at
from photograd.scenes.description import (
    SceneDescription,
    SceneMesh,
    SkyDescription,
    SunDescription,
)
from photograd.tracer import TracedScene

from geometry.shapes import bumpy_sphere
from render.test_direct import scene, square

ALBEDO = np.array([0.25, 0.5, 0.75], np.float32)


def penumbra() -> tuple[TracedScene, Camera]:
    """One pixel on a floor from which a wall's edge halves the sun."""
    wall = np.array([[0, 1, 5], [5, 1, 5], [5, 1, -5], [0, 1, -5]], np.float32) * 0.3
    half = SceneMesh(wall, np.array([[0, 1, 2], [0, 2, 3]], np.uint32), np.zeros(3, np.float32))
    traced = TracedScene(scene(square(0, 1.5, [0.8] * 3), half, sun=[10, 10, 10], radius=0.3))
    eye = look_at(np.array([-0.02, 0.2, 1e-3]), np.array([-0.02, 0.0, 0.0]))
    return traced, Camera(1, 1, 2000.0, 2000.0, 0.5, 0.5, eye)


def test_stratified_shadow_rays_beat_random_ones_fourfold() -> None:
    # 64 independent shadow rays that see the sun with probability p have variance p (1 - p) / 64.
    traced, view = penumbra()
    seen = [float(traced.render(view, spp=64, seed=s).radiance[0, 0, 0]) for s in range(200)]
    p = float(np.mean(seen)) / (0.8 * 10 * np.sin(0.3) ** 2)
    assert 0.2 < p < 0.8
    relative_variance = np.var(seen) / np.mean(seen) ** 2
    random_variance = (1 - p) / (64 * p)
    # The variance of 200 values is known to 10 %, so a ratio of 4 is not reached by chance.
    assert relative_variance < random_variance / 4


@pytest.mark.parametrize("spp", [1, 7, 12, 64])
def test_any_number_of_samples_has_the_same_mean(spp: int) -> None:
    traced, view = penumbra()
    truth = float(traced.render(view, spp=16384, seed=1000).radiance[0, 0, 0])
    count = 4096 // spp
    seen = [float(traced.render(view, spp=spp, seed=s).radiance[0, 0, 0]) for s in range(count)]
    # Four standard errors, at least those of 4096 stratified samples; a bias of 5 % would be seen
    # even with one sample a pixel, whose standard error is 1 / sqrt(4096) = 1.6 %.
    error = max(float(np.std(seen)) / np.sqrt(count), 1e-3 * truth)
    assert abs(np.mean(seen) - truth) < 4 * error
    assert error < 0.02 * truth


def ball(scale: float) -> tuple[SceneDescription, Camera]:
    vertices, faces = bumpy_sphere(12, 24)
    convex = vertices / np.linalg.norm(vertices, axis=1, keepdims=True) * scale
    mesh = SceneMesh(convex.astype(np.float32), faces, ALBEDO)
    box = np.array([[-1.1] * 3, [1.1] * 3]) * scale
    sun = SunDescription(np.array([0.0, 1.0, 0.0]), np.zeros(3), 0.1)
    white = SkyDescription(*(np.ones(3) for _ in range(3)))
    eye = look_at(np.array([0.0, 1.0, 3.0]) * scale, np.zeros(3))
    return SceneDescription("ball", (mesh,), sun, white, box), Camera(24, 24, 31, 31, 12, 12, eye)


@pytest.mark.parametrize("scale", [1e-2, 1.0, 1e3])
def test_no_surface_shadows_itself(scale: float) -> None:
    # Above a facet of a convex mesh the whole sky is free, so it shows its albedo without noise.
    description, view = ball(scale)
    image = TracedScene(description).render(view, spp=16, seed=6)
    assert image.alpha.max() == pytest.approx(1.0)
    assert (image.alpha == 0).any()
    np.testing.assert_allclose(image.radiance, image.alpha[..., None] * ALBEDO, atol=2e-6)


def test_radiance_does_not_change_with_distance() -> None:
    # A02: radiance along an unoccluded ray, from three distances.
    traced = TracedScene(scene(square(0, 1.5, ALBEDO), sky=[1, 1, 1]))
    seen: list[Any] = []
    for height in (0.2, 1.0, 1.9):
        eye = look_at(np.array([0.0, height, 1e-3]), np.zeros(3))
        seen.append(traced.render(Camera(2, 2, 40, 40, 1, 1, eye), spp=4, seed=1).radiance)
        np.testing.assert_allclose(seen[-1], seen[0], rtol=1e-6)
