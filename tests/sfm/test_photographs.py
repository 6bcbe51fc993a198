"""A folder of photographs: found, turned upright, told apart by camera, refused with reasons."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.capture.sfm.photographs import copy_photographs, find_photographs
from photograd.capture.sfm.reconstruct import KEYS, NEIGHBORS, choose_pairs
from photograd.errors import IoError, SceneError
from PIL import Image, ImageOps

TURNS = range(1, 9)


def photograph(
    path: Path,
    *,
    size: tuple[int, int] = (48, 32),
    orientation: int | None = None,
    focal: float | None = None,
    model: str = "",
) -> Path:
    """Red on the left, blue at the bottom; a JPEG or PNG with tags."""
    pixels = np.full((size[1], size[0], 3), 90, np.uint8)
    pixels[:, : size[0] // 4] = [220, 20, 20]
    pixels[-size[1] // 4 :] = [20, 20, 220]
    tags = Image.Exif()
    if orientation is not None:
        tags[0x0112] = orientation
    if model:
        tags[0x0110] = model
    if focal is not None:
        tags.get_ifd(0x8769)[0x920A] = focal
    Image.fromarray(pixels).save(path, exif=tags)
    return path


def folder_of(tmp_path: Path, **others: object) -> Path:
    folder = tmp_path / "photographs"
    folder.mkdir()
    for index in range(3):
        photograph(folder / f"{index}.jpg", **others)  # type: ignore[arg-type]
    return folder


@pytest.mark.parametrize("orientation", TURNS)
@pytest.mark.parametrize("suffix", [".jpg", ".png"])
def test_the_tag_is_obeyed_once(tmp_path: Path, orientation: int, suffix: str) -> None:
    folder = folder_of(tmp_path)
    source = photograph(folder / f"x{suffix}", orientation=orientation, focal=35.0)
    found, lines = find_photographs(folder)
    shot = next(each for each in found if each.source == source)
    copy_photographs(found, tmp_path / "copies")
    copy = tmp_path / "copies" / shot.name
    with Image.open(source) as raw, Image.open(copy) as stored:
        upright = ImageOps.exif_transpose(raw)
        assert stored.size == upright.size == shot.size
        difference = np.asarray(stored, float) - np.asarray(upright.convert("RGB"), float)
        # A JPEG is encoded again: measured 4 levels on average at the edges of these colors.
        assert np.abs(difference).mean() < (5 if orientation > 1 and suffix == ".jpg" else 1e-9)
        assert stored.getexif().get(0x0112, 1) == 1
        assert float(stored.getexif().get_ifd(0x8769)[0x920A]) == 35.0
    assert (copy.read_bytes() == source.read_bytes()) == (orientation == 1)
    assert any("turned upright" in line for line in lines) == (orientation > 1)


def test_copies_that_are_there_stay(tmp_path: Path) -> None:
    found, _ = find_photographs(folder_of(tmp_path))
    copy_photographs(found, tmp_path / "copies")
    (tmp_path / "copies/0.jpg").write_bytes(b"mine")
    copy_photographs(found, tmp_path / "copies")
    assert (tmp_path / "copies/0.jpg").read_bytes() == b"mine"
    assert len(list((tmp_path / "copies").iterdir())) == 3


def test_cameras_are_told_apart(tmp_path: Path) -> None:
    folder = folder_of(tmp_path, focal=35.0, model="A")
    photograph(folder / "zoomed.jpg", focal=50.0, model="A")
    photograph(folder / "large.jpg", size=(64, 32), focal=35.0, model="A")
    # Held upright: other sizes as stored, the same camera's sensor, yet another picture plane.
    photograph(folder / "upright.jpg", size=(32, 48), orientation=6, focal=35.0, model="A")
    found, lines = find_photographs(folder)
    assert len({each.camera_key for each in found}) == 3
    assert "photographs of 2 sizes (48 x 32, 64 x 32): a camera for each" in lines
    assert "3 cameras, as the tags differ in maker, model or focal length" in lines
    assert not any("no focal length" in line for line in lines)


def test_names_and_other_files(tmp_path: Path) -> None:
    folder = folder_of(tmp_path)
    photograph(folder / "with  space.JPG")
    (folder / "video.mov").write_bytes(b"")
    (folder / ".hidden.jpg").write_bytes(b"")
    found, lines = find_photographs(folder)
    assert [each.name for each in found] == ["0.jpg", "1.jpg", "2.jpg", "with_space.JPG"]
    assert "1 files left aside: video.mov" in lines
    assert "no focal length in the tags: it is estimated from 1.2 times the longer side" in lines
    photograph(folder / "with_space.jpg")
    with pytest.raises(SceneError, match="different names"):
        find_photographs(folder)


def test_folders_that_cannot_do_are_refused(tmp_path: Path) -> None:
    with pytest.raises(IoError, match="a folder, got none"):
        find_photographs(tmp_path / "none")
    folder = folder_of(tmp_path)
    (folder / "2.jpg").rename(folder / "2.heic")
    with pytest.raises(SceneError, match=r"at least 3 photographs .* got 2, and 2\.heic .*convert"):
        find_photographs(folder)
    photograph(folder / "3.jpg")
    whole = photograph(folder / "4.jpg", size=(400, 300)).read_bytes()
    (folder / "4.jpg").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(IoError, match=r"4\.jpg: expected a readable photograph"):
        find_photographs(folder)


@pytest.mark.parametrize("count", [3, 10, 60])
def test_few_photographs_are_all_compared(count: int) -> None:
    pairs = choose_pairs(count)
    assert len(pairs) == len(set(pairs)) == count * (count - 1) // 2
    assert choose_pairs(count, exhaustive=True) == pairs


@pytest.mark.parametrize("count", [12, 61, 500])
def test_a_walk_compares_neighbors_and_comes_back(count: int) -> None:
    pairs = choose_pairs(count, exhaustive=False)
    assert all(0 <= i < j < count for i, j in pairs)
    assert len(pairs) == len(set(pairs))
    assert {(i, i + 1) for i in range(count - 1)} <= set(pairs)
    assert (0, count - 1) in pairs  # the end with the start
    # The work grows with the number, not with its square.
    assert len(pairs) <= count * (NEIGHBORS + 6) + NEIGHBORS**2 + KEYS**2 / 2
    if count > 60:
        assert choose_pairs(count) == pairs
        assert len(choose_pairs(count)) < count * (count - 1) // 2
