"""`photograd simplify`: a file of few triangles, its report, and mistakes that are named."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
from photograd.fields import TexturedSurface
from photograd.geometry.icosphere import icosphere
from photograd.transport.mesh_files import read_mesh_surface, read_textured_surface

from support.missing import need_module
from tests.commands.conftest import Photograd


def write_ball(path: Path) -> Path:
    ball = icosphere(6)
    lines = [f"v {x} {y} {z}" for x, y, z in ball.vertices * np.array([1, 0.6, 0.8])]
    lines += [f"f {a} {b} {c}" for a, b, c in ball.faces + 1]
    path.write_text("\n".join(lines) + "\n")
    return path


def test_a_mesh_file_becomes_a_simple_one(photograd: Photograd, tmp_path: Path) -> None:
    need_module("fast_simplification")
    out = tmp_path / "few.glb"
    words = ("--triangles", 60, "--views", 12, "--size", 32, "--steps", 60, "--json")
    done = photograd("simplify", write_ball(tmp_path / "ball.obj"), "--out", out, *words)
    assert done.code == 0, done.err
    told = done.result()
    assert (told["triangles"], told["triangles_before"], told["steps"]) == (60, 720, 60)
    assert told["psnr"] > told["psnr_decimated"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # colors of vertices are not read
        assert read_mesh_surface(out).shape[1] == 60


def test_a_texture_and_opacity_go_through_a_file(photograd: Photograd, tmp_path: Path) -> None:
    need_module("fast_simplification")
    need_module("xatlas")
    few = ("--views", 6, "--size", 24, "--steps", 4, "--json", "--texture", 32)
    textured, cut = tmp_path / "textured.glb", tmp_path / "cut.glb"
    ball = write_ball(tmp_path / "ball.obj")
    done = photograd("simplify", ball, "--triangles", 200, "--out", textured, *few)
    assert done.code == 0, done.err
    assert not read_again(textured).has_opacity
    again = ("simplify", textured, "--triangles", 60, "--out", cut, "--opacity", *few)
    done = photograd(*again)
    assert done.code == 0, done.err
    assert done.result()["triangles_before"] == 200
    found = read_again(cut)
    assert found.has_opacity
    assert found.shape[1:] == (60, 32, 32)
    # The texture of the first file is what the second one shows.
    assert 0.2 < found.rgba()[..., :3].std() / read_again(textured).rgba()[..., :3].std() < 5


def read_again(path: Path) -> TexturedSurface:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # mip maps of what shines
        return read_textured_surface(path)


def test_mistakes_are_named(photograd: Photograd, tmp_path: Path) -> None:
    ball = write_ball(tmp_path / "ball.obj")
    done = photograd("simplify", ball, "--triangles", 60, "--out", tmp_path / "few.obj")
    assert done.code in (1, 2)
    assert "a name that ends in .glb or .npz" in " ".join(done.err.replace("│", " ").split())
    done = photograd("simplify", ball, "--triangles", 5000, "--out", tmp_path / "few.glb")
    assert done.code in (1, 2)
    assert "triangles" in done.err
