"""`photograd vectorize` from a picture to an SVG file, and mistakes that are named."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
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
