"""FXAA and temporal antialiasing: nearer to the mean over the pixels, and no trails."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from photograd.frame import (
    FrameOptions,
    FrameScene,
    TemporalAntialiasing,
    draw_surfaces,
    frame_graph,
    fxaa,
    velocity,
)
from photograd_course.color import srgb_encode

from tests.frame import scenes

pytestmark = pytest.mark.usefixtures("core")
PLAIN = FrameOptions(sky_directions=0)


def rms(a: object, b: object) -> float:
    return float(np.sqrt(np.mean((np.asarray(a) - np.asarray(b)) ** 2)))


def slope(n: int, samples: int) -> np.ndarray:
    """A white half-plane with a shallow edge, sampled several times a pixel."""
    y, x = (np.indices((n * samples, n * samples)) + 0.5) / samples
    inside = (y > 0.3 * x + 4).astype(float)
    gray = inside.reshape(n, samples, n, samples).mean(axis=(1, 3))
    return np.repeat(gray[..., None], 3, axis=2)


def test_fxaa_leaves_flat_pictures_alone_and_mends_edges() -> None:
    gradient = np.repeat(np.linspace(0.2, 0.6, 40)[None, :, None], 20, axis=0).repeat(3, axis=2)
    np.testing.assert_array_equal(fxaa(gradient), gradient)
    jagged, truth = slope(32, 1), slope(32, 8)
    assert rms(fxaa(jagged), truth) < 0.75 * rms(jagged, truth)


def test_frames_of_other_points_become_the_mean_over_the_pixels() -> None:
    scene = scenes.room(scenes.LIGHTS["directional"])
    ready = FrameScene(scene)

    def drawn(camera: object, options: FrameOptions = PLAIN) -> np.ndarray:
        found = frame_graph(ready, options).run({"camera": camera}, ["radiance"])["radiance"]
        return np.asarray(found)

    truth = drawn(scene.camera, replace(PLAIN, supersampling=8))
    single = drawn(scene.camera)
    antialiasing = TemporalAntialiasing(weight=1 / 16, clamped=False)
    for _ in range(16):
        mean = antialiasing.add(drawn(antialiasing.camera(scene.camera)))
    shown = [srgb_encode(np.clip(each, 0, 1)) for each in (single, mean, truth)]
    before, after = rms(shown[0], shown[2]), rms(shown[1], shown[2])
    assert after < 0.3 * before


def test_what_has_moved_is_found_and_leaves_no_trail() -> None:
    scene = scenes.room(scenes.LIGHTS["directional"])
    ready = FrameScene(scene)
    camera = scene.camera
    pose = camera.world_from_camera.copy()
    pose[:3, 3] += [0.15, 0.0, 0.0]
    previous = replace(camera, world_from_camera=pose)
    surfaces = draw_surfaces(ready, camera, "opaque")[1]
    pictures = [
        frame_graph(ready, PLAIN).run({"camera": c}, ["radiance"])["radiance"]
        for c in (previous, camera)
    ]
    errors = {}
    for name, moved in (("by velocity", velocity(surfaces, previous)), ("in place", None)):
        antialiasing = TemporalAntialiasing(weight=0.1, clamped=False)
        antialiasing.add(pictures[0])
        errors[name] = rms(antialiasing.add(pictures[1], moved), pictures[1])
    assert errors["by velocity"] < 0.5 * errors["in place"]
    clamped = TemporalAntialiasing(weight=0.1)
    clamped.add(pictures[0] + 5.0)
    assert clamped.add(pictures[1]).max() <= pictures[1].max()


def test_single_frames_and_still_pictures_stay_as_they_are() -> None:
    g = np.random.default_rng(5)
    first, second = g.uniform(0, 1, (2, 9, 8, 3))
    alone = TemporalAntialiasing(weight=1.0)
    alone.add(first)
    np.testing.assert_allclose(alone.add(second), second, rtol=1e-14)
    still = TemporalAntialiasing(weight=0.1)
    for _ in range(3):
        found = still.add(first, np.zeros((9, 8, 2)))
    np.testing.assert_allclose(found, first, rtol=1e-14)
