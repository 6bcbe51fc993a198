"""A capture names files in its own folder; others are read only where the reader is told to."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from photograd.capture import load_capture
from photograd_course.errors import IoError
from tests.commands.conftest import (
    Photograd,
    photograd,  # noqa: F401  a fixture
)

from support import capture_files as files

CAMERAS = files.orbit(9)
Write = Callable[[Path, bool], None]


def move_out(folder: Path, images: str, base: Path, *, absolute: bool) -> str:
    """Move the third picture beside `folder`; its name, absolute or relative to `base`."""
    file = folder.parent / "0002.png"
    (folder / images / file.name).rename(file)
    return str(file) if absolute else os.path.relpath(file, base)


def nerfstudio(folder: Path, absolute: bool) -> None:
    files.write_nerfstudio(folder, CAMERAS)
    name = move_out(folder, "images", folder, absolute=absolute)
    rename_third(folder / "transforms.json", name)


def blender(folder: Path, absolute: bool) -> None:
    files.write_blender(folder, CAMERAS, CAMERAS[:2])
    name = move_out(folder, "train", folder, absolute=absolute)
    rename_third(folder / "transforms_train.json", name)


def rename_third(file: Path, name: str) -> None:
    files.edit_json(file, lambda content: content["frames"][2].update(file_path=name))


def colmap(folder: Path, absolute: bool) -> None:
    names = files.write_pictures(folder / "images", CAMERAS)
    names[2] = move_out(folder, "images", folder / "images", absolute=absolute)
    files.write_colmap_binary(folder / "sparse/0", CAMERAS, names, files.sphere_points())


def opensfm(folder: Path, absolute: bool) -> None:
    files.write_opensfm(folder, CAMERAS)
    name = move_out(folder, "images", folder / "images", absolute=absolute)

    def change(content: Any) -> None:
        shots = content[0]["shots"]
        shots[name] = shots.pop("0002.png")

    files.edit_json(folder / "reconstruction.json", change)


@pytest.mark.parametrize("write", [nerfstudio, blender, colmap, opensfm])
@pytest.mark.parametrize("absolute", [False, True], ids=["relative", "absolute"])
def test_a_photograph_elsewhere_is_read_only_if_allowed(
    tmp_path: Path, write: Write, absolute: bool
) -> None:
    write(tmp_path / "scene", absolute)
    with pytest.raises(IoError, match=r"0002.*expected a file in .*scene.*--allow-outside"):
        load_capture(tmp_path / "scene")
    capture = load_capture(tmp_path / "scene", allow_outside=True)
    assert sum(view.rgba().any() for view in capture.train + capture.test) >= 9


@pytest.mark.parametrize("member", ["mask_path", "ply_file_path"])
def test_masks_and_points_elsewhere_are_not_opened(tmp_path: Path, member: str) -> None:
    files.write_nerfstudio(tmp_path, CAMERAS)

    def change(content: Any) -> None:
        place = content if member == "ply_file_path" else content["frames"][1]
        place[member] = "../../../../etc/passwd"

    files.edit_json(tmp_path / "transforms.json", change)
    with pytest.raises(IoError, match=f"{member}: expected a file in .*etc/passwd"):
        load_capture(tmp_path)


def test_links_are_followed(tmp_path: Path) -> None:
    """They are made on this machine, not by the text of a file."""
    files.write_nerfstudio(tmp_path / "scene", CAMERAS)
    (tmp_path / "scene/images").rename(tmp_path / "disk")
    (tmp_path / "scene/images").symlink_to(tmp_path / "disk")
    assert len(load_capture(tmp_path / "scene").views) == 9


def test_the_commands_have_the_option(photograd: Photograd, tmp_path: Path) -> None:  # noqa: F811
    nerfstudio(tmp_path / "scene", absolute=False)
    done = photograd("info", tmp_path / "scene")
    assert done.code == 1
    assert "if you trust the capture: --allow-outside" in done.err
    assert photograd("info", tmp_path / "scene", "--allow-outside").code == 0
    for command in ("fit", "evaluate", "gradients", "compare"):
        assert "--allow-outside" in photograd(command, "--help").out
