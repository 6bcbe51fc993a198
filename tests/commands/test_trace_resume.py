"""`photograd trace` that is interrupted, resumed, and asked to go on with something else."""

from __future__ import annotations

import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.images.exr import encode_exr, read_exr
from photograd.transport import PathTracer
from PIL import Image

from tests.commands.conftest import Photograd
from tests.commands.test_trace import SCENE

SMALL = ("cornell-box", "--size", 12, "--spp", 42)


@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)], ids=["Ctrl-C", "SIGTERM"]
)
def test_interrupted_and_resumed_it_has_the_same_bits(
    photograd: Photograd,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    number: signal.Signals,
    code: int,
) -> None:
    whole, parts = tmp_path / "whole.exr", tmp_path / "parts.exr"
    assert photograd("trace", *SMALL, "--out", whole).code == 0
    add, calls = PathTracer.add_samples, []

    def interrupted(*arguments: Any, **more: Any) -> Any:
        calls.append(arguments)
        if len(calls) == 3:  # within the third pass, which is finished first
            signal.raise_signal(number)
        return add(*arguments, **more)

    monkeypatch.setattr(PathTracer, "add_samples", interrupted)
    done = photograd("trace", *SMALL, "--out", parts)
    monkeypatch.undo()
    monkeypatch.setenv("COLUMNS", "100")
    assert done.code == code
    assert "stopped at 24 of 42 samples; continue with --resume" in " ".join(done.err.split())
    assert not np.array_equal(read_exr(whole), read_exr(parts))
    again = photograd("trace", *SMALL, "--out", parts, "--resume", "--threads", 1)
    assert again.code == 0, again.err
    assert "resumed at 24 of 42" in again.err
    assert whole.read_bytes() == parts.read_bytes()
    assert whole.with_suffix(".png").read_bytes() == parts.with_suffix(".png").read_bytes()


BALL = 'kind = "sphere"\ncenter = [0, 0.5, 0]\nradius = 0.5'
WALL = 'kind = "rectangle"\ncorner = [-1, 0, 0]\nedge_u = [2, 0, 0]\nedge_v = [0, 1, 0]'
ALBEDO = "albedo = [0.5, 0.5, 0.5]"
PAINTED = SCENE.replace(BALL, WALL).replace(ALBEDO, ALBEDO + '\ntextures = { albedo = "paint" }')
PAINT = '[textures.paint]\nfile = "paint.png"\n'


def paint(folder: Path, gray: int) -> None:
    Image.fromarray(np.full((2, 2, 3), gray, np.uint8)).save(folder / "paint.png")


def test_another_picture_on_a_wall_is_another_scene(photograd: Photograd, tmp_path: Path) -> None:
    scene, out = tmp_path / "s.toml", tmp_path / "s.exr"
    scene.write_text(PAINTED + PAINT, encoding="utf-8")
    paint(tmp_path, 200)
    assert photograd("trace", scene, "--spp", 8, "--out", out).code == 0
    first = read_exr(out)
    same = photograd("trace", scene, "--spp", 16, "--out", out, "--resume")
    assert same.code == 0, same.err
    paint(tmp_path, 90)  # of the same size
    other = photograd("trace", scene, "--spp", 24, "--out", out, "--resume")
    assert other.code == 1
    assert "scene differ" in " ".join(other.err.split())
    assert photograd("trace", scene, "--spp", 8, "--out", out).code == 0
    assert read_exr(out).mean() < first.mean()


def test_what_cannot_become_a_picture_is_said_at_once(
    photograd: Photograd, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    scene = tmp_path / "s.toml"
    bright = '[[lights]]\nkind = "environment"\nimage = "sky.exr"\n'
    pixels = np.ones((4, 8, 3), np.float32)
    pixels[1, 5] = np.nan
    Path("bad.exr").write_bytes(encode_exr(pixels, half=False))
    huge = SCENE.replace("size = [8, 6]", "size = [1000000, 1000000]")
    for text, words, said in (
        (SCENE, ("--out", "nowhere/a.exr"), "a file in a folder that exists, got nowhere/a.exr"),
        (huge, (), "camera.size: expected width and height in pixels, 1 to 65536"),
        (SCENE + bright, (), "sky.exr: expected a file, got none"),
        (SCENE + bright.replace("sky", "bad"), (), "1 bad pixels, the first in row 1, column 5"),
    ):
        scene.write_text(text, encoding="utf-8")
        done = photograd("trace", scene, *words)
        assert done.code == 1
        assert said in " ".join(done.err.replace("│", " ").split()), done.err
        assert "trace 1" not in done.err  # no sample was drawn


def test_a_black_picture_is_explained(photograd: Photograd, tmp_path: Path) -> None:
    scene = tmp_path / "s.toml"
    scene.write_text(SCENE.replace("radiance = 0.5", "radiance = 0"), encoding="utf-8")
    done = photograd("trace", scene, "--spp", 4, "--out", tmp_path / "a.exr")
    assert done.code == 0
    assert "all is black: does something shine there" in " ".join(done.err.split())
    lit = photograd("trace", "cornell-box", "--size", 8, "--spp", 4, "--out", tmp_path / "a.exr")
    assert "all is black" not in lit.err
