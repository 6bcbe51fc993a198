"""Every reader refuses what is no regular file: a FIFO would wait for ever, a device never end."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from photograd._checkpoint import load_checkpoint
from photograd._files import read_npy, read_npz
from photograd.capture import load_capture
from photograd.capture.colmap_model import read_binary_model, read_text_model
from photograd.capture.nerfstudio import read_point_ply
from photograd.capture.sfm.photographs import find_photographs
from photograd.errors import Error, IoError
from photograd.grids.vdb import read_vdb
from photograd.grids.volumes import read_volume
from photograd.images import read_image
from photograd.images.read import read_header
from photograd.splats.files import holds_gaussians, read_gaussians
from photograd.transport import read_model, read_scene
from photograd.transport.accumulation import load_accumulation
from photograd.transport.density_files import read_density

pytestmark = pytest.mark.skipif(os.name != "posix", reason="FIFOs are of POSIX systems")
BOX: dict[str, Any] = {"corner": [0, 0, 0], "size": [1, 1, 1]}
READERS: dict[str, Callable[[Path], Any]] = {
    "a.toml": read_scene,
    "transforms.json": lambda path: load_capture(path.parent),
    "cameras.bin": lambda path: read_binary_model(path.parent),
    "cameras.txt": lambda path: read_text_model(path.parent),
    "a.png": read_image,
    "b.png": read_header,
    "a.jpg": read_image,
    "a.exr": read_image,
    "a.npz": lambda path: read_npz("f", path),
    "b.npz": lambda path: load_accumulation(path, {}),
    "model.npz": load_checkpoint,
    "a.npy": lambda path: read_npy("f", path),
    "b.npy": lambda path: read_density(path, **BOX),
    "a.vdb": read_vdb,
    "b.vdb": read_density,
    **dict.fromkeys(("a.glb", "a.gltf", "a.obj", "a.stl", "a.ply"), read_model),
    **dict.fromkeys(("b.ply", "a.splat", "a.spz"), read_gaussians),
    "c.ply": read_point_ply,
    **dict.fromkeys(("a.vtk", "a.nii", "a.nii.gz", "a.vol"), read_volume),
}


@pytest.mark.parametrize("name", READERS)
def test_a_fifo_is_refused(tmp_path: Path, name: str) -> None:
    os.mkfifo(tmp_path / name)
    with pytest.raises(Error, match=r"a FIFO|expected a model"):
        READERS[name](tmp_path / name)


def test_a_device_and_what_a_file_names(tmp_path: Path) -> None:
    (tmp_path / "a.glb").symlink_to("/dev/zero")
    with pytest.raises(IoError, match="expected a file, got a device"):
        read_model(tmp_path / "a.glb")
    os.mkfifo(tmp_path / "m.mtl")
    (tmp_path / "a.obj").write_text("mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with pytest.warns(UserWarning, match=r"m\.mtl: expected a file, got a FIFO"):
        read_model(tmp_path / "a.obj")


def test_a_fifo_is_no_archive_of_points(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "a.npz")
    assert not holds_gaussians(tmp_path / "a.npz")


def test_folders_of_photographs_leave_them_out(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "a.jpg")
    with pytest.raises(Error, match="at least 3 photographs"):
        find_photographs(tmp_path)
