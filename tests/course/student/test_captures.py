"""Cameras and photographs that explore scripts and figures share."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from photograd_course.captures import (
    BALLS,
    all_around,
    look_at_origin,
    rays_to_origin,
    read_capture,
    striped_balls,
)
from photograd_course.errors import IoError
from PIL import Image


@pytest.mark.parametrize("up", [1, 2])
def test_places_are_spread_evenly_over_the_sphere(up: int) -> None:
    places = all_around(200, 0.3, up=up)
    np.testing.assert_allclose(np.linalg.norm(places, axis=1), 1.0, atol=1e-14)
    np.testing.assert_allclose(places.mean(axis=0), 0.0, atol=0.01)
    np.testing.assert_allclose(np.diff(places[:, up]), -0.01, atol=1e-14)
    nearest = np.sort(np.linalg.norm(places[:, None] - places, axis=-1), axis=1)[:, 1]
    assert nearest.min() > 0.1


def test_heights_of_a_band() -> None:
    heights = all_around(4, top=0.8, span=1.2)[:, 2]
    np.testing.assert_allclose(heights, [0.65, 0.35, 0.05, -0.25], atol=1e-14)


def test_a_camera_looks_at_the_origin_with_the_sky_above() -> None:
    pose = look_at_origin(np.array([1.0, 2.0, -2.0]))
    turn = pose[:3, :3]
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-14)
    assert np.linalg.det(turn) == pytest.approx(1.0)
    np.testing.assert_allclose(pose[:3, 2], np.array([-1.0, -2.0, 2.0]) / 3, atol=1e-14)
    assert pose[1, 1] < 0 < 1e-12 + abs(pose[1, 0])  # y of the camera is down, x is level
    assert pose[1, 0] == pytest.approx(0.0, abs=1e-14)
    np.testing.assert_array_equal(pose[:, 3], [1.0, 2.0, -2.0, 1.0])


def test_rays_of_a_picture_go_row_by_row_from_the_upper_left() -> None:
    place = np.array([[0.0, -2.0, 0.0]])  # x of the picture is x of the world, its y is -z
    origins, directions = rays_to_origin(place, 2, 0.5)
    np.testing.assert_array_equal(origins, np.repeat(place, 4, axis=0))
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1.0, atol=1e-14)
    aside = directions[:, [0, 2]] / directions[:, [1]]
    np.testing.assert_allclose(
        aside, [[-0.25, 0.25], [0.25, 0.25], [-0.25, -0.25], [0.25, -0.25]], atol=1e-14
    )


def test_the_balls_are_where_they_are_said_to_be() -> None:
    eye = np.array([0.0, 0.0, 5.0])
    to = np.array([np.array(middle) - eye for middle, _, _ in BALLS] + [[0.0, 1.0, 0.0]])
    colors = striped_balls(eye, to / np.linalg.norm(to, axis=1, keepdims=True), (0.1, 0.2, 0.3))
    np.testing.assert_array_equal(colors[3], [0.1, 0.2, 0.3])
    for seen, (_, _, paint) in zip(colors[[0, 2]], (BALLS[0], BALLS[2]), strict=True):
        np.testing.assert_allclose(seen / seen[0], np.array(paint) / paint[0], atol=1e-12)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Four pictures of 8 x 4 pixels, half of each transparent."""
    pixels = np.full((4, 8, 4), 255, np.uint8)
    pixels[..., 1] = 128
    pixels[:, 4:, 3] = 0
    pose = np.eye(4)
    pose[:3, 3] = [1.0, 2.0, 3.0]
    frames = [{"file_path": f"./{k}", "transform_matrix": pose.tolist()} for k in range(4)]
    for k in range(4):
        Image.fromarray(pixels).save(tmp_path / f"{k}.png")
    text = json.dumps({"camera_angle_x": 2 * np.arctan(0.5), "frames": frames})
    (tmp_path / "transforms_train.json").write_text(text)
    return tmp_path


def test_photographs_of_ones_own(folder: Path) -> None:
    photos = list(read_capture(folder, 8, 2))
    assert len(photos) == 2
    photo = photos[0]
    assert photo.colors.shape == (4, 8, 3)
    np.testing.assert_allclose(photo.colors[0, 0], [1.0, (128 / 255) ** 2.2, 1.0])
    np.testing.assert_array_equal(photo.colors[:, 4:], 0.0)
    assert photo.focal == pytest.approx(8.0)
    assert photo.border.shape == (24, 3)
    origins, directions = photo.rays()
    np.testing.assert_array_equal(origins, np.tile([1.0, 2.0, 3.0], (32, 1)))
    # The file has y up and -z forward: the upper left pixel is seen to the left, above, ahead.
    np.testing.assert_allclose(directions[0], [-3.5 / 8, 1.5 / 8, -1.0], atol=1e-12)


def test_a_focal_length_in_pixels_of_the_file(folder: Path) -> None:
    file = folder / "transforms_train.json"
    told = json.loads(file.read_text())
    file.write_text(json.dumps({**told, "fl_x": 20.0, "w": 8}))
    assert next(iter(read_capture(folder, 4, 1))).focal == pytest.approx(10.0)


def test_a_folder_without_cameras_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(IoError, match="transforms_train"):
        list(read_capture(tmp_path, 8, 2))
