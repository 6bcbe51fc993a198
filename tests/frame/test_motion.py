"""Velocities of pixels, and the blur that they make."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.frame import (
    FrameOptions,
    FrameScene,
    LastFrame,
    ShadowSettings,
    draw_surfaces,
    frame_graph,
    motion_blur,
    velocity,
)

from tests.frame import scenes

pytestmark = pytest.mark.usefixtures("core")


def test_what_stands_still_keeps_its_bits() -> None:
    picture = np.random.default_rng(1).uniform(0, 1, (8, 9, 3))
    np.testing.assert_array_equal(motion_blur(picture, np.zeros((8, 9, 2))), picture)
    np.testing.assert_array_equal(motion_blur(picture, np.full((8, 9, 2), np.nan)), picture)
    np.testing.assert_array_equal(motion_blur(picture, np.full((8, 9, 2), 3.0), 0.0), picture)
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


def graph(ready: FrameScene, camera: Any, last: LastFrame, **options: Any) -> Any:
    chosen = FrameOptions(sky_directions=0, shadows=ShadowSettings(size=128), **options)
    return frame_graph(ready, chosen).run({"camera": camera, "last": last})


def moved_camera() -> Any:
    camera = scenes.camera()
    pose = camera.world_from_camera.copy()
    pose[:3, 3] += [0.15, 0.0, 0.0]
    return replace(camera, world_from_camera=pose)


def test_a_frame_that_stands_still_is_not_blurred() -> None:
    ready, camera = FrameScene(scenes.room(scenes.LIGHTS["point"])), scenes.camera()
    found = graph(ready, camera, LastFrame(camera), shutter=1.0)
    assert np.abs(found["velocity"]).max() < 1e-3
    np.testing.assert_allclose(found["blurred"], found["focused"], atol=2e-3)
    moving = graph(ready, camera, LastFrame(moved_camera()), shutter=1.0)
    assert np.abs(moving["blurred"] - moving["focused"]).max() > 0.05
    shut = graph(ready, camera, LastFrame(moved_camera()), temporal=0.1)
    np.testing.assert_array_equal(shut["blurred"], shut["focused"])


def test_a_frame_is_the_mean_over_frames() -> None:
    """Standing still, and while the camera moves: nearer to many samples a pixel than one frame."""
    ready, camera = FrameScene(scenes.room(scenes.LIGHTS["directional"])), scenes.camera()
    many = FrameOptions(sky_directions=0, shadows=ShadowSettings(size=128), supersampling=8)
    truth = frame_graph(ready, many).run({"camera": camera}, ["radiance"])["radiance"]
    one = replace(many, supersampling=1)
    single = frame_graph(ready, one).run({"camera": camera}, ["radiance"])["radiance"]
    for step in (0.0, 0.004):
        last = None
        for frame in range(24):
            pose = camera.world_from_camera.copy()
            pose[:3, 3] += [step * (23 - frame), 0.0, 0.0]
            view = replace(camera, world_from_camera=pose)
            before = LastFrame(view) if last is None else last
            found = graph(ready, view, before, temporal=1 / 12)
            last = LastFrame(view, history=found["history"])
        errors = [np.sqrt(np.mean((p - truth) ** 2)) for p in (single, found["accumulated"])]
        assert errors[1] < (0.5 if step == 0.0 else 0.85) * errors[0]


def test_a_shape_that_moves_is_found_where_it_was() -> None:
    """The history of a ball that moves is looked up by its own last pose, not by the camera's."""
    scene = scenes.room(scenes.LIGHTS["directional"])
    ball, by = scene.shapes[2], np.array([0.12, 0.0, 0.0])
    before = replace(scene, shapes=(*scene.shapes[:2], replace(ball, center=ball.center - by)))
    camera, back = scene.camera, np.eye(4)
    back[:3, 3] = -by
    ready = FrameScene(scene)
    number = int(ready.shape.max())
    first = graph(FrameScene(before), camera, LastFrame(camera), temporal=0.1)
    errors = {}
    for name, moved in (("own pose", {number: back}), ("camera alone", {})):
        last = LastFrame(camera, moved, first["history"])
        found = graph(ready, camera, last, temporal=0.1)
        face = found["visibility"].face
        shape = np.where(face >= 0, ready.shape[face], -1)
        moves = np.abs(found["velocity"][shape == number, 0])
        assert (moves > 0.5).all() == bool(moved)
        on_ball = (shape == number) & ~edges(shape)
        held = first["history"].history
        x, y = np.meshgrid(np.arange(96), np.arange(64))
        was = np.rint(x - found["velocity"][..., 0]).astype(int).clip(0, 95)
        errors[name] = np.abs(held[y, was] - found["radiance"])[on_ball].mean()
    assert errors["own pose"] < 0.4 * errors["camera alone"]


def edges(shape: Any) -> Any:
    """Pixels beside another shape."""
    around = [np.roll(shape, (dy, dx), (0, 1)) for dy in (-1, 0, 1) for dx in (-2, 0, 2)]
    return np.any([each != shape for each in around], axis=0)
