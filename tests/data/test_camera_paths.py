"""Camera paths: through cameras, of other sizes, and from files."""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from photograd.capture.orbit import helix_cameras, look_at, orbit_cameras
from photograd.capture.paths import interpolate_cameras, read_camera_path, resized_camera
from photograd.errors import IoError, RangeError, SceneError

BOX = np.array([[-1.0, -0.5, -1.0], [1.0, 0.5, 1.0]])


def test_a_path_goes_through_its_cameras_and_turns_evenly_between() -> None:
    cameras = orbit_cameras(BOX, 4, size=32, elevation=10)
    path = interpolate_cameras(cameras, 10)
    for k, camera in enumerate(cameras):
        np.testing.assert_allclose(
            path[3 * k].world_from_camera, camera.world_from_camera, atol=1e-12
        )
    turns = [a.world_from_camera[:3, :3].T @ b.world_from_camera[:3, :3] for a, b in pairwise(path)]
    angles = np.degrees(np.arccos([(np.trace(turn) - 1) / 2 for turn in turns]))
    np.testing.assert_allclose(angles, angles[0])  # slerp: a third of each quarter turn
    assert angles[0] < 90 / 3
    # Smooth: at a camera the path goes on in the direction in which it came.
    fine = interpolate_cameras(cameras, 301)
    at = np.stack([camera.position for camera in fine])
    before, after = at[100] - at[99], at[101] - at[100]
    assert before @ after / np.linalg.norm(before) / np.linalg.norm(after) > 0.999


def test_focal_lengths_are_interpolated_and_sizes_are_the_first_ones() -> None:
    a = orbit_cameras(BOX, 1, size=32)[0]
    b = replace(a, width=64, height=64, fx=8 * a.fx, fy=8 * a.fy, cx=32.0, cy=32.0)
    middle = interpolate_cameras([a, b], 3)[1]
    assert (middle.width, middle.height) == (32, 32)
    assert middle.fx == pytest.approx(2 * a.fx)  # b, reduced to 32 pixels, has 4 times a's
    assert [c.fx for c in interpolate_cameras([a], 2)] == [a.fx, a.fx]
    with pytest.raises(RangeError, match="at least one camera"):
        interpolate_cameras([], 3)
    with pytest.raises(RangeError, match="count"):
        interpolate_cameras([a], 0)


def test_another_size_shows_the_same_height() -> None:
    camera = replace(orbit_cameras(BOX, 1, size=32)[0], cx=17.5, cy=14.0)
    wide = resized_camera(camera, 128, 64)
    points = np.array([[0.2, 0.3, -0.1], [-0.4, 0.1, 0.2]])
    there, back = wide.project(points)[0], camera.project(points)[0]
    np.testing.assert_allclose(there, 2 * back + [32, 0])


def test_a_helix_rises_from_the_horizon() -> None:
    cameras = helix_cameras(BOX, 9, size=(40, 30), elevation=45, turns=1.0)
    assert (cameras[0].width, cameras[0].height) == (40, 30)
    out = np.stack([camera.position for camera in cameras])
    distance = np.linalg.norm(out, axis=1)
    np.testing.assert_allclose(np.degrees(np.arcsin(out[:, 1] / distance)), np.linspace(0, 45, 9))
    for camera in cameras:
        np.testing.assert_allclose(camera.forward, -camera.position / distance[0], atol=1e-12)
    assert len(helix_cameras(BOX, 1, size=8)) == 1
    with pytest.raises(RangeError, match="helix_cameras: box"):
        helix_cameras(np.zeros((2, 3)), 2, size=8)


def test_files_without_sizes_take_the_given_one(tmp_path: Path) -> None:
    path = tmp_path / "path.json"
    pose = look_at(np.array([0.0, 0.0, 4.0]), np.zeros(3))
    z_up = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    matrix = (z_up @ pose @ np.diag([1.0, -1, -1, 1])).tolist()
    frames = [{"transform_matrix": matrix}]
    path.write_text(json.dumps({"camera_angle_x": np.pi / 2, "frames": frames}), encoding="utf-8")
    (camera,) = read_camera_path(path, (40, 20))
    np.testing.assert_allclose(camera.world_from_camera, pose, atol=1e-12)
    assert (camera.width, camera.height, camera.cx) == (40, 20, 20)
    assert camera.fx == pytest.approx(20)


@pytest.mark.parametrize(
    ("content", "kind", "says"),
    [
        ("{", IoError, "valid JSON"),
        ("{}", IoError, "a member 'frames'"),
        ('{"frames": []}', RangeError, "at least one camera"),
        ('{"camera_path": [{"camera_to_world": [1, 2], "fov": 50}]}', IoError, "shape (16,)"),
        (
            '{"fl_x": 9, "frames": [{"transform_matrix": [[2,0,0,0],[0,1,0,0],[0,0,1,0]]}]}',
            SceneError,
            "a rigid pose",
        ),
    ],
)
def test_what_is_no_path_is_refused(
    tmp_path: Path, content: str, kind: type[Exception], says: str
) -> None:
    (tmp_path / "path.json").write_text(content, encoding="utf-8")
    with pytest.raises(kind) as failure:
        read_camera_path(tmp_path / "path.json", (8, 8))
    assert says in str(failure.value)


def test_angles_of_a_viewers_path_are_checked(tmp_path: Path) -> None:
    camera = {"camera_to_world": np.eye(4).ravel().tolist(), "fov": 180.0}
    (tmp_path / "path.json").write_text(json.dumps({"camera_path": [camera]}), encoding="utf-8")
    with pytest.raises(RangeError, match=r"camera_path\[0\]: fov"):
        read_camera_path(tmp_path / "path.json", (8, 8))
