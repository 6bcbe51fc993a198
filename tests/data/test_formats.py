"""Every format, written by hand and read back: poses, intrinsics, pixels, points, splits."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from photograd.capture import Camera, Capture, Distortion, load_capture
from photograd.images import downscale_image
from PIL import Image

from support import capture_files as files

CAMERAS = files.orbit(9)
POINTS = files.sphere_points()


def by_name(capture: Capture) -> list[Camera]:
    """Cameras in the order of their files."""
    return [view.camera for view in sorted(capture.views, key=lambda view: view.name)]


def assert_same_cameras(found: list[Camera], turned: np.ndarray, truth: list[Camera]) -> None:
    """Poses to 1e-6 after taking back the turn of the world, intrinsics to rounding."""
    assert len(found) == len(truth)
    for ours, theirs in zip(found, truth, strict=True):
        pose = turned.T @ ours.world_from_camera
        np.testing.assert_allclose(pose, theirs.world_from_camera, atol=1e-6)
        assert (ours.width, ours.height) == (theirs.width, theirs.height)
        pixels = (ours.fx, ours.fy, ours.cx, ours.cy)
        np.testing.assert_allclose(pixels, (theirs.fx, theirs.fy, theirs.cx, theirs.cy), rtol=1e-12)


def write_colmap(form: str) -> Callable[[Path], None]:
    """A writer of a whole COLMAP capture with its model in text or binary form."""
    write = files.write_colmap_text if form == "text" else files.write_colmap_binary

    def write_all(folder: Path) -> None:
        names = files.write_pictures(folder / "images", CAMERAS)
        write(folder / "sparse" / "0", CAMERAS, names, POINTS)

    return write_all


WRITERS: dict[str, Callable[[Path], None]] = {
    "blender": lambda folder: files.write_blender(folder, CAMERAS, files.orbit(2)),
    "nerfstudio": lambda folder: files.write_nerfstudio(folder, CAMERAS),
    "nerfstudio per frame": lambda folder: files.write_nerfstudio(folder, CAMERAS, shared=False),
    "colmap text": write_colmap("text"),
    "colmap binary": write_colmap("binary"),
    "llff": lambda folder: files.write_llff(folder, CAMERAS),
    "llff larger": lambda folder: files.write_llff(folder, CAMERAS, scale=8.0),
    "opensfm": lambda folder: files.write_opensfm(folder, CAMERAS),
}
FIXED_UP = {"blender", "nerfstudio", "nerfstudio per frame", "opensfm"}


@pytest.mark.parametrize("name", WRITERS)
def test_round_trip(tmp_path: Path, name: str) -> None:
    WRITERS[name](tmp_path)
    capture = load_capture(tmp_path)
    assert capture.format == name.partition(" ")[0]
    assert capture.conversions
    found = by_name(capture)
    if name == "blender":
        assert_same_cameras([view.camera for view in capture.test], np.eye(4), files.orbit(2))
        found = [view.camera for view in capture.train]
    else:
        assert len(capture.test) == 2  # every 8th of 9
        assert capture.test[0].name.endswith("0000.png")
    # Formats with a promised up axis come back as they were; else the world is turned by the
    # turn that the capture reports, within the file's world, which here is ours.
    turn = np.eye(4) if name in FIXED_UP else capture.world_from_source
    assert_same_cameras(found, turn, CAMERAS)
    for view in capture.views:
        assert view.valid_mask().all()
    first = capture.train[0] if name == "blender" else capture.test[0]
    expected = files.picture(CAMERAS[0]) / np.float32(255.0)
    channels = 4 if capture.has_alpha else 3
    np.testing.assert_allclose(first.rgba()[..., :channels], expected[..., :channels], rtol=1e-6)
    assert capture.background == ((1.0, 1.0, 1.0) if capture.has_alpha else None)


def test_text_and_binary_models_are_the_same(tmp_path: Path) -> None:
    for form in ("text", "binary"):
        write_colmap(form)(tmp_path / form)
    text, binary = (load_capture(tmp_path / form) for form in ("text", "binary"))
    for ours, theirs in zip(text.views, binary.views, strict=True):
        same = np.array_equal(ours.camera.world_from_camera, theirs.camera.world_from_camera)
        assert same
        assert ours.name == theirs.name
    assert text.points is not None
    assert binary.points is not None
    np.testing.assert_array_equal(text.points, binary.points)
    turned = POINTS @ text.world_from_source[:3, :3].T
    np.testing.assert_allclose(text.points, turned, atol=1e-12)
    assert text.point_colors is not None
    assert text.point_colors[0].tolist() == [1, 2, 3]
    assert text.split_hash() == binary.split_hash()


def test_conversions_are_stated(tmp_path: Path) -> None:
    WRITERS["blender"](tmp_path)
    lines = load_capture(tmp_path).conversions
    assert "OpenGL camera -> OpenCV" in lines
    assert "+Z up -> +Y up" in lines
    assert any("sRGB" in line for line in lines)


def test_the_lens_of_a_nerfstudio_capture_is_removed(tmp_path: Path) -> None:
    files.write_nerfstudio(tmp_path, CAMERAS, camera_model="OPENCV", k1=0.2, p2=0.01)
    capture = load_capture(tmp_path)
    view = capture.train[0]
    assert view.distortion == Distortion(k1=0.2, p2=0.01)
    valid = view.valid_mask()
    assert 0.6 < valid.mean() < 0.99
    assert (view.rgba()[~valid] == 0.0).all()
    assert any("distortion removed on reading from 9 of 9" in line for line in capture.conversions)
    half = capture.downscaled(2).train[0]
    reduced, _ = downscale_image(view.rgba(), 2)
    whole = half.valid_mask()
    np.testing.assert_array_equal(half.rgba()[whole], reduced[whole])
    np.testing.assert_array_equal(half.valid_mask(), valid.reshape(10, 2, 12, 2).all(axis=(1, 3)))


def test_mask_files_exclude_pixels(tmp_path: Path) -> None:
    files.write_nerfstudio(tmp_path, CAMERAS)
    mask = np.full((20, 24), 255, dtype=np.uint8)
    mask[3, 4] = 0
    Image.fromarray(mask).save(tmp_path / "mask.png")
    content = json.loads((tmp_path / "transforms.json").read_text())
    for frame in content["frames"]:
        frame["mask_path"] = "mask.png"
    (tmp_path / "transforms.json").write_text(json.dumps(content))
    valid = load_capture(tmp_path).train[0].valid_mask()
    np.testing.assert_array_equal(valid, mask > 0)


def test_a_split_in_the_file_is_used(tmp_path: Path) -> None:
    names = [f"images/{index:04d}.png" for index in range(9)]
    split = {"train_filenames": names[2:], "test_filenames": names[1:2], "val_filenames": names[:1]}
    files.write_nerfstudio(tmp_path, CAMERAS, **split)
    capture = load_capture(tmp_path)
    assert [view.name for view in capture.test] == names[1:2]
    assert [view.name for view in capture.val] == names[:1]
    assert len(capture.train) == 7


def test_opensfm_lenses(tmp_path: Path) -> None:
    brown = {"projection_type": "brown", "focal_x": 1.1, "focal_y": 1.2, "c_x": 0.05, "c_y": -0.1}
    files.write_opensfm(tmp_path, CAMERAS, **brown, k1=0.01, k2=0.0, p1=0.002, p2=0.0, k3=0.0)
    view = load_capture(tmp_path).train[0]
    pixels = (view.camera.fx, view.camera.fy, view.camera.cx, view.camera.cy)
    np.testing.assert_allclose(pixels, (26.4, 28.8, 13.2, 7.6))
    assert view.distortion == Distortion(k1=0.01, p1=0.002)


@pytest.mark.parametrize(
    ("model", "numbers", "expected", "lens"),
    [
        ("SIMPLE_PINHOLE", [26, 11, 9], (26, 26, 11, 9), None),
        ("PINHOLE", [26, 27, 11, 9], (26, 27, 11, 9), None),
        ("SIMPLE_RADIAL", [26, 11, 9, 0.1], (26, 26, 11, 9), Distortion(0.1)),
        ("RADIAL", [26, 11, 9, 0.1, 0.2], (26, 26, 11, 9), Distortion(0.1, 0.2)),
        (
            "OPENCV",
            [26, 27, 11, 9, 0.1, 0.2, 0.03, 0.04],
            (26, 27, 11, 9),
            Distortion(0.1, 0.2, 0.03, 0.04),
        ),
    ],
)
def test_colmap_camera_models(
    tmp_path: Path,
    model: str,
    numbers: list[float],
    expected: tuple[float, ...],
    lens: Distortion | None,
) -> None:
    write_colmap("text")(tmp_path)
    line = f"7 {model} 24 20 {' '.join(map(str, numbers))}\n"
    (tmp_path / "sparse/0/cameras.txt").write_text(line)
    (tmp_path / "sparse/0/points3D.txt").unlink()
    view = load_capture(tmp_path).train[0]
    assert (view.camera.fx, view.camera.fy, view.camera.cx, view.camera.cy) == expected
    assert view.distortion == lens


def test_images_without_a_pose_are_reported(tmp_path: Path) -> None:
    for name in ("blender", "nerfstudio", "colmap text", "opensfm"):
        folder = tmp_path / name.replace(" ", "_")
        WRITERS[name](folder)
        assert not any("without a pose" in line for line in load_capture(folder).conversions)
        images = folder / ("train" if name == "blender" else "images")
        Image.new("RGBA", (3, 3)).save(images / "extra.png")
        lines = load_capture(folder).conversions
        assert "1 images without a pose, not used: extra.png" in lines


def test_limit_and_downscale(tmp_path: Path) -> None:
    WRITERS["blender"](tmp_path)
    capture = load_capture(tmp_path, limit=3, downscale=3)
    assert [view.name for view in capture.train] == ["train/0000", "train/0003", "train/0006"]
    assert len(capture.test) == 2
    camera = capture.train[0].camera
    assert (camera.width, camera.height, camera.cx) == (8, 6, 4.0)
    assert capture.train[0].rgba().shape == (6, 8, 4)
    assert any("24 x 20 cut off" in line for line in capture.conversions)
    assert capture.split_hash() != load_capture(tmp_path).split_hash()


def test_files_choose_their_reader(tmp_path: Path) -> None:
    write_colmap("text")(tmp_path)
    files.write_nerfstudio(tmp_path, CAMERAS)
    capture = load_capture(tmp_path)
    assert capture.format == "nerfstudio"
    assert any("also there: colmap" in line for line in capture.conversions)
    assert load_capture(tmp_path / "sparse/0/cameras.txt").format == "colmap"
    assert load_capture(tmp_path / "sparse").format == "colmap"


def test_one_view_is_not_held_out(tmp_path: Path) -> None:
    files.write_nerfstudio(tmp_path, CAMERAS[:1])
    capture = load_capture(tmp_path)
    assert (len(capture.train), len(capture.test)) == (1, 0)
