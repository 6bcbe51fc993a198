"""`photograd vectorize` from a picture to an SVG file, and mistakes that are named."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from photograd._checkpoint import holds_steps
from photograd.images.read import read_image
from photograd.images.write import write_png
from photograd.vector import read_svg, render

from tests.commands.conftest import Photograd


@pytest.fixture
def picture(tmp_path: Path) -> Path:
    """A disk before a ramp, 48 rows of 64 pixels."""
    y, x = np.mgrid[:48, :64]
    disk = np.hypot(x - 30, y - 22) < 14
    pixels = np.stack([x / 64, np.where(disk, 0.9, 0.2), y / 48, np.ones(x.shape)], axis=-1)
    write_png(tmp_path / "disk.png", pixels.astype(np.float32))
    return tmp_path / "disk.png"


@pytest.mark.parametrize("kind", ["stroke", "fill"])
def test_a_picture_becomes_curves(
    photograd: Photograd, picture: Path, tmp_path: Path, kind: str
) -> None:
    out = tmp_path / "out" / "a.svg"
    done = photograd(
        *("vectorize", picture, "--curves", 30, "--steps", 60, "--size", 32),
        *("--kind", kind, "--out", out, "--json"),
    )
    assert done.code == 0, done.err
    assert done.result()["step"] == 60
    file = read_svg(out, linear=False)
    assert file.size == (24, 32)
    assert len(file.drawing.shapes) == 31  # and the background
    pixels = read_image(picture)[..., :3].reshape(24, 2, 32, 2, 3).mean(axis=(1, 3))
    error = np.square(render(file.drawing, file.size)[..., :3] - pixels).mean()
    assert -10 * np.log10(error) == pytest.approx(done.result()["psnr"], abs=0.3)
    assert done.result()["psnr"] > 18


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--kind", "dots"), "--kind: expected stroke or fill"),
        (("--out", "a.png"), "--out: expected a name that ends in"),
        (("--curves", "0"), "--curves"),
    ],
)
def test_mistakes_are_named(
    photograd: Photograd, picture: Path, words: tuple[object, ...], said: str
) -> None:
    done = photograd("vectorize", picture, *words)
    assert done.code != 0
    assert said in " ".join(done.err.split())


def run_of(picture: Path, out: Path, *more: str) -> subprocess.Popen[str]:
    words = ["vectorize", str(picture), "--curves", "20", "--steps", "400", "--out", str(out)]
    begin = [sys.executable, "-m", "photograd_course", *words, *more]
    return subprocess.Popen(begin, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def wait_for_step(process: subprocess.Popen[str], file: Path) -> None:
    """Until a checkpoint with a step lies there."""
    while not holds_steps(file):
        assert process.poll() is None, process.communicate()[1]
        time.sleep(0.01)


def test_killed_and_resumed_it_writes_the_same_curves(
    photograd: Photograd, picture: Path, tmp_path: Path
) -> None:
    whole, out = tmp_path / "whole.svg", tmp_path / "new" / "killed.svg"
    words = ("vectorize", picture, "--curves", 20, "--steps", 400)
    assert photograd(*words, "--out", whole).code == 0
    assert not (tmp_path / "whole.fit").exists()
    process = run_of(picture, out)
    wait_for_step(process, out.with_suffix(".fit") / "drawing.npz")
    process.kill()
    process.communicate()
    assert not out.exists()
    refused = photograd(*words, "--out", out)
    assert refused.code == 1
    assert "vectorize: --out: expected a name without a checkpoint" in refused.err
    done = photograd(*words, "--out", out, "--resume")
    assert done.code == 0, done.err
    assert out.read_bytes() == whole.read_bytes()
    assert [path.name for path in out.parent.iterdir()] == ["killed.svg"]
    again = photograd(*words, "--out", out, "--resume")
    assert again.code == 1
    assert "vectorize: --resume: expected a run that was stopped, got no" in again.err


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_writes_what_was_found(
    picture: Path, tmp_path: Path, number: signal.Signals
) -> None:
    out = tmp_path / "stopped.svg"
    process = run_of(picture, out, "--steps", "100000")
    wait_for_step(process, tmp_path / "stopped.fit" / "drawing.npz")
    process.send_signal(number)
    _, err = process.communicate()
    assert process.returncode == 128 + number, err
    assert "continue with --resume" in err
    assert len(read_svg(out, linear=False).drawing.shapes) == 21
