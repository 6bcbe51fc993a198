"""Transforms files and their images: each fault gets one clear typed error that names it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.capture import load_capture
from photograd_course.errors import Error, IoError, RangeError, SceneError
from PIL import Image

from support import capture_files as files

CAMERAS = files.orbit(5)


def blender(folder: Path, change: Callable[[Any], None] | None = None) -> None:
    files.write_blender(folder, CAMERAS, CAMERAS[:2])
    if change is not None:
        files.edit_json(folder / "transforms_train.json", change)


def nerfstudio(folder: Path, change: Callable[[Any], None]) -> None:
    files.write_nerfstudio(folder, CAMERAS)
    files.edit_json(folder / "transforms.json", change)


def frame(index: int, **members: object) -> Callable[[Any], None]:
    """Set members of one frame; None removes."""

    def change(content: Any) -> None:
        content["frames"][index] |= members

    return change


def pose(index: int, row: int, column: int, value: float) -> Callable[[Any], None]:
    def change(content: Any) -> None:
        content["frames"][index]["transform_matrix"][row][column] = value

    return change


def top(**members: object) -> Callable[[Any], None]:
    return lambda content: content.update(members)


BLENDER: list[tuple[Callable[[Any], None], type[Error], str]] = [
    (
        frame(3, file_path="./train/9999"),
        IoError,
        r"frames\[3\] './train/9999': .*none of 9999.png",
    ),
    (frame(3, file_path="./train/\0"), IoError, r"frames\[3\].*expected an image file"),
    (frame(3, file_path="./train/" + "x" * 400), IoError, r"frames\[3\].*an image file"),
    (frame(3, file_path=7), IoError, r"frames\[3\]: file_path: expected a string, got int 7"),
    (frame(3, file_path="./train/0002"), IoError, "'train/0002' 2 times"),
    (
        frame(2, transform_matrix=None),
        IoError,
        r"frames\[2\]: expected a member 'transform_matrix'",
    ),
    (frame(2, transform_matrix=[[1, 2], [3]]), IoError, r"frames\[2\]: transform_matrix: .*shape"),
    (pose(2, 0, 0, 5.0), SceneError, r"frames\[2\] './train/0002': transform_matrix: .*rigid"),
    (pose(2, 0, 3, float("nan")), RangeError, r"frames\[2\]: transform_matrix.*finite number"),
    (pose(2, 0, 3, float("inf")), RangeError, r"frames\[2\]: transform_matrix.*finite number"),
    (pose(2, 0, 3, 10**400), RangeError, r"frames\[2\]: transform_matrix.*finite number"),
    (pose(2, 3, 3, 2.0), SceneError, r"last row"),
    (top(camera_angle_x=0.0), RangeError, "camera_angle_x: expected an angle"),
    (top(camera_angle_x=True), IoError, "camera_angle_x: expected a number, got bool"),
    (top(camera_angle_x=None), IoError, "'fl_x' or 'camera_angle_x'"),
    (top(frames=[]), IoError, "frames: expected at least one frame"),
    (top(frames={}), IoError, "frames: expected an array"),
    (top(aabb=[[1, 1, 1], [0, 0, 0]]), RangeError, "aabb: expected corners, lower below upper"),
    (top(w=30), IoError, "expected an image of 30 x 20, got 24 x 20 in 0000.png"),
]


@pytest.mark.parametrize(("change", "error", "text"), BLENDER)
def test_blender(
    tmp_path: Path, change: Callable[[Any], None], error: type[Error], text: str
) -> None:
    blender(tmp_path, change)
    with pytest.raises(error, match=f"(?s)^(load_blender|Capture): .*{text}"):
        load_capture(tmp_path)


def reflected(content: Any) -> None:
    matrix = np.array(content["frames"][1]["transform_matrix"])
    content["frames"][1]["transform_matrix"] = (matrix @ np.diag([1, 1, -1, 1.0])).tolist()


NERFSTUDIO: list[tuple[Callable[[Any], None], type[Error], str]] = [
    (top(camera_model="EQUIRECTANGULAR"), IoError, "got EQUIRECTANGULAR"),
    (top(camera_model="OPENCV_FISHEYE", p1=0.01), SceneError, "p1: expected 0, got 0.01"),
    (top(k3=0.01), SceneError, "k3: expected 0, got 0.01"),
    (top(k1=1e300), RangeError, "k1: expected a finite number"),
    (top(fl_x=-5.0), RangeError, "fl_x: expected a positive focal length"),
    (top(w=24.5), RangeError, "w: expected a positive whole number"),
    (top(w=0), RangeError, "w: expected a positive whole number"),
    (frame(2, w=48, h=40), IoError, r"frames\[2\].*expected an image of 48 x 40"),
    (frame(2, mask_path="images/none.png"), IoError, r"frames\[2\].*mask_path"),
    (reflected, SceneError, r"frames\[1\] 'images/0001.png': .*reflection"),
    (top(train_filenames=["images/none.png"]), IoError, r"train_filenames\[0\]"),
    (top(train_filenames=[]), IoError, "at least one training view"),
    (top(applied_transform=[[2, 0, 0, 0]] * 3), SceneError, "applied_transform"),
    (top(frames=[]), IoError, "an empty capture"),
]


@pytest.mark.parametrize(("change", "error", "text"), NERFSTUDIO)
def test_nerfstudio(
    tmp_path: Path, change: Callable[[Any], None], error: type[Error], text: str
) -> None:
    nerfstudio(tmp_path, change)
    with pytest.raises(error, match=text):
        load_capture(tmp_path)


@pytest.mark.parametrize(
    "text", ["", "{", "[1, 2", '{"frames": 1e999999}', "[" * 100_000, "null", '"x"', "\ud800"]
)
def test_broken_json(tmp_path: Path, text: str) -> None:
    blender(tmp_path)
    data = text.encode("utf-8", "surrogatepass")
    (tmp_path / "transforms_train.json").write_bytes(data)
    with pytest.raises(Error, match=r"^load_blender: "):
        load_capture(tmp_path)


def test_images_of_different_size(tmp_path: Path) -> None:
    blender(tmp_path)
    Image.new("RGBA", (12, 10)).save(tmp_path / "train/0003.png")
    with pytest.raises(IoError, match=r"frames\[3\] './train/0003': .*24 x 20, got 12 x 10"):
        load_capture(tmp_path)


def test_truncated_image_is_named_when_it_is_read(tmp_path: Path) -> None:
    blender(tmp_path)
    path = tmp_path / "train/0001.png"
    path.write_bytes(path.read_bytes()[:-30])
    view = load_capture(tmp_path).train[1]
    with pytest.raises(IoError, match=r"0001.png: expected a readable image"):
        view.rgba()
    path.write_bytes(b"")
    with pytest.raises(IoError, match=r"0001.png': expected an image file, got an empty file"):
        load_capture(tmp_path)


def test_an_image_that_changed_after_loading(tmp_path: Path) -> None:
    blender(tmp_path)
    view = load_capture(tmp_path).train[1]
    Image.new("RGBA", (12, 10)).save(tmp_path / "train/0001.png")
    with pytest.raises(IoError, match=r"view 'train/0001': expected shape \(20, 24, 4\)"):
        view.rgba()


def test_mixed_color_spaces(tmp_path: Path) -> None:
    from photograd.images import write_exr

    nerfstudio(tmp_path, frame(1, file_path="images/1.exr"))
    write_exr(tmp_path / "images/1.exr", np.ones((20, 24, 3), dtype=np.float32))
    with pytest.raises(SceneError, match="EXR beside PNG"):
        load_capture(tmp_path)


def test_nothing_there(tmp_path: Path) -> None:
    for path, text in ((tmp_path, "none of them"), (tmp_path / "absent", "no such folder")):
        with pytest.raises(IoError, match=text):
            load_capture(path)
    (tmp_path / "notes.txt").write_text("")
    with pytest.raises(IoError, match="none of them"):
        load_capture(tmp_path / "notes.txt")
    with pytest.raises(IoError, match="no such folder"):
        load_capture("a\0b")


def test_limits(tmp_path: Path) -> None:
    blender(tmp_path)
    for options in ({"limit": 0}, {"downscale": 0}, {"downscale": 21}):
        with pytest.raises(RangeError):
            load_capture(tmp_path, **options)
