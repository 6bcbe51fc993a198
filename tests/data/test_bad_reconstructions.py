"""COLMAP, LLFF and OpenSfM files: each fault gets one clear typed error that names it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.capture import load_capture
from photograd_course.errors import Error, IoError, RangeError, SceneError, ShapeError

from support import capture_files as files

CAMERAS = files.orbit(5)


def colmap(folder: Path) -> Path:
    names = files.write_pictures(folder / "images", CAMERAS)
    files.write_colmap_text(folder / "sparse", CAMERAS, names, files.sphere_points())
    return folder / "sparse"


COLMAP: list[tuple[str, str, str, type[Error], str]] = [
    ("cameras.txt", "7 PINHOLE", "7 FOV", IoError, "expected 5 parameters of FOV, got 4"),
    (
        "cameras.txt",
        "7 PINHOLE",
        "7 MAGIC",
        IoError,
        "line 2: expected a camera model, got 'MAGIC'",
    ),
    ("cameras.txt", "7 PINHOLE 24", "7 PINHOLE 48", IoError, "expected an image of 48 x 20"),
    ("cameras.txt", "26.0 26.0", "nan 26.0", RangeError, "line 2: expected a finite number"),
    ("cameras.txt", "26.0 26.0", "-1 26.0", RangeError, "camera 7: Camera: fx"),
    ("cameras.txt", "7 PINHOLE", "8 PINHOLE", IoError, "image '0000.png': expected a camera id"),
    ("images.txt", " 7 0002.png", " 7 none.png", IoError, "image 'none.png': expected an image"),
    ("images.txt", " 7 0002.png", " 7", IoError, "line 6: expected ten words"),
    ("images.txt", " 7 0002.png", " 7 0001.png", IoError, "'0001.png' 2 times"),
    ("images.txt", "\n1 ", "\n1 0 0 0 0 ", IoError, "images.txt line 2"),
    ("points3D.txt", " 1 2 3 ", " 1 2 300 ", RangeError, "points3D.txt line 1: expected 0 to 255"),
    ("points3D.txt", "5 ", "5 inf ", RangeError, "points3D.txt line 1: expected a finite number"),
    ("images.txt", " 5", " 5 1", IoError, "expected triples"),
]


@pytest.mark.parametrize(("name", "old", "new", "error", "text"), COLMAP)
def test_colmap_text(
    tmp_path: Path, name: str, old: str, new: str, error: type[Error], text: str
) -> None:
    path = colmap(tmp_path) / name
    content = path.read_text()
    assert old in content
    path.write_text(content.replace(old, new, 1))
    with pytest.raises(error, match=text):
        load_capture(tmp_path)


def test_colmap_folders(tmp_path: Path) -> None:
    model = colmap(tmp_path)
    (model / "images.txt").write_text("# nothing\n")
    with pytest.raises(IoError, match="empty model"):
        load_capture(tmp_path)
    (model / "images.txt").unlink()
    with pytest.raises(IoError, match=r"images.txt"):
        load_capture(tmp_path)
    (tmp_path / "images").rename(tmp_path / "photographs")
    colmap(tmp_path / "other")
    (tmp_path / "other/images").rename(tmp_path / "other/photographs")
    with pytest.raises(IoError, match="a folder 'images'"):
        load_capture(tmp_path / "other")


def test_colmap_models_without_a_pinhole_are_named(tmp_path: Path) -> None:
    (colmap(tmp_path) / "cameras.txt").write_text("7 EQUIRECTANGULAR 24 20 24 20\n")
    with pytest.raises(IoError, match=r"camera 7: model: .*got EQUIRECTANGULAR .*perspective"):
        load_capture(tmp_path)


def test_colmap_binary_counts_are_not_believed(tmp_path: Path) -> None:
    names = files.write_pictures(tmp_path / "images", CAMERAS)
    model = tmp_path / "sparse"
    files.write_colmap_binary(model, CAMERAS, names, files.sphere_points())
    load_capture(tmp_path)
    for name in ("cameras.bin", "images.bin", "points3D.bin"):
        data = (model / name).read_bytes()
        for damaged in (b"\xff" * 8 + data[8:], data[:-1], data + b"\0", b"", data[:8]):
            (model / name).write_bytes(damaged)
            with pytest.raises(IoError, match=f"read_binary_model: {name}"):
                load_capture(tmp_path)
        (model / name).write_bytes(data)


def test_llff(tmp_path: Path) -> None:
    files.write_llff(tmp_path, CAMERAS)
    path = tmp_path / "poses_bounds.npy"
    table = np.load(path)

    def refused(array: np.ndarray, error: type[Error], text: str) -> None:
        np.save(path, array)
        with pytest.raises(error, match=text):
            load_capture(tmp_path)

    refused(table[:4], IoError, "5 images for 4 poses")
    refused(table[:, :16], ShapeError, r"shape \(N, 17\)")
    refused(table * [*[2.0] * 15, 1, 1], SceneError, "row of image '0000.png': pose: .*rigid")
    refused(np.where(np.arange(17) == 3, np.nan, table), RangeError, "0000.png.*finite")
    refused(table * [*[1.0] * 15, -1, 1], RangeError, "nearest < farthest")
    refused(table * [*[1.0] * 9, 2.0, *[1.0] * 7], IoError, "in the ratio 48 x 20")
    np.save(path, np.array([{"a": 1}]), allow_pickle=True)
    with pytest.raises(Error, match=r"poses_bounds.npy: expected floats or integers, got object"):
        load_capture(tmp_path)
    path.write_bytes(b"\x93NUMPY\x01\x00")
    with pytest.raises(IoError, match=r"readable .npy"):
        load_capture(tmp_path)


def test_opensfm(tmp_path: Path) -> None:
    path = tmp_path / "reconstruction.json"

    def refused(change: Callable[[Any], None], error: type[Error], text: str) -> None:
        files.write_opensfm(tmp_path, CAMERAS)
        files.edit_json(path, change)
        with pytest.raises(error, match=text):
            load_capture(tmp_path)

    refused(lambda c: c.clear(), IoError, "at least one reconstruction")
    refused(lambda c: c[0]["shots"].clear(), IoError, "empty capture")
    refused(lambda c: c[0]["cameras"].clear(), IoError, "a member 'lens'")
    refused(lambda c: c[0]["cameras"]["lens"].update(projection_type="fisheye"), IoError, "fisheye")
    refused(lambda c: c[0]["cameras"]["lens"].update(focal=-1), RangeError, "shot '0000.png'")
    refused(lambda c: c[0]["cameras"]["lens"].update(width=999), IoError, "in the ratio 999")
    refused(lambda c: c[0]["shots"].update(x=c[0]["shots"]["0000.png"]), IoError, "shot 'x'")
    refused(lambda c: c[0]["points"]["1"].update(coordinates=[1]), IoError, r"shape \(3,\)")
    brown = {"projection_type": "brown", "focal_x": 1, "focal_y": 1, "k3": 0.5}
    refused(lambda c: c[0]["cameras"]["lens"].update(brown), SceneError, "k3: expected 0")
