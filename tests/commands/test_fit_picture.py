"""`photograd fit` of a picture: a network, a picture, going on, and mistakes that are named."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.fitting import load_neural_image
from photograd.images.read import read_image
from photograd.images.write import write_png

from tests.commands.conftest import Photograd


@pytest.fixture
def picture(tmp_path: Path) -> Path:
    """A ramp of 24 rows of 40 pixels, clear in one corner."""
    y, x = np.mgrid[:24, :40]
    pixels = np.stack([x / 40, y / 24, np.full((24, 40), 0.3), np.ones((24, 40))], axis=-1)
    pixels[:4, :4, 3] = 0
    write_png(tmp_path / "ramp.png", pixels.astype(np.float32))
    return tmp_path / "ramp.png"


@pytest.mark.parametrize("representation", ["hash_grid", "nerf"])
def test_a_picture_is_fitted_and_resumed(
    photograd: Photograd, picture: Path, tmp_path: Path, representation: str
) -> None:
    out = tmp_path / "out"
    words = ("fit", picture, "--representation", representation, "--steps", 40, "--rays", 2048)
    done = photograd(*words, "--out", out, "--json")
    assert done.code == 0, done.err
    assert done.result()["step"] == 40
    assert done.result()["psnr"] > (25 if representation == "hash_grid" else 15)
    drawn = read_image(out / "picture.png")[..., :3]
    error = np.square(drawn - np.clip(load_neural_image(out).image(24, 40), 0, 1)).max()
    assert error < 1 / 255**2
    if representation == "hash_grid":
        np.testing.assert_allclose(drawn[:4, :4].mean(), 1.0, atol=0.1)  # clear is white
    again = photograd(*words, "--out", out)
    assert again.code == 1
    assert "a folder without image.npz" in " ".join(again.err.split())
    assert photograd(*words, "--out", out, "--resume").code == 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--degree", 2), "--degree: expected a fit of a capture"),
        (("--representation", "hash_gird"), "did you mean 'hash_grid'"),
        (("--representation", "nerf", "--resolution", 64), "--resolution: expected a fit of"),
    ],
)
def test_what_a_picture_does_not_take_is_refused(
    photograd: Photograd, picture: Path, tmp_path: Path, words: tuple[object, ...], said: str
) -> None:
    done = photograd("fit", picture, "--out", tmp_path / "out", *words)
    assert done.code == 1
    assert said in " ".join(done.err.split())


def test_a_missing_picture_is_named(photograd: Photograd, tmp_path: Path) -> None:
    done = photograd("fit", tmp_path / "none.png", "--out", tmp_path / "out")
    assert done.code == 1
    assert "none.png" in done.err
