"""Velocities of pixels, and the blur that they make."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from photograd.frame import FrameScene, draw_surfaces, motion_blur, velocity

from tests.frame import scenes

pytestmark = pytest.mark.usefixtures("core")


def test_what_stands_still_keeps_its_bits() -> None:
    picture = np.random.default_rng(1).uniform(0, 1, (8, 9, 3))
    np.testing.assert_array_equal(motion_blur(picture, np.zeros((8, 9, 2))), picture)
    np.testing.assert_array_equal(motion_blur(picture, np.full((8, 9, 2), np.nan)), picture)
    surfaces = draw_surfaces(FrameScene(scenes.room(None)), scenes.camera(), "opaque")[1]
    assert np.abs(velocity(surfaces, scenes.camera())).max() < 1e-4


def test_a_moving_edge_is_blurred_as_the_shutter_integral_says() -> None:
    x = np.arange(200) + 0.5
    edge = np.repeat(np.repeat(np.clip(x - 99.5, 0, 1)[None, :, None], 4, axis=0), 3, axis=2)
    moved = np.zeros((4, 200, 2))
    moved[..., 0] = 40.0
    found = motion_blur(edge, moved, samples=64)[1, :, 0]
    ramp = np.clip((x - 80) / 40, 0, 1)  # the mean over the way from -20 to 20
    assert np.abs(found - ramp).max() < 0.01
    half = motion_blur(edge, moved, 0.5, samples=64)[1, :, 0]
    assert np.abs(half - np.clip((x - 90) / 20, 0, 1)).max() < 0.02


def test_velocities_are_those_of_both_poses() -> None:
    camera = scenes.camera()
    pose = camera.world_from_camera.copy()
    pose[:3, 3] += [0.1, 0.02, -0.05]
    previous = replace(camera, world_from_camera=pose)
    ready = FrameScene(scenes.room(None), dtype=np.float64)
    visibility, surfaces = draw_surfaces(ready, camera, "opaque")
    shape = np.where(visibility.covered, ready.shape[visibility.face], -1)
    ball = int(ready.shape.max())
    back = np.eye(4)
    back[:3, 3] = [-0.2, 0.0, 0.0]
    found = velocity(surfaces, previous, shape, {ball: back})
    y, x = np.indices(shape.shape) + 0.5
    points = surfaces.position + np.where((shape == ball)[..., None], back[:3, 3], 0.0)
    was, _ = previous.project(points[surfaces.covered])
    expected = np.stack([x, y], axis=-1)[surfaces.covered] - was
    np.testing.assert_allclose(found[surfaces.covered], expected, atol=1e-9)
    # One frame's matrices for both would say that the ball stands still.
    still = velocity(surfaces, previous)
    assert np.abs(still - found)[shape == ball, 0].min() > 1.0
    # The background moves by the camera's turn alone, of which there is none here.
    assert np.abs(found[~surfaces.covered]).max() < 1e-9
