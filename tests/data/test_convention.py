"""Poses in another convention are refused by name; right ones of every kind pass."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from photograd.capture import Camera, load_capture
from photograd.capture.convention import focus_point_of_axes
from photograd_course.errors import SceneError

from support import capture_files as files

FLIP = files.FLIP


def rewrite(path: Path, change: Callable[[np.ndarray], np.ndarray]) -> None:
    """Apply `change` to every pose of a transforms file."""
    content = json.loads(path.read_text())
    for frame in content["frames"]:
        frame["transform_matrix"] = change(np.array(frame["transform_matrix"])).tolist()
    path.write_text(json.dumps(content))


def opencv_axes(pose: np.ndarray) -> np.ndarray:
    return pose @ FLIP


def inverse(pose: np.ndarray) -> np.ndarray:
    return np.linalg.inv(pose)


def inverse_opencv(pose: np.ndarray) -> np.ndarray:
    return np.linalg.inv(pose @ FLIP)


WRONG = [
    (opencv_axes, "OpenCV poses where the format has OpenGL"),
    (inverse, "camera_from_world"),
    (inverse_opencv, "camera_from_world"),
]


@pytest.mark.parametrize(("change", "text"), WRONG)
def test_blender_poses(
    tmp_path: Path, change: Callable[[np.ndarray], np.ndarray], text: str
) -> None:
    files.write_blender(tmp_path, files.orbit(9), files.orbit(5))
    load_capture(tmp_path)
    for split in ("train", "test"):
        rewrite(tmp_path / f"transforms_{split}.json", change)
    with pytest.raises(SceneError, match=text) as error:
        load_capture(tmp_path)
    assert "train/0000" in str(error.value)
    assert "trust_poses" in str(error.value)
    assert len(load_capture(tmp_path, trust_poses=True).train) == 9


@pytest.mark.parametrize(("change", "text"), WRONG)
def test_nerfstudio_poses(
    tmp_path: Path, change: Callable[[np.ndarray], np.ndarray], text: str
) -> None:
    files.write_nerfstudio(tmp_path, files.orbit(9))
    load_capture(tmp_path)
    rewrite(tmp_path / "transforms.json", change)
    with pytest.raises(SceneError, match=text):
        load_capture(tmp_path)


@pytest.mark.parametrize("change", [opencv_axes, inverse])
def test_colmap_poses(tmp_path: Path, change: Callable[[np.ndarray], np.ndarray]) -> None:
    """COLMAP models say what each image observed, so that the poses can be held against it."""
    cameras = files.orbit(4)
    names = files.write_pictures(tmp_path / "images", cameras)
    points = files.sphere_points()
    files.write_colmap_text(tmp_path / "sparse", cameras, names, points)
    load_capture(tmp_path)
    lines = []
    for line in (tmp_path / "sparse/images.txt").read_text().splitlines():
        words = line.split()
        if len(words) == 10:
            index = int(words[0]) - 1
            pose = np.linalg.inv(change(cameras[index].world_from_camera))
            row = [*files.quaternion_of(pose[:3, :3]), *pose[:3, 3]]
            line = " ".join([words[0], *map(str, row), *words[8:]])  # noqa: PLW2901
        lines.append(line)
    (tmp_path / "sparse/images.txt").write_text("\n".join(lines))
    with pytest.raises(SceneError, match=r"image '0000.png': expected its points where"):
        load_capture(tmp_path)


def test_an_outward_looking_capture_passes_where_up_is_known(tmp_path: Path) -> None:
    turn = np.diag([-1.0, 1.0, -1.0, 1.0])
    cameras = [
        Camera(24, 20, 26.0, 26.0, 12.0, 10.0, camera.world_from_camera @ turn)
        for camera in files.orbit(8)
    ]
    files.write_blender(tmp_path, cameras, cameras[:2])
    assert any("outward-looking" in line for line in load_capture(tmp_path).conversions)


def test_an_outward_looking_ring_passes(tmp_path: Path) -> None:
    """All cameras exactly radial: their inverses stand in one place, which proves nothing."""
    cameras = []
    for angle in np.linspace(0.3, 5.9, 8):
        direction = np.array([np.cos(angle), 0.3, np.sin(angle)])
        pose = files.look_at(direction, 2.0 * direction)
        cameras.append(Camera(24, 20, 26.0, 26.0, 12.0, 10.0, pose))
    files.write_blender(tmp_path, cameras, cameras[:2])
    assert any("outward-looking" in line for line in load_capture(tmp_path).conversions)


def test_a_panorama_passes(tmp_path: Path) -> None:
    """Cameras that turn about one place away from the origin."""
    position = np.array([1.0, 2.0, 3.0])
    cameras = []
    for angle in np.linspace(0.0, 5.5, 8):
        target = position + np.array([np.cos(angle), 0.2, np.sin(angle)])
        pose = files.look_at(position, target)
        cameras.append(Camera(24, 20, 26.0, 26.0, 12.0, 10.0, pose))
    files.write_blender(tmp_path, cameras, cameras[:2])
    assert len(load_capture(tmp_path).train) == 8


def test_a_world_lying_on_its_side_is_warned_about(tmp_path: Path) -> None:
    """+Y up written where +Z up is expected: nothing can prove it, but it is said."""
    files.write_blender(tmp_path, files.orbit(9), files.orbit(5))
    assert not any("warning" in line for line in load_capture(tmp_path).conversions)
    y_up_from_z_up = files.Z_UP_FROM_Y_UP.T
    for split in ("train", "test"):
        rewrite(tmp_path / f"transforms_{split}.json", lambda pose: y_up_from_z_up @ pose)
    assert any("warning: the cameras' mean up" in x for x in load_capture(tmp_path).conversions)


def test_where_axes_meet() -> None:
    focus = focus_point_of_axes([camera.world_from_camera for camera in files.orbit(9)])
    np.testing.assert_allclose(focus.point, [0.1, 0.0, 0.05], atol=1e-12)
    assert focus.is_inward
    assert focus.miss < 1e-12
    parallel = [np.eye(4) + np.eye(4, k=3) * shift for shift in range(5)]
    assert not focus_point_of_axes(parallel).is_inward
    assert not focus_point_of_axes([np.eye(4)] * 5).is_inward
