"""`photograd render`: what --out may be called, and files that another command draws."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.splats.files import write_gaussians
from PIL import Image

from tests.commands.conftest import Photograd
from tests.splat import oracle

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


@pytest.fixture
def cloud(tmp_path: Path) -> Path:
    write_gaussians(tmp_path / "cloud.ply", oracle.cloud(40, 1).astype(np.float32))
    return tmp_path / "cloud.ply"


@pytest.mark.parametrize(
    ("name", "frames", "says"),
    [
        ("a.mov", 3, "--out: expected a name that ends in .gif, .mp4, .webm, .npz or .png, or one"),
        ("a.avi", 1, "a folder for PNG frames, got"),
        ("no/a.mp4", 2, "expected a file in a folder that exists"),
        ("a.png", 3, "--frames: expected --frames 1 for one picture a.png, got 3"),
        ("no/a.gif", 3, "expected a file in a folder that exists"),
        ("full", 3, "full, a file"),
        ("folder.gif", 3, "expected a file in a folder that exists"),
    ],
)
def test_names_that_mean_nothing_are_refused_before_drawing(
    photograd: Photograd, cloud: Path, name: str, frames: int, says: str
) -> None:
    (cloud.parent / "full").write_text("taken")
    (cloud.parent / "folder.gif").mkdir()
    before = sorted(cloud.parent.iterdir())
    done = photograd(
        "render", cloud, "--frames", frames, "--size", 16, "--out", cloud.parent / name
    )
    assert done.code == 1
    assert says in done.err
    assert done.err.count("\n") == 1
    assert sorted(cloud.parent.iterdir()) == before


def test_names_say_what_is_written(photograd: Photograd, cloud: Path) -> None:
    for name, frames in (("a.gif", 2), ("frames", 2), ("still.PNG", 1)):
        out = cloud.parent / name
        done = photograd("render", cloud, "--frames", frames, "--size", 16, "--out", out, "--json")
        assert done.code == 0, done.err
        assert done.result()["frames"] == frames
    assert len(list((cloud.parent / "frames").iterdir())) == 2
    still = np.asarray(Image.open(cloud.parent / "still.PNG"))
    first = np.asarray(Image.open(cloud.parent / "frames" / "frame_0000.png"))
    assert np.array_equal(still, first)


def test_a_picture_that_is_not_finite_is_an_error(photograd: Photograd, tmp_path: Path) -> None:
    g = oracle.cloud(8, 1).astype(np.float32)
    g.sh[:] = 3.3e38
    write_gaussians(tmp_path / "a.ply", g)
    out = tmp_path / "a.gif"
    done = photograd("render", tmp_path / "a.ply", "--frames", 6, "--size", 24, "--out", out)
    assert done.code == 1
    assert "error: splat.render: color: expected finite values" in done.err
    assert "the first in pixel (" in done.err
    assert not out.exists()


def test_files_of_other_kinds_are_refused_by_name(photograd: Photograd, tmp_path: Path) -> None:
    (tmp_path / "bob.obj").write_text(TRIANGLE)
    (tmp_path / "scan.slc").write_bytes(b"SLC")
    (tmp_path / "text.npz").write_text("no archive")
    (tmp_path / "mesh.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
        "property float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n"
    )
    for name, says in [
        ("bob.obj", "bob.obj' draws it)"),
        ("scan.slc", "volumes (.vdb, .vtk, .nii, .nii.gz, .vol) and Gaussians (.ply, .splat"),
        ("text.npz", "expected a model, the folder that 'photograd fit' wrote"),
        ("mesh.ply", "'photograd trace' draws meshes"),
        ("none.npz", "run 'photograd fit' first"),
        ("none.spz", "expected a file, got none"),
    ]:
        done = photograd("render", tmp_path / name, "--out", tmp_path / "a.gif")
        assert done.code == 1
        assert says in done.err
        assert "pickle" not in done.err
    assert "'photograd trace cornell-box' draws it" in photograd("render", "cornell-box").err
    done = photograd("render", tmp_path / "mesh.ply", "--up", "north")
    assert "--up: expected auto or one of +x, -x, +y, -y, +z, -z, got north" in done.err


def test_what_render_draws_is_no_scene(
    photograd: Photograd, cloud: Path, model_folder: Path
) -> None:
    (cloud.parent / "a.vol").write_bytes(b"VOL")
    for name in ("a.splat", "a.spz"):
        assert photograd("convert", cloud, cloud.with_name(name)).code == 0
    names = [cloud.with_name(name) for name in ("cloud.ply", "a.splat", "a.spz", "a.vol")]
    for path in (*names, model_folder, model_folder / "model.npz"):
        done = photograd("trace", path, "--spp", 1, "--out", cloud.with_name("a.png"))
        assert done.code == 1, path
        assert "'photograd render" in done.err
        assert "draws" in done.err
    assert not cloud.with_name("a.png").exists()
    done = photograd("trace", "none.toml", "--out", cloud.with_name("a.png"))
    assert "none.toml: expected a file, got none" in done.err
