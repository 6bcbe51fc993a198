"""Cameras for other programs, read back by our loaders and, in `./run test --all`, pycolmap."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.capture import Capture, Distortion, FisheyeDistortion, load_capture
from photograd.capture.export import Y_DOWN_FROM_Y_UP, write_colmap, write_transforms
from photograd.capture.frames import quaternion_from_rotation, rotation_from_quaternion
from photograd.errors import IoError, SceneError

from support import capture_files as files
from support.missing import need_module

LENS = Distortion(0.1, -0.02, 0.003, -0.001)


def capture(folder: Path, *, lens: Any = None) -> Capture:
    """Nine views with points, each with other intrinsics, in a folder of its own."""
    cameras = [replace(c, fx=26.0 + k, cx=11.0 + 0.1 * k) for k, c in enumerate(files.orbit())]
    files.write_nerfstudio(folder, cameras, shared=False)
    found = load_capture(folder)
    moved = [replace(view, distortion=lens) for view in found.views]
    points = np.array([[0.1, 0.2, 0.3], [-1.0, 2.0, 0.5]])
    colors = np.array([[255, 0, 7], [3, 200, 100]], np.uint8)
    return replace(
        found, train=tuple(moved[:7]), test=tuple(moved[7:]), points=points, point_colors=colors
    )


def same_cameras(a: Capture, b: Capture, turn: Any = None) -> None:
    """View by view, by the name of the file; poses may differ by a turn of the world."""
    ours = {Path(view.name).name: view for view in a.views}
    assert len(b.views) == len(ours) > 1
    for view in b.views:
        expected = ours[Path(view.name).name]
        for name in ("width", "height", "fx", "fy", "cx", "cy"):
            assert getattr(view.camera, name) == pytest.approx(
                getattr(expected.camera, name), rel=1e-12
            )
        pose = expected.camera.world_from_camera
        pose = pose if turn is None else turn @ pose
        np.testing.assert_allclose(view.camera.world_from_camera, pose, atol=1e-9)
        assert view.distortion == expected.distortion
        np.testing.assert_array_equal(view.rgba(), expected.rgba())


@pytest.mark.parametrize("lens", [None, LENS, FisheyeDistortion(0.03, -0.01, 0.004, -0.001)])
def test_transforms_come_back(tmp_path: Path, lens: Any) -> None:
    before = capture(tmp_path / "a", lens=lens)
    lines = write_transforms(tmp_path / "a" / "again.json", before)
    assert lines == ("+Y up -> +Z up, OpenCV camera -> OpenGL",)
    after = load_capture(tmp_path / "a" / "again.json")
    same_cameras(before, after)
    assert [view.name for view in after.test] == [view.name for view in before.test]
    assert after.points is not None
    np.testing.assert_allclose(after.points, before.points, atol=1e-6)
    np.testing.assert_array_equal(after.point_colors, before.point_colors)
    frame = json.loads((tmp_path / "a/again.json").read_text(encoding="utf-8"))["frames"][0]
    expected = files.opengl_z_up(before.train[0].camera)  # without the code under test
    np.testing.assert_allclose(frame["transform_matrix"], expected, atol=1e-12)


def test_photographs_elsewhere_are_named_and_said(tmp_path: Path) -> None:
    before = capture(tmp_path / "a")
    (tmp_path / "b").mkdir()
    lines = write_transforms(tmp_path / "b" / "t.json", before)
    assert "outside of the file's folder" in lines[1]
    same_cameras(before, load_capture(tmp_path / "b/t.json", allow_outside=True))


@pytest.mark.parametrize("form", ["binary", "text"])
@pytest.mark.parametrize("lens", [None, LENS, FisheyeDistortion(0.03, -0.01, 0.004, -0.001)])
def test_colmap_models_come_back(tmp_path: Path, form: Any, lens: Any) -> None:
    before = capture(tmp_path / "a", lens=lens)
    write_colmap(tmp_path / "a", before, form=form)
    (tmp_path / "a/transforms.json").unlink()
    after = load_capture(tmp_path / "a")
    assert after.format == "colmap"
    same_cameras(before, after, after.world_from_source @ Y_DOWN_FROM_Y_UP)
    turn = after.world_from_source @ Y_DOWN_FROM_Y_UP
    assert before.points is not None
    np.testing.assert_allclose(after.points, before.points @ turn[:3, :3].T, atol=1e-12)
    np.testing.assert_array_equal(after.point_colors, before.point_colors)
    # Up is estimated on reading, from cameras of which some stand higher.
    assert turn[1, 1] > 0.9


@pytest.mark.parametrize("form", ["binary", "text"])
def test_pycolmap_reads_the_model(tmp_path: Path, form: Any) -> None:
    pycolmap: Any = need_module("pycolmap", by_choice=True)  # extra sfm
    before = capture(tmp_path / "a", lens=LENS)
    write_colmap(tmp_path / "a", before, form=form)
    model = pycolmap.Reconstruction(str(tmp_path / "a/sparse/0"))
    images = {image.name: image for image in model.images.values()}
    assert len(images) == len(before.views)
    assert len(model.points3D) == 2
    point = np.array([0.2, 0.1, -0.1])
    for view in before.views:
        image = images[Path(view.name).name]
        camera = model.cameras[image.camera_id]
        assert camera.model.name == "OPENCV"
        seen = image.cam_from_world() if callable(image.cam_from_world) else image.cam_from_world
        local = seen * (Y_DOWN_FROM_Y_UP[:3, :3] @ point)
        expected = view.camera.world_from_camera[:3, :3].T @ (point - view.camera.position)
        np.testing.assert_allclose(local, expected, atol=1e-9)


def test_what_cannot_be_written_is_refused(tmp_path: Path) -> None:
    before = capture(tmp_path / "a")
    with pytest.raises(IoError, match=r"a name that ends in \.json"):
        write_transforms(tmp_path / "a.txt", before)
    memory = replace(before.train[0], image=before.train[0].rgba())
    there = replace(before, train=(memory, *before.train[1:]))
    for write in (
        lambda: write_transforms(tmp_path / "t.json", there),
        lambda: write_colmap(tmp_path / "c", there),
    ):
        with pytest.raises(SceneError, match="write_blender_capture writes them"):
            write()
    fisheye = replace(before.train[0], distortion=FisheyeDistortion(0.1, 0, 0, 0))
    mixed = replace(before, train=(fisheye, *before.train[1:]))
    with pytest.raises(SceneError, match="one kind of lens"):
        write_transforms(tmp_path / "t.json", mixed)
    assert not (tmp_path / "t.json").exists()


def test_quaternions_of_rotations_near_half_turns() -> None:
    random = np.random.default_rng(1)
    axes = np.eye(4)[[0, 1, 2, 3]]
    for q in [
        *axes,
        *(random.normal(size=(40, 4)) * [1e-9, 1, 1, 1]),
        *random.normal(size=(40, 4)),
    ]:
        unit = q / np.linalg.norm(q)
        found = quaternion_from_rotation(rotation_from_quaternion(unit))
        assert min(np.abs(found - unit).max(), np.abs(found + unit).max()) < 1e-12
        assert found[0] >= 0
